#include "brace/loaded_space.h"

#include <float.h>
#include <math.h>

#include "base/check.h"
#include "base/eigen.h"
#include "chain/tensor.h"
#include "loaded/space_buckling.h"
#include "loaded/space_parts.h"

#define SINGULAR 1e-3f
#define LEFT_MOST_RAD2 6.25e-4f /* square of 0.025 rad: levers that turn by so much change K by up to twice that, 5 % */
#define LEFT_PROMISED_RAD2 2.5e-5f /* square of 0.005 rad: beyond it no accuracy is promised */
#define LEFT_SURE_RAD2 1e-6f /* square of 0.001 rad: what further steps are not taken for */
#define LEFT_NOTHING_RAD2 1e-12f /* square of 1e-6 rad: the same where nobody waits; singles hardly tell more */
#define ROUNDS_MOST 2 /* of two steps each */
#define ROUNDS_ON_MOST 10 /* where nobody waits at all */
#define SHARES_MOST 64 /* of a load that is raised; the first, and the least */
#define SHARE_FIRST 0.125f
#define SHARE_LEAST 0.002f
#define ROUNDS_A_SHARE 3
#define FOLLOWED_RATIO2 0.25f /* square of the load's change over the load, beyond which a rest is not followed */
#define STEP_MOST_RAD2 1.44f /* square of 1.2 rad: a longer step is shortened to it */
#define SMALL_TURN_RAD2 1.0f /* squares: what brace_small_turn() takes, */
#define LINKS_RAD2 2.25f /* and of links, which turn half way on either side */
#define JOINT_TURN_RAD 1.5f /* sine and cosine of base/trig.h hold up to pi/2 */
#define FORCE_MOST_N 1e4f
#define BEND_PROMISED_RAD2 0.09f /* square of 0.3 rad, see bends_beyond */
#define SLENDER 1e-4f /* least over largest eigenvalue; below it the accuracy is not promised */

/* The limb's plane's frame, x outwards, y to the left, z up, as the coxa's frame at rest: x outwards, y up, z to the
 * right; and back. */
static vec3_t seen_from_coxa(brace_vec3_t v)
{
    return vec3(v.x, v.z, -v.y);
}

static brace_vec3_t seen_from_plane(vec3_t v)
{
    return vec3(v.x, -v.z, v.y);
}

/* --- the equilibrium ------------------------------------------------------------------------------------------ */

INLINE float dot_of_poses(const brace_space_pose_t *a, const brace_space_pose_t *b)
{
    const float links = vec3_dot(a->coxa, b->coxa) + vec3_dot(a->femur, b->femur) + vec3_dot(a->tibia, b->tibia);
    return links + brace_fma(a->base, b->base, a->yaw * b->yaw) + brace_fma(a->hip, b->hip, a->knee * b->knee);
}

INLINE void add_to_pose(brace_space_pose_t *pose, const brace_space_pose_t *more, float by)
{
    pose->coxa = vec3_plus_scaled(pose->coxa, more->coxa, by);
    pose->femur = vec3_plus_scaled(pose->femur, more->femur, by);
    pose->tibia = vec3_plus_scaled(pose->tibia, more->tibia, by);
    pose->base = brace_fma(by, more->base, pose->base);
    pose->yaw = brace_fma(by, more->yaw, pose->yaw);
    pose->hip = brace_fma(by, more->hip, pose->hip);
    pose->knee = brace_fma(by, more->knee, pose->knee);
}

/* The whole of a series of steps, each the same multiple of the one before, without its first step, over its second. */
INLINE float over_second_step(float second_by_first, float first2)
{
    const float ratio = second_by_first / (first2 + FLT_MIN);
    return 1.0f / (1.0f - (ratio > 0.5f ? 0.5f : ratio < -0.9f ? -0.9f : ratio));
}

static void see_straight(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                         const commanded_t *commanded, forces_t at[3])
{
    const vec3_t tip_n = rest->tip_n, down = rest->down;
    const vec3_t femur_n = about_z(tip_n, back(commanded->hip)), femur_down = about_z(down, back(commanded->hip));
    const vec3_t tibia_n = about_z(femur_n, back(commanded->knee));
    const vec3_t tibia_down = about_z(femur_down, back(commanded->knee));
    at[0] = (forces_t){rest->whole_n, {0.0f, 0.0f, 0.0f}};
    at[1] = (forces_t){vec3_plus_scaled(femur_n, femur_down, loaded->beyond_femur_n),
                       vec3_scaled(femur_down, loaded->femur.weight_n)};
    at[2] = (forces_t){tibia_n, vec3_scaled(tibia_down, loaded->tibia.weight_n)};
}

