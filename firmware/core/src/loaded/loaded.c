#include "brace/loaded.h"

#include <float.h>

#include "base/fma.h"
#include "base/trig.h"
#include "base/vec.h"
#include "chain/tensor.h"

/* Each part runs two or six times a tick with other constants: the compiler fits each in. */
#define INLINE static inline __attribute__((always_inline))

#define SINGULAR_PIVOT 1e-3f /* a pivot is 1 at no load, and 0 where the load has softened the limb to nothing */
#define TURN_MOST_RAD 1.5f   /* sine and cosine of base/trig.h hold up to pi/2 */
#define FORCE_MOST_N 1e4f

/* The coordinates of a link: how far its root has turned from the commanded direction, and its two curvatures, each as
 * the turn at one of the Gauss points 1/2 -+ 1/(2 sqrt 3). The curvature is linear between and beyond them. */
typedef struct {
    float root, a, b;
} shape_t;

/* A point at which a beam's shape is summed: its share of the beam, the share of the beam beyond it, and how far each
 * curvature has turned the link there, 2 int_0^x (s - xb)/(xa - xb) ds for a. Gauss' points and shares: two are enough
 * on the way to the equilibrium, three at it. */
typedef struct {
    float share, beyond, a, b;
} point_t;
static const point_t way_point[2] = {{0.5f, 0.788675135f, 0.5f, -0.0773502692f},
                                     {0.5f, 0.211324865f, 1.07735027f, 0.5f}};
static const point_t rest_point[3] = {{0.277777778f, 0.887298335f, 0.285906746f, -0.0605034154f},
                                      {0.444444444f, 0.5f, 0.933012702f, 0.0669872981f},
                                      {0.277777778f, 0.112701665f, 1.06050342f, 0.714093254f}};

/* A symmetric matrix of a link's coordinates. */
typedef struct {
    float rr, ra, rb, aa, ab, bb;
} matrix_t;

/* A link in the femur's frame, as it is loaded in this tick. */
typedef struct {
    brace_vec_t to_beam_mm, beam_mm, root_root, end_root;
    float end_mm_per_n, bend_rad_per_n_mm;
    brace_vec_t beyond_n; /* the force that the link's end carries: the ground's and the weights beyond */
    brace_vec_t own_n;    /* the link's own weight */
} link_t;

/* What a link tells of itself at a shape. Each part that turns has a lever r and a force F. It drives its turn by
 * r x F, and resists it by r . F. A spring of compliance S moves its end by S F, and its turn changes that movement: it
 * resists by F' S F' less, F' being F turned by a quarter. That part grows with the square of the load, the other with
 * the load; the buckling factor needs them apart. */
typedef struct {
    matrix_t resists;                            /* what grows with the load, except at the link's end */
    shape_t drive;                               /* except at the link's end */
    float end_drive, end_resists;                /* the end turns by the sum of the coordinates */
    float root_softens, end_softens;             /* what grows with the square of the load */
} state_t;

/* How the link moves the tip by each coordinate, and its springs as vectors of C. */
typedef struct {
    brace_vec_t tip_mm; /* from the link's root to its end */
    brace_vec_t a, b, end;
    brace_vec_t aside; /* less by this: what the springs move changes as they turn */
    brace_vec_t root_spring, end_spring;
} columns_t;

INLINE brace_vec_t turn_by(float angle_rad)
{
    return (brace_vec_t){brace_cosine_coarse(angle_rad), brace_sine(angle_rad)};
}

INLINE float end_turn(const shape_t *shape)
{
    return shape->root + shape->a + shape->b;
}

/* A spring that moves what comes after it: iso_mm_per_n in every direction, and the vector v. */
INLINE brace_vec_t moved_by(float iso_mm_per_n, brace_vec_t v, brace_vec_t force_n)
{
    return vec_plus_scaled(vec_scaled(force_n, iso_mm_per_n), v, vec_dot(v, force_n));
}

