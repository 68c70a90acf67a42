#include "brace/loaded_batch.h"

#include <math.h>

#include "brace/loaded_space.h"
#include "brace/spatial.h"

#define NOT_A_NUMBER __builtin_nanf("")

static void refuse(brace_status_t status, brace_loaded_stiffness_t *result)
{
    const uint32_t flags = status == BRACE_E_SINGULAR ? BRACE_FLAG_NEAR_SINGULAR | BRACE_FLAG_SOFTENED : 0u;
    *result = (brace_loaded_stiffness_t){
        .stiffness = {NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, NOT_A_NUMBER, flags},
        .displacement = {NOT_A_NUMBER, NOT_A_NUMBER},
        .tibia_mm = {NOT_A_NUMBER, NOT_A_NUMBER},
        .hip_turn_rad = NOT_A_NUMBER,
        .knee_turn_rad = NOT_A_NUMBER,
        .buckling_factor = NOT_A_NUMBER};
}

/* One row. returns whether it was refused, 1 or 0 */
static size_t finish(brace_status_t status, float reach_mm, brace_loaded_stiffness_t *result)
{
    const brace_displacement_t moved = result->displacement;
    if (status != BRACE_OK) {
        refuse(status, result);
        return 1;
    }
    result->stiffness.flags |=
        brace_loaded_flags(result->buckling_factor, moved.x_mm * moved.x_mm + moved.z_mm * moved.z_mm, reach_mm);
    return 0;
}

static brace_load_t with_force(const brace_load_t *joints, float x_n, float z_n)
{
    brace_load_t load = *joints;
    load.tip = (brace_force_t){x_n, z_n};
    return load;
}

size_t brace_loaded_batch(const brace_loaded_t *loaded, const brace_load_t *joints, size_t n, const float *theta1_rad,
                          const float *theta2_rad, const float *x_n, const float *z_n,
                          brace_loaded_stiffness_t *results)
{
    const float reach_mm = loaded->femur.length_mm + loaded->tibia.length_mm;
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        const brace_load_t load = with_force(joints, x_n[i], z_n[i]);
        refuse(BRACE_OK, &results[i]);
        refused += finish(brace_loaded_stiffness(loaded, theta1_rad[i], theta2_rad[i], &load, &results[i]), reach_mm,
                          &results[i]);
    }
    return refused;
}

size_t brace_loaded_fixed_batch(const brace_loaded_fixed_t *fixed, float reach_mm, const brace_load_t *joints, size_t n,
                                const float *theta1_rad, const float *theta2_rad, const float *x_n, const float *z_n,
                                brace_loaded_stiffness_t *results)
{
    size_t refused = 0;
    for (size_t i = 0; i < n; i++) { /* at most the host's columns */
        const brace_load_t load = with_force(joints, x_n[i], z_n[i]);
        refuse(BRACE_OK, &results[i]);
        refused += finish(brace_loaded_fixed_stiffness(fixed, theta1_rad[i], theta2_rad[i], &load, &results[i]),
                          reach_mm, &results[i]);
    }
    return refused;
}

uint32_t brace_loaded_space_flags(const brace_space_result_t *result, float buckling_factor, float reach_mm)
{
    const brace_vec3_t moved = result->displacement_mm;
    return result->flags |
           brace_loaded_flags(buckling_factor, moved.x * moved.x + moved.y * moved.y + moved.z * moved.z, reach_mm);
}

/* What the motor of the femur joint, and of the tibia joint, holds: theta2 is flexion, so its sense is clockwise. */
static void loads_of(const brace_pose_t *pose, const brace_gravity_t *weights, const brace_load_t *load, float n_mm[2])
{
    const brace_vec_t down = load->down;
    const float knee_mm = pose->knee.z_mm * down.x - pose->knee.x_mm * down.z;
    const float shank_mm = 0.5f * (pose->tip.z_mm * down.x - pose->tip.x_mm * down.z - knee_mm);
    const brace_force_t f = load->tip;
    n_mm[0] = (0.5f * weights->femur_n + weights->knee_n + weights->tibia_n) * knee_mm + weights->tibia_n * shank_mm -
              (pose->lever_femur.x_mm * f.x_n + pose->lever_femur.z_mm * f.z_n);
    n_mm[1] = pose->lever_tibia.x_mm * f.x_n + pose->lever_tibia.z_mm * f.z_n - weights->tibia_n * shank_mm;
}

/* The pose bent as a rest under a load has it. moved: of the tip; tibia: from the knee to the tip */
static void bent_pose(const brace_limb_t *limb, float theta1_rad, float theta2_rad, brace_vec_t moved_mm,
                      brace_vec_t tibia_mm, brace_pose_t *pose)
{
    brace_kinematics_pose(limb, theta1_rad, theta2_rad, pose);
    pose->tip = (brace_point_t){pose->tip.x_mm + moved_mm.x, pose->tip.z_mm + moved_mm.z};
    pose->knee = (brace_point_t){pose->tip.x_mm - tibia_mm.x, pose->tip.z_mm - tibia_mm.z};
    pose->lever_femur = (brace_point_t){-pose->tip.z_mm, pose->tip.x_mm};
    pose->lever_tibia = (brace_point_t){-tibia_mm.z, tibia_mm.x};
}

/* index: BRACE_COXA to BRACE_TIBIA */
static brace_engagement_t engagement_of(const brace_limb_t *limb, int index, const brace_pose_t *pose,
                                        const brace_play_joint_t *joint, const brace_backlash_t *machine,
                                        float load_n_mm)
{
    const brace_point_t lever = index == BRACE_FEMUR ? pose->lever_femur : pose->lever_tibia;
    if (!(limb->joint[index].gap_rad >= BRACE_BACKLASH_LEAST_GAP_RAD)) {
        return (brace_engagement_t){0, true, false};
    }
    return brace_play_at_rest(joint, machine, load_n_mm, fabsf(lever.x_mm) + fabsf(lever.z_mm), index != BRACE_COXA);
}