typedef brace_space_settling_t settling_t;

/* Bends the limb to its pose. curls: of the shape before; then of this one. drives: where asked for */
static void bend_to(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, bool is_driven, settling_t *settling)
{
    const commanded_t commanded = {rest->hip_commanded, rest->knee_commanded};
    turns_of(&rest->pose, settling->curls, &commanded, &rest->turns);
    see_forces(loaded, rest->tip_n, rest->down, rest);
    bend_limb(loaded, rest, &settling->curls, is_driven, &settling->drives);
}

/* Steps are taken in rounds of two: the matrix of a straight limb is eliminated, and both solve with it. The first
 * round's limb stands at the commanded angles, that of a later one at the angles and under the forces that the steps
 * before have come to. */

static void begin_round_straight(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, settling_t *settling)
{
    static const brace_space_pose_t straight;
    const commanded_t commanded = {rest->hip_commanded, rest->knee_commanded};
    forces_t at[3];
    rest->pose = straight;
    settling->hip = commanded.hip;
    settling->knee = commanded.knee;
    settling->curls = (curls_t){0.0f, 0.0f};
    see_straight(loaded, rest, &commanded, at);
    straight_limb(loaded, at, &commanded, rest, &settling->factors, &settling->drives);
}

static void begin_round_bent(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, settling_t *settling)
{
    const commanded_t turned = {rest->turns.hip, rest->turns.knee};
    const forces_t at[3] = {{rest->coxa.beyond_n, rest->coxa.own_n},
                            {rest->femur.beyond_n, rest->femur.own_n},
                            {rest->tibia.beyond_n, rest->tibia.own_n}};
    brace_space_pose_t drives; /* of the straight limb: the bent limb's are known */
    settling->hip = turned.hip;
    settling->knee = turned.knee;
    straight_limb(loaded, at, &turned, rest, &settling->factors, &drives);
}

INLINE float step_scale(float step2)
{
    return step2 > STEP_MOST_RAD2 ? sqrtf(STEP_MOST_RAD2 / step2) : 1.0f;
}

static void first_step(brace_space_rest_t *rest, settling_t *settling)
{
    const commanded_t commanded = {settling->hip, settling->knee};
    brace_space_pose_t step;
    solve_straight(&settling->factors, &settling->drives, &rest->pose, &commanded, &step);
    const float first2 = dot_of_poses(&step, &step), scale = step_scale(first2);
    static const brace_space_pose_t none;
    settling->first = none;
    add_to_pose(&settling->first, &step, scale);
    add_to_pose(&rest->pose, &settling->first, 1.0f);
    rest->left_rad2 = first2 * settling->shrinks_ratio2;
}

/* Prolonged. What both steps leave is about the third of such a series, second^2/first, or the second itself where that
 * is less: where a force goes through a joint, the first step is small and says nothing about those that follow. */
static void second_step(brace_space_rest_t *rest, settling_t *settling)
{
    const commanded_t commanded = {settling->hip, settling->knee};
    brace_space_pose_t step;
    solve_straight(&settling->factors, &settling->drives, &rest->pose, &commanded, &step);
    const float first2 = dot_of_poses(&settling->first, &settling->first), second2 = dot_of_poses(&step, &step);
    const float prolonged = over_second_step(dot_of_poses(&step, &settling->first), first2);
    add_to_pose(&rest->pose, &step, prolonged * step_scale(prolonged * prolonged * second2));
    settling->shrinks_ratio2 = second2 / (first2 + second2 + FLT_MIN);
    rest->left_rad2 = second2 * settling->shrinks_ratio2;
}

/* A later round's matrix is nearer to the limb's own, so its steps shrink at least as fast as those of the round
 * before. Where that leaves nothing to go for, its first step is enough. */
static bool first_is_enough(const brace_space_rest_t *rest, bool is_first, float sure_rad2)
{
    return !is_first && rest->left_rad2 <= sure_rad2;
}