INLINE void look_at_point(const link_t *link, const shape_t *shape, const point_t *point, state_t *state,
                          columns_t *columns)
{
    const brace_vec_t turn = turn_by(brace_fma(point->b, shape->b, brace_fma(point->a, shape->a, shape->root)));
    const brace_vec_t lever = vec_scaled(vec_turned(link->beam_mm, turn), point->share);
    const brace_vec_t force = vec_plus_scaled(link->beyond_n, link->own_n, point->beyond);
    const float drive = vec_cross(lever, force), resists = vec_dot(lever, force);
    matrix_t *m = &state->resists;
    state->drive.root += drive;
    state->drive.a = brace_fma(point->a, drive, state->drive.a);
    state->drive.b = brace_fma(point->b, drive, state->drive.b);
    m->rr += resists;
    m->ra = brace_fma(point->a, resists, m->ra);
    m->rb = brace_fma(point->b, resists, m->rb);
    m->aa = brace_fma(point->a * point->a, resists, m->aa);
    m->ab = brace_fma(point->a * point->b, resists, m->ab);
    m->bb = brace_fma(point->b * point->b, resists, m->bb);
    if (columns != NULL) {
        columns->tip_mm = vec_plus(columns->tip_mm, lever);
        columns->a = vec_plus_scaled(columns->a, lever, point->a);
        columns->b = vec_plus_scaled(columns->b, lever, point->b);
    }
}

/* The weight lies along the straight link, so that of a tilted link acts half along its rigid part.
 * columns: null on the way to the equilibrium */
INLINE void look(const link_t *link, const shape_t *shape, state_t *state, columns_t *columns)
{
    const brace_vec_t whole_n = vec_plus(link->beyond_n, link->own_n), none = {0.0f, 0.0f};
    const brace_vec_t root_turn = turn_by(shape->root), root_spring = vec_turned(link->root_root, root_turn);
    const brace_vec_t rigid = vec_turned(link->to_beam_mm, root_turn), moved = moved_by(0.0f, root_spring, whole_n);
    const brace_vec_t rigid_n = vec_plus_scaled(link->beyond_n, link->own_n, 0.5f);
    const float root_across = vec_dot(root_spring, vec_quarter(whole_n));
    const float root_resists = vec_dot(rigid, rigid_n) + vec_dot(moved, whole_n);
    const float root_drives = vec_cross(rigid, rigid_n) + vec_cross(moved, whole_n);
    *state = (state_t){.resists = {root_resists, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f},
                       .drive = {root_drives, 0.0f, 0.0f},
                       .root_softens = root_across * root_across};
    const brace_vec_t end_spring = vec_turned(link->end_root, turn_by(end_turn(shape)));
    const brace_vec_t end = moved_by(link->end_mm_per_n, end_spring, link->beyond_n);
    const brace_vec_t across_n = vec_quarter(link->beyond_n);
    const brace_vec_t end_aside = moved_by(link->end_mm_per_n, end_spring, across_n);
    state->end_drive = vec_cross(end, link->beyond_n);
    state->end_resists = vec_dot(end, link->beyond_n);
    state->end_softens = vec_dot(end_aside, across_n);
    if (columns == NULL) {
        look_at_point(link, shape, &way_point[0], state, NULL);
        look_at_point(link, shape, &way_point[1], state, NULL);
        return;
    }
    *columns = (columns_t){.tip_mm = vec_plus(rigid, moved), .a = none, .b = none};
    look_at_point(link, shape, &rest_point[0], state, columns);
    look_at_point(link, shape, &rest_point[1], state, columns);
    look_at_point(link, shape, &rest_point[2], state, columns);
    columns->tip_mm = vec_plus(columns->tip_mm, end);
    columns->a = vec_quarter(columns->a);
    columns->b = vec_quarter(columns->b);
    columns->aside = vec_plus_scaled(end_aside, root_spring, root_across);
    columns->end = vec_minus(vec_quarter(end), end_aside);
    columns->root_spring = root_spring;
    columns->end_spring = end_spring;
}

/* Sums of look_at_point() over a beam that nothing has bent, for a force at the link's end and for its own weight. */
typedef struct {
    float of_end, of_own;
} straight_sum_t;
static const straight_sum_t sum_r = {1.0f, 0.5f}, sum_a = {0.788675135f, 0.311004234f},
                            sum_b = {0.211324865f, 0.0223290994f};
