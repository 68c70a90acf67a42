#include "brace/loaded.h"

#include <float.h>
#include <stddef.h>

#include "base/check.h"
#include "chain/tensor.h"
#include "loaded/buckling.h"
#include "loaded/solve.h"

#define SINGULAR_PIVOT 1e-3f
#define TURN_MOST_RAD 3.1f /* of a link's root: turn_by() of link.h takes half a turn */
#define BEND_MOST_RAD 1.2f /* each curvature: beyond it brace_small_turn() is off by more than 0.2 % between points */
#define BEND_PROMISED_RAD 0.25f /* both curvatures of a link together: a line of curvature follows it up to here */
#define FORCE_MOST_N 1e4f
#define STEPS_MOST 4
#define FOLLOWED_RATIO2 0.25f /* square of the load's change over the load, beyond which a rest is not followed */
#define SURE_RAD 0.05f    /* a step that turns no link's end further leaves less than 0.3 % of K */
#define SETTLED_RAD 0.14f /* how far the last of all steps may turn them */

/* The whole search. determinant_now: at the present load. */
INLINE float buckling_factor(const stance_t *stance, float determinant_now)
{
    brace_buckling_search_t search = buckling_search_from(determinant_now);
    for (int step = 0; step < SEARCH_STEPS; step++) {
        const float at = buckling_search_at(&search, step);
        const pivots_t p = pivots_at(stance, at);
        buckling_search_narrow(&search, at, (softened_t){product(&p), is_stable(&p, 0.0f)});
    }
    return buckling_search_end(&search);
}

/* Adds to C what a link's curvatures and springs yield. beyond: how all that comes after the link moves the tip when
 * the link's end turns. returns how the tip moves when the link's root turns */
INLINE brace_vec_t add_link(brace_tensor_t *c, const rest_t *rest, const factors_t *f, brace_vec_t beyond)
{
    const brace_vec_t end = vec_plus(rest->end, beyond);
    const brace_vec_t a = vec_plus(rest->a, end);
    const brace_vec_t b = vec_plus_scaled(vec_plus(rest->b, end), a, -f->b_by_a);
    const brace_vec_t root = vec_plus(vec_minus(vec_quarter(rest->tip_mm), rest->aside), beyond);
    brace_tensor_add_scaled(c, a, f->yields_a);
    brace_tensor_add_scaled(c, b, f->yields_b);
    brace_tensor_add(c, rest->root_spring);
    brace_tensor_add(c, rest->end_spring);
    return vec_plus_scaled(vec_plus_scaled(root, a, -f->root_by_a), b, -f->root_by_b);
}

INLINE link_t link_seen(const brace_loaded_link_t *link, brace_vec_t direction, brace_vec_t beyond_n, brace_vec_t down)
{
    const brace_vec_t own_n = vec_scaled(down, link->weight_n), whole_n = vec_plus(beyond_n, own_n);
    const brace_vec_t to_beam_mm = vec_turned(link->to_beam_mm, direction);
    const brace_vec_t root_root = vec_turned(link->root_root, direction);
    return (link_t){.to_beam_mm = to_beam_mm,
                    .beam_mm = vec_turned(link->beam_mm, direction),
                    .root_root = root_root,
                    .end_root = vec_turned(link->end_root, direction),
                    .rigid_mm = vec_plus_scaled(to_beam_mm, root_root, vec_dot(root_root, whole_n)),
                    .end_mm_per_n = link->end_mm_per_n,
                    .bend_rad_per_n_mm = link->bend_rad_per_n_mm,
                    .beyond_n = beyond_n,
                    .own_n = own_n,
                    .on_rigid_n = vec_plus_scaled(beyond_n, own_n, 0.5f)};
}

/* Where the tip is at an equilibrium, less where it is without load. bent_mm: seen from the femur. */
INLINE brace_displacement_t displacement_of(const brace_loaded_t *loaded, const brace_loaded_rest_t *at,
                                            brace_vec_t bent_mm)
{
    const brace_vec_t tibia = at->tibia_commanded, on_base = at->on_base_n;
    const brace_vec_t straight = {brace_fma(loaded->tibia.length_mm, tibia.x, loaded->femur.length_mm),
                                  loaded->tibia.length_mm * tibia.z};
    const brace_vec_t moved = vec_turned(vec_minus(bent_mm, straight), at->femur_commanded);
    const float along_root = vec_dot(loaded->base_root, on_base);
    return (brace_displacement_t){
        moved.x + brace_fma(loaded->base_mm_per_n, on_base.x, along_root * loaded->base_root.x),
        moved.z + brace_fma(loaded->base_mm_per_n, on_base.z, along_root * loaded->base_root.z)};
}