brace_status_t brace_loaded_play(const brace_limb_t *limb, const brace_gravity_t *weights, float theta1_rad,
                                 float theta2_rad, const brace_load_t *load, const brace_loaded_stiffness_t *rest,
                                 const brace_play_joint_t joint[2], const brace_backlash_t *const machine[2],
                                 brace_engagement_t engaged[2], brace_gap_stiffness_t *k)
{
    static const uint32_t bit[2] = {BRACE_GAP_FEMUR, BRACE_GAP_TIBIA};
    const brace_vec_t moved_mm = {rest->displacement.x_mm, rest->displacement.z_mm};
    brace_pose_t pose;
    float load_n_mm[2];
    uint32_t open = 0, assumed = 0;
    bent_pose(limb, theta1_rad, theta2_rad, moved_mm, rest->tibia_mm, &pose);
    loads_of(&pose, weights, load, load_n_mm);
    for (int i = 0; i < 2; i++) {
        engaged[i] = engagement_of(limb, BRACE_FEMUR + i, &pose, &joint[i], machine[i], load_n_mm[i]);
        open |= engaged[i].is_engaged ? 0u : bit[i];
        assumed |= engaged[i].is_assumed ? (uint32_t)BRACE_FLAG_PLAY_ASSUMED : 0u;
    }
    const brace_status_t status = brace_gap_stiffness_known(&rest->stiffness, &pose, open, k);
    if (status == BRACE_OK) {
        k->now.flags |= assumed;
        k->engaged.flags |= assumed;
    }
    return status;
}

/* Sum of the weights times their places along one axis. root, knee, tip: places of the femur's ends and of the tip. */
static float weigh(const brace_gravity_t *weights, float root_mm, float knee_mm, float tip_mm)
{
    return weights->femur_n * 0.5f * (root_mm + knee_mm) + weights->knee_n * knee_mm +
           weights->tibia_n * 0.5f * (knee_mm + tip_mm);
}

/* What the motor of the coxa joint holds against force and weights. */
static float coxa_load_of(const brace_limb_t *limb, const brace_pose_t *pose, const brace_gravity_t *weights,
                          const brace_space_load_t *load, const brace_space_result_t *rest)
{
    const float knee_mm = limb->coxa_mm + pose->knee.x_mm, tip_mm = limb->coxa_mm + pose->tip.x_mm;
    const float across_mm = rest->displacement_mm.y, knee_across_mm = across_mm - rest->tibia_mm.y;
    const float weighs_n_mm = load->down.y * weigh(weights, limb->coxa_mm, knee_mm, tip_mm) -
                              load->down.x * weigh(weights, 0.0f, knee_across_mm, across_mm);
    return across_mm * load->tip_n.x - tip_mm * load->tip_n.y - weighs_n_mm;
}

brace_status_t brace_loaded_space_play(const brace_limb_t *limb, const brace_gravity_t *weights,
                                       const float theta_rad[3], const brace_space_load_t *load,
                                       const brace_space_result_t *rest, const brace_play_joint_t joint[3],
                                       const brace_backlash_t *const machine[3], brace_engagement_t engaged[3],
                                       brace_stiffness_spatial_t *k)
{
    const brace_load_t in_plane = {.tip = {load->tip_n.x, load->tip_n.z}, .down = {load->down.x, load->down.z}};
    const brace_vec_t moved_mm = {rest->displacement_mm.x, rest->displacement_mm.z};
    const brace_vec_t tibia_mm = {rest->tibia_mm.x, rest->tibia_mm.z};
    brace_stiffness_t plane;
    brace_gap_stiffness_t gaps;
    brace_pose_t pose;
    float load_n_mm[BRACE_LINK_COUNT];
    uint32_t open = 0, flags = 0;
    bent_pose(limb, theta_rad[BRACE_FEMUR], theta_rad[BRACE_TIBIA], moved_mm, tibia_mm, &pose);
    load_n_mm[BRACE_COXA] = coxa_load_of(limb, &pose, weights, load, rest);
    loads_of(&pose, weights, &in_plane, &load_n_mm[BRACE_FEMUR]);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        engaged[i] = engagement_of(limb, i, &pose, &joint[i], machine[i], load_n_mm[i]);
        open |= engaged[i].is_engaged ? 0u : 1u << i;
        flags |= engaged[i].is_assumed ? (uint32_t)BRACE_FLAG_PLAY_ASSUMED : 0u;
    }
    brace_status_t status = brace_loaded_space_in_plane(&rest->k, &plane);
    if (status == BRACE_OK) {
        status = brace_gap_stiffness_known(&plane, &pose, open & (BRACE_GAP_FEMUR | BRACE_GAP_TIBIA), &gaps);
    }
    if (status == BRACE_OK) {
        const bool coxa_is_open = (open & 1u << BRACE_COXA) != 0u;
        flags |= coxa_is_open ? (uint32_t)BRACE_FLAG_GAP_OPEN : 0u;
        status = open == 0u ? brace_loaded_space_turn(theta_rad[BRACE_COXA], &rest->k, k)
                            : brace_spatial_turn(theta_rad[BRACE_COXA], &gaps.now,
                                                 coxa_is_open ? 0.0f : rest->k.yy_n_per_mm, k);
    }
    if (status == BRACE_OK) {
        k->flags |= flags | rest->flags;
    }
    return status;
}