static const straight_sum_t sum_aa = {0.722008468f, 0.248803387f}, sum_ab = {0.233333333f, 0.0333333333f},
                            sum_bb = {0.144658199f, 0.0178632795f};

INLINE float summed(const straight_sum_t *sum, float of_end, float of_own)
{
    return brace_fma(sum->of_end, of_end, sum->of_own * of_own);
}

/* What look() tells of a link that nothing has turned, without what its springs move: good enough for a first step. */
INLINE void look_straight(const link_t *link, state_t *state)
{
    const brace_vec_t rigid_n = vec_plus_scaled(link->beyond_n, link->own_n, 0.5f);
    const float end_resists = vec_dot(link->beam_mm, link->beyond_n);
    const float own_resists = vec_dot(link->beam_mm, link->own_n);
    const float end_drives = vec_cross(link->beam_mm, link->beyond_n);
    const float own_drives = vec_cross(link->beam_mm, link->own_n);
    *state = (state_t){.resists = {vec_dot(link->to_beam_mm, rigid_n) + summed(&sum_r, end_resists, own_resists),
                                   summed(&sum_a, end_resists, own_resists),
                                   summed(&sum_b, end_resists, own_resists),
                                   summed(&sum_aa, end_resists, own_resists),
                                   summed(&sum_ab, end_resists, own_resists),
                                   summed(&sum_bb, end_resists, own_resists)},
                       .drive = {vec_cross(link->to_beam_mm, rigid_n) + summed(&sum_r, end_drives, own_drives),
                                 summed(&sum_a, end_drives, own_drives), summed(&sum_b, end_drives, own_drives)}};
}

/* A link's matrix with the load taken `times` as large. beyond: what resists the link's end because of all that comes
 * after it; the end turns by the sum of the coordinates, so this adds to each entry. */
INLINE matrix_t loaded_matrix(const state_t *state, float times, float beyond)
{
    const matrix_t *r = &state->resists;
    const float square = times * times;
    const float end = brace_fma(-square, state->end_softens, brace_fma(times, state->end_resists, beyond));
    return (matrix_t){brace_fma(-square, state->root_softens, brace_fma(times, r->rr, end)),
                      brace_fma(times, r->ra, end), brace_fma(times, r->rb, end),
                      brace_fma(times, r->aa, end), brace_fma(times, r->ab, end), brace_fma(times, r->bb, end)};
}

/* A link's matrix with its curvatures eliminated, first a, then b. What is left is its root. */
typedef struct {
    float pivot_a, pivot_b;
    float yields_a, yields_b;           /* compliance of each curvature, load included */
    float b_by_a, root_by_a, root_by_b; /* what eliminating one adds to another */
    float resists;                      /* of the root */
} factors_t;

INLINE factors_t factors_of(const matrix_t *m, float bend_rad_per_n_mm)
{
    factors_t f;
    f.pivot_a = brace_fma(bend_rad_per_n_mm, m->aa, 1.0f);
    f.yields_a = bend_rad_per_n_mm / f.pivot_a;
    f.b_by_a = m->ab * f.yields_a;
    f.root_by_a = m->ra * f.yields_a;
    const float bb = brace_fma(-m->ab, f.b_by_a, m->bb), rb = brace_fma(-m->ab, f.root_by_a, m->rb);
    f.pivot_b = brace_fma(bend_rad_per_n_mm, bb, 1.0f);
    f.yields_b = bend_rad_per_n_mm / f.pivot_b;
    f.root_by_b = rb * f.yields_b;
    f.resists = brace_fma(-rb, f.root_by_b, brace_fma(-m->ra, f.root_by_a, m->rr));
    return f;
}

/* One link on the way from the tip to the hip: its curvatures eliminated, and what drives each coordinate then. */
typedef struct {
    factors_t f;
    float a_driven, b_driven, driven;
} solved_t;

/* resists, drive: of all beyond the link. Newton's equations are written for the new shape itself, so what resists the
 * present shape is added to what drives it. */