static bool is_within(const brace_space_pose_t *pose)
{
    const float links =
        vec3_dot(pose->coxa, pose->coxa) + vec3_dot(pose->femur, pose->femur) + vec3_dot(pose->tibia, pose->tibia);
    return links <= LINKS_RAD2 && brace_fma(pose->base, pose->base, pose->yaw * pose->yaw) <= SMALL_TURN_RAD2 &&
           fabsf(brace_fma(0.5f, pose->coxa.z + pose->femur.z, pose->hip)) <= JOINT_TURN_RAD &&
           fabsf(brace_fma(0.5f, pose->femur.z + pose->tibia.z, pose->knee)) <= JOINT_TURN_RAD;
}

/* --- K -------------------------------------------------------------------------------------------------------- */

/* C^-1 by its cofactors. returns det C */
static float inverse(const sym3_t *c, sym3_t *k)
{
    const sym3_t cofactor = {brace_fma(c->yy, c->zz, -(c->yz * c->yz)), brace_fma(c->xz, c->yz, -(c->xy * c->zz)),
                             brace_fma(c->xy, c->yz, -(c->xz * c->yy)), brace_fma(c->xx, c->zz, -(c->xz * c->xz)),
                             brace_fma(c->xy, c->xz, -(c->xx * c->yz)), brace_fma(c->xx, c->yy, -(c->xy * c->xy))};
    const float det = brace_fma(c->xx, cofactor.xx, brace_fma(c->xy, cofactor.xy, c->xz * cofactor.xz));
    const float per_det = 1.0f / det;
    *k = (sym3_t){cofactor.xx * per_det, cofactor.xy * per_det, cofactor.xz * per_det,
                  cofactor.yy * per_det, cofactor.yz * per_det, cofactor.zz * per_det};
    return det;
}