/* How far a link bends within itself [rad]. */
INLINE float bend_of(const shape_t *shape)
{
    return fabsf(shape->a) + fabsf(shape->b);
}

static bool is_bent_within(const shape_t *shape)
{
    return fabsf(shape->root) <= TURN_MOST_RAD && fabsf(shape->a) <= BEND_MOST_RAD && fabsf(shape->b) <= BEND_MOST_RAD;
}

/* A step of Newton's method leaves about the square of what it has moved, and more of it the less stable the limb
 * is. */
INLINE bool is_settled(float unsettled_rad, float det)
{
    return unsettled_rad * unsettled_rad <= SETTLED_RAD * SETTLED_RAD * det;
}

static bool is_near(brace_vec_t load_n, brace_vec_t before_n)
{
    const brace_vec_t change_n = vec_minus(load_n, before_n);
    return vec_dot(change_n, change_n) <= FOLLOWED_RATIO2 * vec_dot(load_n, load_n);
}

/* The equilibrium, by steps of Newton's method from the straight limb: two, and two more where these are not enough.
 * place: NULL, or with is_bent as brace_loaded_follow */
INLINE brace_status_t settle(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad, const brace_load_t *load,
                             bool is_bent, brace_loaded_place_t *place, brace_loaded_rest_t *at)
{
    const float reach = brace_fma(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    const float force = fabsf(load->tip.x_n) + fabsf(load->tip.z_n);
    if (brace_bits(reach) > brace_bits(BRACE_REACH_RAD2) || brace_bits(force) > brace_bits(FORCE_MOST_N)) {
        return brace_refusal_of(reach, force);
    }
    const brace_vec_t forwards = {1.0f, 0.0f}, femur = brace_direction(theta1_rad);
    const brace_vec_t tibia = brace_direction(-theta2_rad); /* seen from the femur */
    const brace_vec_t tip_n = {load->tip.x_n, load->tip.z_n}, seen_n = vec_turned_back(tip_n, femur);
    const brace_vec_t down = vec_turned_back(load->down, femur);
    const brace_vec_t on_base_n = vec_plus_scaled(tip_n, load->down, loaded->weight_n);
    const bool goes_on = place != NULL && is_bent && is_near(on_base_n, place->on_base_n);
    const shape_t straight = {0.0f, 0.0f, 0.0f};
    const float base = loaded->base_rotation_rad_per_n_mm;
    *at = (brace_loaded_rest_t){
        .femur_commanded = femur,
        .tibia_commanded = tibia,
        .femur = link_seen(&loaded->femur, forwards, vec_plus_scaled(seen_n, down, loaded->knee_n), down),
        .tibia = link_seen(&loaded->tibia, tibia, seen_n, down),
        .femur_shape = goes_on ? place->femur_shape : straight,
        .tibia_shape = goes_on ? place->tibia_shape : straight,
        .hip_rad_per_n_mm = load->hip.slope_rad_per_n_mm + base,
        .knee_rad_per_n_mm = load->knee.slope_rad_per_n_mm,
        .on_base_n = on_base_n,
        .unsettled_rad = 0.0f};
    const float hip_yields = load->hip.yields_by_rad_per_n_mm + base, knee_yields = load->knee.yields_by_rad_per_n_mm;
    if (!goes_on) {
        (void)bounded_step(at, true, hip_yields, knee_yields);
    }
    at->unsettled_rad = bounded_step(at, false, hip_yields, knee_yields);
    if (place != NULL) {
        *place = (brace_loaded_place_t){at->femur_shape, at->tibia_shape, on_base_n};
        return at->unsettled_rad <= SURE_RAD ? BRACE_OK : BRACE_E_SINGULAR;
    }
    for (int taken = 2; taken < STEPS_MOST && !(at->unsettled_rad <= SURE_RAD); taken++) {
        at->unsettled_rad = bounded_step(at, false, hip_yields, knee_yields);
    }
    return at->unsettled_rad <= SETTLED_RAD ? BRACE_OK : BRACE_E_SINGULAR;
}

INLINE brace_status_t stiffness_at(const brace_loaded_t *loaded, const brace_loaded_rest_t *at,
                                   brace_loaded_stiffness_t *result)
{
    const brace_vec_t femur = at->femur_commanded, none = {0.0f, 0.0f};
    const float hip = at->hip_rad_per_n_mm, knee = at->knee_rad_per_n_mm;
    rest_t femur_rest, tibia_rest;
    rest_of(&at->femur, &at->femur_shape, &femur_rest);
    rest_of(&at->tibia, &at->tibia_shape, &tibia_rest);
    const stance_t stance = {&femur_rest, &tibia_rest, at->femur.bend_rad_per_n_mm, at->tibia.bend_rad_per_n_mm,
                             hip,         knee};
    const pivots_t p = pivots_at(&stance, 1.0f);
    const float det = product(&p);
    if (!is_stable(&p, SINGULAR_PIVOT) || !is_bent_within(&at->femur_shape) || !is_bent_within(&at->tibia_shape) ||
        !is_settled(at->unsettled_rad, det)) {
        return BRACE_E_SINGULAR;
    }
    brace_tensor_t c = brace_tensor_of(loaded->base_mm_per_n + loaded->femur.end_mm_per_n + loaded->tibia.end_mm_per_n,
                                       vec_turned_back(loaded->base_root, femur));
    const brace_vec_t by_knee = add_link(&c, &tibia_rest, &p.tibia, none);
    brace_tensor_add_scaled(&c, by_knee, knee / p.knee);
    const brace_vec_t by_hip = add_link(&c, &femur_rest, &p.femur, vec_scaled(by_knee, 1.0f / p.knee));
    brace_tensor_add_scaled(&c, by_hip, hip / p.hip);
    const brace_status_t status = brace_tensor_inverse(&c, vec_doubled(femur), &result->stiffness);
    if (status != BRACE_OK) {
        return status;
    }
    if (bend_of(&at->femur_shape) > BEND_PROMISED_RAD || bend_of(&at->tibia_shape) > BEND_PROMISED_RAD) {
        result->stiffness.flags |= (uint32_t)BRACE_FLAG_NEAR_SINGULAR;
    }
    result->displacement = displacement_of(loaded, at, vec_plus(femur_rest.tip_mm, tibia_rest.tip_mm));
    result->tibia_mm = vec_turned(tibia_rest.tip_mm, femur);
    result->hip_turn_rad = at->femur_shape.root;
    result->knee_turn_rad = at->tibia_shape.root - end_turn(&at->femur_shape);
    result->buckling_factor = buckling_factor(&stance, det);
    return BRACE_OK;
}

brace_status_t brace_loaded_settle(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                   const brace_load_t *load, brace_loaded_rest_t *rest)
{
    return settle(loaded, theta1_rad, theta2_rad, load, false, NULL, rest);
}

brace_status_t brace_loaded_stiffness_at(const brace_loaded_t *loaded, const brace_loaded_rest_t *rest,
                                         brace_loaded_stiffness_t *result)
{
    return stiffness_at(loaded, rest, result);
}

brace_status_t brace_loaded_stiffness(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                      const brace_load_t *load, brace_loaded_stiffness_t *result)
{
    brace_loaded_rest_t at;
    const brace_status_t status = settle(loaded, theta1_rad, theta2_rad, load, false, NULL, &at);
    return status == BRACE_OK ? stiffness_at(loaded, &at, result) : status;
}

brace_status_t brace_loaded_follow(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                   const brace_load_t *load, bool is_bent, brace_loaded_place_t *place,
                                   brace_loaded_stiffness_t *result)
{
    brace_loaded_rest_t at;
    const brace_status_t status = settle(loaded, theta1_rad, theta2_rad, load, is_bent, place, &at);
    return status == BRACE_OK ? stiffness_at(loaded, &at, result) : status;
}