INLINE solved_t solve_in(const state_t *state, const shape_t *now, float bend_rad_per_n_mm, float resists, float drive)
{
    const matrix_t m = loaded_matrix(state, 1.0f, 0.0f);
    const matrix_t whole = {m.rr + resists, m.ra + resists, m.rb + resists,
                            m.aa + resists, m.ab + resists, m.bb + resists};
    const float end = state->end_drive + drive;
    const float a = brace_fma(m.ra, now->root, brace_fma(m.aa, now->a, brace_fma(m.ab, now->b, state->drive.a + end)));
    const float b = brace_fma(m.rb, now->root, brace_fma(m.ab, now->a, brace_fma(m.bb, now->b, state->drive.b + end)));
    const float root =
        brace_fma(m.rr, now->root, brace_fma(m.ra, now->a, brace_fma(m.rb, now->b, state->drive.root + end)));
    solved_t s = {.f = factors_of(&whole, bend_rad_per_n_mm)};
    s.a_driven = a;
    s.b_driven = brace_fma(-s.f.b_by_a, a, b);
    s.driven = brace_fma(-s.f.root_by_b, s.b_driven, brace_fma(-s.f.root_by_a, a, root));
    return s;
}

/* The way out: a link's shape from the turn of its root. */
INLINE shape_t solve_out(const solved_t *s, float root)
{
    shape_t shape = {.root = root};
    shape.b = brace_fma(s->f.yields_b, s->b_driven, -(s->f.root_by_b * root));
    shape.a = brace_fma(s->f.yields_a, s->a_driven, -brace_fma(s->f.root_by_a, root, s->f.b_by_a * shape.b));
    return shape;
}

typedef struct {
    link_t femur, tibia;
    state_t femur_state, tibia_state;
    shape_t femur_shape, tibia_shape;
} limb_t;

/* A step of Newton's method towards the equilibrium. is_first: nothing is bent yet. */
INLINE void step(limb_t *limb, bool is_first, float hip_rad_per_n_mm, float knee_rad_per_n_mm)
{
    state_t state;
    if (is_first) {
        look_straight(&limb->tibia, &state);
    } else {
        look(&limb->tibia, &limb->tibia_shape, &state, NULL);
    }
    const solved_t tibia = solve_in(&state, &limb->tibia_shape, limb->tibia.bend_rad_per_n_mm, 0.0f, 0.0f);
    const float knee = 1.0f / brace_fma(knee_rad_per_n_mm, tibia.f.resists, 1.0f);
    if (is_first) {
        look_straight(&limb->femur, &state);
    } else {
        look(&limb->femur, &limb->femur_shape, &state, NULL);
    }
    const solved_t femur = solve_in(&state, &limb->femur_shape, limb->femur.bend_rad_per_n_mm, tibia.f.resists * knee,
                                    tibia.driven * knee);
    const float hip = 1.0f / brace_fma(hip_rad_per_n_mm, femur.f.resists, 1.0f);
    limb->femur_shape = solve_out(&femur, hip_rad_per_n_mm * femur.driven * hip);
    limb->tibia_shape =
        solve_out(&tibia, brace_fma(knee_rad_per_n_mm, tibia.driven, end_turn(&limb->femur_shape)) * knee);
}

/* The whole matrix, eliminated from the tip to the hip. */
typedef struct {
    factors_t femur, tibia;
    float hip, knee; /* pivots of the joints */
} pivots_t;

INLINE pivots_t pivots_at(const limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm, float times)
{
    pivots_t p;
    const matrix_t tibia = loaded_matrix(&limb->tibia_state, times, 0.0f);
    p.tibia = factors_of(&tibia, limb->tibia.bend_rad_per_n_mm);
    p.knee = brace_fma(knee_rad_per_n_mm, p.tibia.resists, 1.0f);
    const matrix_t femur = loaded_matrix(&limb->femur_state, times, p.tibia.resists / p.knee);
    p.femur = factors_of(&femur, limb->femur.bend_rad_per_n_mm);
    p.hip = brace_fma(hip_rad_per_n_mm, p.femur.resists, 1.0f);
    return p;
}