/* Takes the inputs over. returns as brace_loaded_space_settle */
static brace_status_t take(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                           const brace_space_load_t *load, brace_space_rest_t *rest)
{
    const float reach = brace_fma(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    const float force = fabsf(load->tip_n.x) + fabsf(load->tip_n.y) + fabsf(load->tip_n.z);
    if (brace_bits(reach) > brace_bits(BRACE_REACH_RAD2) || brace_bits(force) > brace_bits(FORCE_MOST_N)) {
        return brace_refusal_of(reach, force);
    }
    const vec3_t tip_n = seen_from_coxa(load->tip_n), down = seen_from_coxa(load->down);
    rest->hip_commanded = brace_direction(theta1_rad);
    rest->knee_commanded = brace_direction(-theta2_rad);
    rest->tip_n = tip_n;
    rest->down = down;
    rest->whole_n = vec3_plus_scaled(tip_n, down, loaded->beyond_coxa_n);
    rest->yaw = load->yaw;
    rest->hip = load->hip;
    rest->knee = load->knee;
    return BRACE_OK;
}

/* A round, and the limb bent as it leads. is_first: from the straight limb; else from where the limb is bent to.
 * sure_rad2: less than this need not be gone for */
static void take_round(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, bool is_first, float sure_rad2,
                       settling_t *settling)
{
    if (is_first) {
        begin_round_straight(loaded, rest, settling);
    } else {
        begin_round_bent(loaded, rest, settling);
    }
    first_step(rest, settling);
    const bool is_there = first_is_enough(rest, is_first, sure_rad2);
    bend_to(loaded, rest, !is_there, settling);
    if (!is_there) {
        second_step(rest, settling);
        bend_to(loaded, rest, rest->left_rad2 > sure_rad2, settling);
    }
}

static brace_status_t rest_found(const brace_space_rest_t *rest)
{
    return rest->left_rad2 <= LEFT_MOST_RAD2 && is_within(&rest->pose) ? BRACE_OK : BRACE_E_SINGULAR;
}

brace_status_t brace_loaded_space_settle(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                         const brace_space_load_t *load, brace_space_rest_t *rest)
{
    settling_t settling;
    const brace_status_t status = take(loaded, theta1_rad, theta2_rad, load, rest);
    if (status != BRACE_OK) {
        return status;
    }
    take_round(loaded, rest, true, LEFT_SURE_RAD2, &settling);
    for (int rounds = 1; rounds < ROUNDS_MOST && rest->left_rad2 > LEFT_SURE_RAD2; rounds++) {
        take_round(loaded, rest, false, LEFT_SURE_RAD2, &settling);
    }
    return rest_found(rest);
}

/* Bends the limb anew to its pose, under the load that it has now. */
static void begin_again(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, settling_t *settling)
{
    settling->shrinks_ratio2 = 1.0f;
    settling->curls = (curls_t){curl_of(&rest->coxa, rest->pose.coxa), curl_of(&rest->femur, rest->pose.femur)};
    bend_to(loaded, rest, true, settling);
}

/* One step from where the limb is bent to. What it leaves are the steps that would follow. */
static void take_one_step(const brace_loaded_space_t *loaded, brace_space_rest_t *rest)
{
    settling_t settling;
    brace_space_pose_t next;
    begin_again(loaded, rest, &settling);
    begin_round_bent(loaded, rest, &settling);
    first_step(rest, &settling);
    bend_to(loaded, rest, true, &settling);
    const commanded_t commanded = {settling.hip, settling.knee};
    solve_straight(&settling.factors, &settling.drives, &rest->pose, &commanded, &next);
    const float first2 = dot_of_poses(&settling.first, &settling.first), next2 = dot_of_poses(&next, &next);
    const float all = over_second_step(dot_of_poses(&next, &settling.first), first2);
    rest->left_rad2 = all * all * next2;
}

static bool is_near(vec3_t load_n, vec3_t before_n)
{
    const vec3_t change_n = vec3_plus_scaled(load_n, before_n, -1.0f);
    return vec3_dot(change_n, change_n) <= FOLLOWED_RATIO2 * vec3_dot(load_n, load_n);
}

brace_status_t brace_loaded_space_follow(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                         const brace_space_load_t *load, bool is_rest, brace_space_rest_t *rest)
{
    settling_t settling;
    const vec3_t before_n = rest->whole_n;
    const brace_status_t status = take(loaded, theta1_rad, theta2_rad, load, rest);
    if (status != BRACE_OK) {
        return status;
    }
    if (is_rest && is_near(rest->whole_n, before_n)) {
        take_one_step(loaded, rest);
    } else {
        take_round(loaded, rest, true, LEFT_SURE_RAD2, &settling);
    }
    return rest_found(rest);
}

/* Rounds from where the limb is bent to, one at least. */
static brace_status_t go_on(const brace_loaded_space_t *loaded, brace_space_rest_t *rest, int most, float sure_rad2)
{
    settling_t settling;
    begin_again(loaded, rest, &settling);
    int rounds = 0;
    do {
        take_round(loaded, rest, false, sure_rad2, &settling);
        rounds++;
    } while (rounds < most && rest->left_rad2 > sure_rad2);
    return rest_found(rest);
}

static void put_load(const brace_loaded_space_t *loaded, vec3_t tip_n, vec3_t down, float share,
                     brace_space_rest_t *rest)
{
    rest->tip_n = vec3_scaled(tip_n, share);
    rest->down = vec3_scaled(down, share);
    rest->whole_n = vec3_plus_scaled(rest->tip_n, rest->down, loaded->beyond_coxa_n);
}

/* Raises force and weight from none, each share from the rest under the one before; a share without a rest is
 * halved. */
static brace_status_t raise_load(const brace_loaded_space_t *loaded, brace_space_rest_t *rest)
{
    static const brace_space_pose_t straight;
    const vec3_t tip_n = rest->tip_n, down = rest->down;
    brace_space_rest_t reached = *rest;
    float at = 0.0f, by = SHARE_FIRST;
    brace_status_t status = BRACE_E_SINGULAR;
    reached.pose = straight;
    for (int tries = 0; tries < SHARES_MOST && at < 1.0f && by >= SHARE_LEAST; tries++) {
        const float share = at + by < 1.0f ? at + by : 1.0f;
        *rest = reached;
        put_load(loaded, tip_n, down, share, rest);
        status = go_on(loaded, rest, ROUNDS_A_SHARE, LEFT_SURE_RAD2);
        if (status == BRACE_OK && rest->left_rad2 <= LEFT_SURE_RAD2) {
            reached = *rest;
            at = share;
            by += by;
        } else {
            status = BRACE_E_SINGULAR;
            by *= 0.5f;
        }
    }
    put_load(loaded, tip_n, down, 1.0f, rest);
    return status;
}

brace_status_t brace_loaded_space_settle_on(const brace_loaded_space_t *loaded, brace_space_rest_t *rest)
{
    brace_status_t status = go_on(loaded, rest, ROUNDS_ON_MOST, LEFT_NOTHING_RAD2);
    if (status != BRACE_OK && raise_load(loaded, rest) == BRACE_OK) {
        status = go_on(loaded, rest, ROUNDS_ON_MOST, LEFT_NOTHING_RAD2);
    }
    return status;
}

/* How far the tip has moved from where the commanded limb has it. */
static vec3_t moved_mm(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, vec3_t tip_mm)
{
    const brace_vec_t femur = rest->hip_commanded, tibia = vec_turned(rest->knee_commanded, femur);
    vec3_t moved = tip_mm;
    moved.x -= brace_fma(loaded->femur.length_mm, femur.x, loaded->tibia.length_mm * tibia.x);
    moved.y -= brace_fma(loaded->femur.length_mm, femur.z, loaded->tibia.length_mm * tibia.z);
    moved.x = brace_fma(loaded->base_x_mm_per_n, rest->whole_n.x, moved.x);
    moved.y = brace_fma(loaded->base_z_mm_per_n, rest->whole_n.y, moved.y);
    return moved;
}

/* returns whether the equilibrium is stable */
static bool eliminate_rest(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, freedoms_t *free)
{
    const pivots_t pivots = eliminate_limb(loaded, rest, free);
    return is_stable(&pivots) && pivots.product > SINGULAR;
}

static void sum_first(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest, const freedoms_t *free,
                      axes_t *coxa, sum_t *sum)
{
    frames_t frames;
    frames_of(&rest->turns, &frames);
    sum_outer(loaded, rest, free, &frames, sum);
    *coxa = frames.coxa;
}

/* A link is one part: half of its own turn lies on either side of a straight chord. A turn of 0.3 rad is off by about a
 * twelfth of its square, 0.75 %. */
INLINE bool bends_beyond(vec3_t turn)
{
    return brace_fma(turn.y, turn.y, turn.z * turn.z) > BEND_PROMISED_RAD2;
}

static uint32_t flags_of(const brace_space_rest_t *rest)
{
    const brace_space_pose_t *pose = &rest->pose;
    const bool is_beyond = bends_beyond(pose->coxa) || bends_beyond(pose->femur) || bends_beyond(pose->tibia) ||
                           rest->left_rad2 > LEFT_PROMISED_RAD2;
    return is_beyond ? (uint32_t)BRACE_FLAG_NEAR_SINGULAR : 0u;
}

/* sum: as sum_first has left it; then whole
 * returns as brace_loaded_space_stiffness */
static brace_status_t sum_second(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                                 const freedoms_t *free, const axes_t *coxa, sum_t *sum, brace_space_result_t *result)
{
    sym3_t k;
    sum_inner(loaded, rest, free, coxa, sum);
    if (!(inverse(&sum->c, &k) > 0.0f)) {
        return BRACE_E_SINGULAR;
    }
    result->k = (brace_k3_t){k.xx, -k.xz, k.xy, k.zz, -k.yz, k.yy};
    result->displacement_mm = seen_from_plane(moved_mm(loaded, rest, sum->tip_mm));
    result->tibia_mm = seen_from_plane(sum->tibia_mm);
    result->yaw_turn_rad = rest->pose.yaw;
    result->hip_turn_rad = rest->pose.hip;
    result->knee_turn_rad = rest->pose.knee;
    result->flags = flags_of(rest);
    return BRACE_OK;
}

brace_status_t brace_loaded_space_stiffness(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                                            brace_space_result_t *result)
{
    freedoms_t free;
    axes_t coxa;
    sum_t sum;
    if (!eliminate_rest(loaded, rest, &free)) {
        return BRACE_E_SINGULAR;
    }
    sum_first(loaded, rest, &free, &coxa, &sum);
    return sum_second(loaded, rest, &free, &coxa, &sum, result);
}

/* --- in steps ------------------------------------------------------------------------------------------------- */

enum { STEP_FIRST = 0, BEND_FIRST, STEP_SECOND, ELIMINATE, SUM_FIRST, SUM_SECOND };

brace_status_t brace_loaded_space_begin(const brace_loaded_space_t *loaded, float theta1_rad, float theta2_rad,
                                        const brace_space_load_t *load, brace_space_work_t *work)
{
    work->step = STEP_FIRST;
    work->rounds = 0;
    return take(loaded, theta1_rad, theta2_rad, load, &work->rest);
}

static void work_first_step(const brace_loaded_space_t *loaded, brace_space_work_t *work)
{
    if (work->rounds == 0u) {
        begin_round_straight(loaded, &work->rest, &work->of.settling);
    } else {
        begin_round_bent(loaded, &work->rest, &work->of.settling);
    }
    first_step(&work->rest, &work->of.settling);
    work->rounds++;
}

/* returns as work_second_step */
static bool work_first_bend(const brace_loaded_space_t *loaded, brace_space_work_t *work)
{
    settling_t *settling = &work->of.settling;
    const bool is_there = first_is_enough(&work->rest, work->rounds == 1u, LEFT_SURE_RAD2);
    bend_to(loaded, &work->rest, !is_there, settling);
    work->step = is_there ? ELIMINATE : STEP_SECOND;
    return !is_there || rest_found(&work->rest) == BRACE_OK;
}

/* returns whether the work goes on: with another step or round, or because the limb rests */
static bool work_second_step(const brace_loaded_space_t *loaded, brace_space_work_t *work)
{
    settling_t *settling = &work->of.settling;
    second_step(&work->rest, settling);
    const bool is_sure = !(work->rest.left_rad2 > LEFT_SURE_RAD2), is_last = work->rounds >= ROUNDS_MOST;
    bend_to(loaded, &work->rest, !is_sure, settling);
    work->step = is_sure || is_last ? ELIMINATE : STEP_FIRST;
    return work->step == STEP_FIRST || rest_found(&work->rest) == BRACE_OK;
}

bool brace_loaded_space_step(const brace_loaded_space_t *loaded, brace_space_work_t *work, brace_space_result_t *result,
                             brace_status_t *status)
{
    brace_space_rest_t *rest = &work->rest;
    freedoms_t *free = &work->of.summing.freedoms;
    axes_t *coxa = &work->of.summing.coxa;
    sum_t *sum = &work->of.summing.sum;
    bool goes_on = true;
    switch (work->step++) {
    case STEP_FIRST: work_first_step(loaded, work); break;
    case BEND_FIRST: goes_on = work_first_bend(loaded, work); break;
    case STEP_SECOND: goes_on = work_second_step(loaded, work); break;
    case ELIMINATE: goes_on = eliminate_rest(loaded, rest, free); break;
    case SUM_FIRST: sum_first(loaded, rest, free, coxa, sum); break;
    default: *status = sum_second(loaded, rest, free, coxa, sum, result); return true; /* SUM_SECOND */
    }
    *status = goes_on ? BRACE_OK : BRACE_E_SINGULAR;
    return !goes_on;
}

brace_status_t brace_loaded_space_in_plane(const brace_k3_t *k, brace_stiffness_t *plane)
{
    const float mean = 0.5f * (k->xx_n_per_mm + k->zz_n_per_mm), along = 0.5f * (k->xx_n_per_mm - k->zz_n_per_mm);
    const float aside = k->xz_n_per_mm, squared = aside * aside;
    const float radius = sqrtf(brace_fma(along, along, squared + FLT_MIN));
    const float det = brace_fma(k->xx_n_per_mm, k->zz_n_per_mm, -squared), slenderness = det / (mean * mean);
    if (!(slenderness > BRACE_SINGULAR && mean > 0.0f)) {
        return BRACE_E_SINGULAR;
    }
    *plane = (brace_stiffness_t){.k_xx_n_per_mm = k->xx_n_per_mm,
                                 .k_xz_n_per_mm = aside,
                                 .k_zz_n_per_mm = k->zz_n_per_mm,
                                 .lambda_min_n_per_mm = det / (mean + radius),
                                 .lambda_max_n_per_mm = mean + radius,
                                 .stiff_axis_rad = brace_half_angle_of_opposite(-along, -aside, radius),
                                 .flags = slenderness < BRACE_SLENDER ? BRACE_FLAG_NEAR_SINGULAR : 0u};
    return BRACE_OK;
}

/* The axis points outwards in the limb's plane, or to the left where it is across it. */
static brace_vec3_t outwards_axis(brace_vec3_t axis)
{
    const float across = 1e-4f * axis.y; /* decides only where rounding would */
    const float sign = axis.x + across < 0.0f ? -1.0f : 1.0f;
    return (brace_vec3_t){sign * axis.x, sign * axis.y, sign * axis.z};
}

brace_status_t brace_loaded_space_turn(float theta0_rad, const brace_k3_t *k, brace_stiffness_spatial_t *stiffness)
{
    const brace_status_t status = brace_check_magnitude(theta0_rad, BRACE_ANGLE_LIMIT_RAD);
    if (status != BRACE_OK) {
        return status;
    }
    brace_jacobi_t m;
    brace_jacobi(k, &m);
    const bool x_is_less = m.xx < m.yy;
    const float low = x_is_less ? m.xx : m.yy, high = x_is_less ? m.yy : m.xx;
    if (!(low > 0.0f && m.zz > 0.0f && high <= FLT_MAX && m.zz <= FLT_MAX)) {
        return BRACE_E_SINGULAR;
    }
    const float least = m.zz < low ? m.zz : low, most = m.zz > high ? m.zz : high;
    const brace_vec3_t axis = outwards_axis(m.zz > high ? m.z : x_is_less ? m.y : m.x);
    const brace_vec_t yaw = brace_direction(theta0_rad);
    sym3_t turned = {k->xx_n_per_mm, k->xy_n_per_mm, k->xz_n_per_mm, k->yy_n_per_mm, k->yz_n_per_mm, k->zz_n_per_mm};
    sym3_about_z(&turned, yaw);
    const vec3_t turned_axis = about_z(axis, yaw);
    *stiffness = (brace_stiffness_spatial_t){.k_xx_n_per_mm = turned.xx,
                                             .k_xy_n_per_mm = turned.xy,
                                             .k_xz_n_per_mm = turned.xz,
                                             .k_yy_n_per_mm = turned.yy,
                                             .k_yz_n_per_mm = turned.yz,
                                             .k_zz_n_per_mm = turned.zz,
                                             .lambda_n_per_mm = {least,
                                                                 m.zz < low    ? low
                                                                 : m.zz > high ? high
                                                                               : m.zz,
                                                                 most},
                                             .stiff_axis = {turned_axis.x, turned_axis.y, turned_axis.z},
                                             .flags = least < SLENDER * most ? BRACE_FLAG_NEAR_SINGULAR : 0u};
    return BRACE_OK;
}

/* --- buckling ------------------------------------------------------------------------------------------------- */

void brace_loaded_space_buckling_begin(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest,
                                       brace_space_shape_t *shape, brace_space_search_t *search)
{
    shape_limb(loaded, rest, shape);
    search->known.step = 0;
    search->links_held = 0;
}

/* What the limb is like under a load is known. returns whether the search ends with it; then writes factor */
INLINE bool narrow(brace_buckling_search_t *known, float at, const pivots_t *pivots, float *factor)
{
    const int step = known->step;
    if (step == 0) {
        *known = buckling_search_from(pivots->product);
    } else {
        space_search_narrow(known, at, (softened_t){pivots->product, is_stable(pivots)});
    }
    const bool is_last = step == SPACE_SEARCH_STEPS;
    known->step = is_last ? 0 : step + 1;
    if (is_last) {
        *factor = space_search_end(known);
    }
    return is_last;
}

bool brace_loaded_space_buckling_step(const brace_loaded_space_t *loaded, const brace_space_shape_t *shape,
                                      brace_space_search_t *search, float *factor)
{
    brace_buckling_search_t *known = &search->known;
    held_t held = {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    pivots_t pivots = {0u, 1.0f};
    if (search->links_held == 0u) {
        search->at = known->step == 0 ? 1.0f : space_search_at(known, known->step - 1);
        hold_link(loaded, shape, BRACE_TIBIA, search->at, &held, &pivots);
    } else {
        held = search->held;
        pivots = search->pivots;
        if (search->links_held > 1u) {
            hold_link(loaded, shape, BRACE_COXA, search->at, &held, &pivots);
            hold_base(loaded, shape, search->at, &held, &pivots);
            search->links_held = 0;
            return narrow(known, search->at, &pivots, factor);
        }
        hold_link(loaded, shape, BRACE_FEMUR, search->at, &held, &pivots);
    }
    search->held = held;
    search->pivots = pivots;
    search->links_held++;
    return false;
}

float brace_loaded_space_buckling_factor(const brace_loaded_space_t *loaded, const brace_space_rest_t *rest)
{
    brace_space_shape_t shape;
    brace_space_search_t search;
    float factor = INFINITY;
    brace_loaded_space_buckling_begin(loaded, rest, &shape, &search);
    for (int link = 0; link < BRACE_LINK_COUNT * (SPACE_SEARCH_STEPS + 1); link++) {
        (void)brace_loaded_space_buckling_step(loaded, &shape, &search, &factor);
    }
    return factor;
}