INLINE bool is_stable(const pivots_t *p, float least)
{
    return p->tibia.pivot_a > least && p->tibia.pivot_b > least && p->knee > least && p->femur.pivot_a > least &&
           p->femur.pivot_b > least && p->hip > least;
}

/* The determinant: it falls through zero where the first pivot does. */
INLINE float product(const pivots_t *p)
{
    return p->tibia.pivot_a * p->tibia.pivot_b * p->knee * (p->femur.pivot_a * p->femur.pivot_b * p->hip);
}

/* The load at which the first pivot reaches zero, as a multiple of the present one. Below it all pivots are positive.
 * The search halves the logarithm of the range 1 to 2^10 and ends with a chord through the last two determinants. */
enum { HALVINGS = 5 };

static float buckling_factor(const limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm, float product_now)
{
    static const float ratio[HALVINGS] = {32.0f, 5.65685425f, 2.37841423f, 1.54221083f, 1.24185781f};
    float low = 1.0f, high = INFINITY, at_low = product_now, at_high = 0.0f;
    for (int i = 0; i < HALVINGS; i++) {
        const float middle = low * ratio[i];
        const pivots_t p = pivots_at(limb, hip_rad_per_n_mm, knee_rad_per_n_mm, middle);
        if (is_stable(&p, 0.0f)) {
            low = middle;
            at_low = product(&p);
        } else {
            high = middle;
            at_high = product(&p);
        }
    }
    const float share = at_high < 0.0f ? at_low / (at_low - at_high) : 0.5f;
    return brace_fma(high - low, share, low);
}

/* Adds to C what a link's curvatures and springs yield. beyond: how all that comes after the link moves the tip when
 * the link's end turns. returns how the tip moves when the link's root turns */
INLINE brace_vec_t add_link(brace_tensor_t *c, const columns_t *columns, const factors_t *f, brace_vec_t beyond)
{
    const brace_vec_t end = vec_plus(columns->end, beyond);
    const brace_vec_t a = vec_plus(columns->a, end);
    const brace_vec_t b = vec_plus_scaled(vec_plus(columns->b, end), a, -f->b_by_a);
    const brace_vec_t root = vec_plus(vec_minus(vec_quarter(columns->tip_mm), columns->aside), beyond);
    brace_tensor_add(c, vec_scaled(a, sqrtf(f->yields_a)));
    brace_tensor_add(c, vec_scaled(b, sqrtf(f->yields_b)));
    brace_tensor_add(c, columns->root_spring);
    brace_tensor_add(c, columns->end_spring);
    return vec_plus_scaled(vec_plus_scaled(root, a, -f->root_by_a), b, -f->root_by_b);
}

INLINE link_t link_seen(const brace_loaded_link_t *link, brace_vec_t direction, brace_vec_t beyond_n, brace_vec_t down)
{
    return (link_t){.to_beam_mm = vec_turned(link->to_beam_mm, direction),
                    .beam_mm = vec_turned(link->beam_mm, direction),
                    .root_root = vec_turned(link->root_root, direction),
                    .end_root = vec_turned(link->end_root, direction),
                    .end_mm_per_n = link->end_mm_per_n,
                    .bend_rad_per_n_mm = link->bend_rad_per_n_mm,
                    .beyond_n = beyond_n,
                    .own_n = vec_scaled(down, link->weight_n)};
}

/* Where the tip is at an equilibrium, less where it is without load. */
static brace_displacement_t displacement_of(const brace_loaded_t *loaded, const limb_t *limb, const brace_load_t *load,
                                            brace_vec_t bent_mm, brace_vec_t femur)
{
    const brace_vec_t straight = vec_plus(vec_plus(limb->femur.to_beam_mm, limb->femur.beam_mm),
                                          vec_plus(limb->tibia.to_beam_mm, limb->tibia.beam_mm));
    const brace_vec_t moved = vec_turned(vec_minus(bent_mm, straight), femur);
    const float weight_n = loaded->tibia.weight_n + loaded->knee_weight_n + loaded->femur.weight_n;
    const brace_vec_t on_base = vec_plus_scaled((brace_vec_t){load->tip.x_n, load->tip.z_n}, load->down, weight_n);
    const brace_vec_t base = moved_by(loaded->base_mm_per_n, loaded->base_root, on_base);
    return (brace_displacement_t){moved.x + base.x, moved.z + base.z};
}

static bool is_bent_within(const shape_t *shape)
{
    return fabsf(shape->root) <= TURN_MOST_RAD && fabsf(end_turn(shape)) <= TURN_MOST_RAD;
}

brace_status_t brace_loaded_stiffness(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                      const brace_load_t *load, brace_loaded_stiffness_t *result)
{
    const float reach = brace_fma(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    const float force = fabsf(load->tip.x_n) + fabsf(load->tip.z_n);
    if (!(reach <= BRACE_REACH_RAD2 && force <= FORCE_MOST_N)) {
        return reach - reach == 0.0f && force - force == 0.0f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    const brace_vec_t forwards = {1.0f, 0.0f}, none = {0.0f, 0.0f}, femur = brace_direction(theta1_rad);
    const brace_vec_t tibia = brace_direction(-theta2_rad); /* seen from the femur */
    const brace_vec_t tip_n = vec_turned_back((brace_vec_t){load->tip.x_n, load->tip.z_n}, femur);
    const brace_vec_t down = vec_turned_back(load->down, femur);
    const brace_vec_t knee_n = vec_plus_scaled(tip_n, down, loaded->tibia.weight_n + loaded->knee_weight_n);
    limb_t limb = {.femur = link_seen(&loaded->femur, forwards, knee_n, down),
                   .tibia = link_seen(&loaded->tibia, tibia, tip_n, down),
                   .femur_shape = {0.0f, 0.0f, 0.0f},
                   .tibia_shape = {0.0f, 0.0f, 0.0f}};
    const float base = loaded->base_rotation_rad_per_n_mm;
    const float hip_yields = load->hip.yields_by_rad_per_n_mm + base, knee_yields = load->knee.yields_by_rad_per_n_mm;
    columns_t femur_columns, tibia_columns;
    step(&limb, true, hip_yields, knee_yields);
    step(&limb, false, hip_yields, knee_yields);
    look(&limb.femur, &limb.femur_shape, &limb.femur_state, &femur_columns);
    look(&limb.tibia, &limb.tibia_shape, &limb.tibia_state, &tibia_columns);

    const float hip = load->hip.slope_rad_per_n_mm + base, knee = load->knee.slope_rad_per_n_mm;
    const pivots_t p = pivots_at(&limb, hip, knee, 1.0f);
    if (!is_stable(&p, SINGULAR_PIVOT) || !is_bent_within(&limb.femur_shape) || !is_bent_within(&limb.tibia_shape)) {
        return BRACE_E_SINGULAR;
    }
    brace_tensor_t c = brace_tensor_of(loaded->base_mm_per_n + loaded->femur.end_mm_per_n + loaded->tibia.end_mm_per_n,
                                       vec_turned_back(loaded->base_root, femur));
    const brace_vec_t by_knee = add_link(&c, &tibia_columns, &p.tibia, none);
    brace_tensor_add(&c, vec_scaled(by_knee, sqrtf(knee / p.knee)));
    const brace_vec_t by_hip = add_link(&c, &femur_columns, &p.femur, vec_scaled(by_knee, 1.0f / p.knee));
    brace_tensor_add(&c, vec_scaled(by_hip, sqrtf(hip / p.hip)));
    brace_stiffness_t stiffness;
    const brace_status_t status = brace_tensor_inverse(&c, vec_doubled(femur), &stiffness);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_vec_t bent = vec_plus(femur_columns.tip_mm, tibia_columns.tip_mm);
    result->stiffness = stiffness;
    result->displacement = displacement_of(loaded, &limb, load, bent, femur);
    result->hip_turn_rad = limb.femur_shape.root;
    result->knee_turn_rad = limb.tibia_shape.root - end_turn(&limb.femur_shape);
    result->buckling_factor = buckling_factor(&limb, hip, knee, product(&p));
    return BRACE_OK;
}
