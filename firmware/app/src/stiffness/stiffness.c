#include "stiffness/stiffness.h"

#include <stddef.h>

/* brace_stiffness_t without a K. */
static brace_stiffness_t no_k(uint32_t flags)
{
    const float unknown = __builtin_nanf("");
    return (brace_stiffness_t){unknown, unknown, unknown, unknown, unknown, unknown, flags};
}

static void no_plane_k(brace_gap_stiffness_t *stiffness, uint32_t flags)
{
    stiffness->now = stiffness->engaged = no_k(flags);
}

static void no_space_k(brace_space_stiffness_t *space, uint32_t flags)
{
    const float unknown = __builtin_nanf("");
    const brace_stiffness_spatial_t none = {unknown, unknown, unknown, unknown, unknown, unknown,
                                            {unknown, unknown, unknown}, {unknown, unknown, unknown}, flags};
    space->is_valid = false;
    space->across_n_per_mm = space->engaged_across_n_per_mm = unknown;
    space->now = space->engaged = none;
}

static void no_load(brace_snapshot_load_t *load)
{
    const float unknown = __builtin_nanf("");
    *load = (brace_snapshot_load_t){.force_x_n = unknown,
                                    .force_z_n = unknown,
                                    .moved_x_mm = unknown,
                                    .moved_z_mm = unknown,
                                    .buckling_factor = unknown,
                                    .unloaded = no_k(0)};
}

void stiffness_unknown(brace_snapshot_t *snapshot, uint32_t flags)
{
    snapshot->k_is_valid = false;
    no_load(&snapshot->load);
    no_plane_k(&snapshot->stiffness, flags);
    no_space_k(&snapshot->space, flags);
}

/* K in space, from K in the plane and across it. An open gap of the coxa joint carries nothing across the plane. */
static void take_space(const brace_gap_stiffness_t *plane, float across_n_per_mm, float theta0_rad, bool coxa_is_sound,
                       bool coxa_is_open, brace_space_stiffness_t *space)
{
    const float across_now_n_per_mm = coxa_is_open ? 0.0f : across_n_per_mm;
    if (!coxa_is_sound) {
        no_space_k(space, plane->now.flags | (uint32_t)BRACE_FLAG_STALE);
        return;
    }
    const bool computed =
        brace_spatial_turn(theta0_rad, &plane->engaged, across_n_per_mm, &space->engaged) == BRACE_OK &&
        brace_spatial_turn(theta0_rad, &plane->now, across_now_n_per_mm, &space->now) == BRACE_OK;
    if (!computed) {
        no_space_k(space, plane->now.flags | (uint32_t)BRACE_FLAG_NEAR_SINGULAR);
        return;
    }
    space->is_valid = true;
    space->across_n_per_mm = across_now_n_per_mm;
    space->engaged_across_n_per_mm = across_n_per_mm;
    space->now.flags |= coxa_is_open ? (uint32_t)BRACE_FLAG_GAP_OPEN : 0u;
}

void stiffness_springs_of_now(model_t *model, const brace_parameters_t *parameters, const joints_t *joints,
                              const flank_t *flank, brace_loaded_joint_t springs[BRACE_LINK_COUNT])
{
    float load_n_mm[BRACE_LINK_COUNT], temp_degc[BRACE_LINK_COUNT];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        load_n_mm[i] = flank->joint[i].out.load_n_mm;
    }
    joints_temperatures(joints, temp_degc);
    model_springs(model, parameters, load_n_mm, temp_degc, springs);
}

void stiffness_hold_measured_joints(const posture_t *posture, brace_loaded_joint_t springs[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        springs[i].yields_by_rad_per_n_mm = posture->is_measured[i] ? 0.0f : springs[i].yields_by_rad_per_n_mm;
    }
}

/* K at the equilibrium under the tip's force and the weight; the posture goes there.
 * flags: SOFTENED where there is no such equilibrium
 * returns as model_loaded */
static brace_status_t take_loaded(const model_t *model, const brace_limb_t *limb, const brace_loaded_joint_t *springs,
                                  brace_vec_t down, posture_t *posture, brace_snapshot_t *snapshot,
                                  brace_stiffness_t *engaged, uint32_t *flags)
{
    brace_snapshot_load_t *load = &snapshot->load;
    brace_loaded_stiffness_t loaded;
    float joint_turn_rad[BRACE_LINK_COUNT];
    const brace_force_t tip = {snapshot->force_x_n, snapshot->force_z_n};
    const brace_status_t status =
        model_loaded(model, limb, posture->unbent_rad, springs, tip, down, &loaded, joint_turn_rad);
    if (status != BRACE_OK) {
        *flags |= status == BRACE_E_SINGULAR ? (uint32_t)BRACE_FLAG_SOFTENED : 0u;
        return status;
    }
    posture_settle(posture, &loaded, joint_turn_rad);
    *engaged = loaded.stiffness;
    load->is_counted = true;
    load->force_x_n = tip.x_n;
    load->force_z_n = tip.z_n;
    load->moved_x_mm = loaded.displacement.x_mm;
    load->moved_z_mm = loaded.displacement.z_mm;
    load->buckling_factor = loaded.buckling_factor;
    return BRACE_OK;
}

/* K in the limb's plane with every gap closed, under the load where it can be counted.
 * flags: why not, or as take_loaded */
static brace_status_t take_engaged(model_t *model, const brace_parameters_t *parameters,
                                   const brace_loaded_joint_t *springs, const gravity_t *gravity, posture_t *posture,
                                   brace_snapshot_t *snapshot, brace_stiffness_t *engaged, float *across_n_per_mm,
                                   uint32_t *flags)
{
    const bool force_is_known =
        snapshot->force_x_n == snapshot->force_x_n && snapshot->force_z_n == snapshot->force_z_n;
    const brace_status_t status =
        model_stiffness(model, parameters, posture->unbent_rad[BRACE_FEMUR], posture->unbent_rad[BRACE_TIBIA], springs,
                        engaged, across_n_per_mm);
    if (status != BRACE_OK) {
        return status;
    }
    snapshot->load.unloaded = *engaged;
    if (!model_counts_loads(model) || !force_is_known) {
        *flags |= BRACE_FLAG_LOAD_UNKNOWN;
        return BRACE_OK;
    }
    return take_loaded(model, &parameters->limb, springs, gravity->down, posture, snapshot, engaged, flags);
}

void stiffness_take(model_t *model, const brace_parameters_t *parameters, brace_parameter_origin_t origin,
                    const joints_t *joints, const flank_t *flank, const gravity_t *gravity, posture_t *posture,
                    brace_snapshot_t *snapshot)
{
    const uint32_t plane_joints = 1u << BRACE_FEMUR | 1u << BRACE_TIBIA;
    const uint32_t open = flank_open_gaps(flank);
    const bool sound = joints_plane_is_sound(joints), inside = posture->is_inside_travel;
    uint32_t flags = (origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u) |
                     (sound ? 0u : (uint32_t)BRACE_FLAG_STALE) |
                     (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE);
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    float across_n_per_mm;
    brace_stiffness_t engaged;

    stiffness_springs_of_now(model, parameters, joints, flank, springs);
    stiffness_hold_measured_joints(posture, springs);
    posture_settle(posture, NULL, NULL);
    no_load(&snapshot->load);
    const bool computed =
        sound && inside && posture->has_levers &&
        take_engaged(model, parameters, springs, gravity, posture, snapshot, &engaged, &across_n_per_mm, &flags) ==
            BRACE_OK &&
        brace_gap_stiffness_known(&engaged, &posture->pose, open & plane_joints, &snapshot->stiffness) == BRACE_OK;
    snapshot->space.is_fitted = model->is_spatial;
    if (!computed) { /* with sound samples inside the travel, only a singular posture has no K, or one that folds */
        stiffness_unknown(snapshot, flags | (sound && inside ? (uint32_t)BRACE_FLAG_NEAR_SINGULAR : 0u));
        return;
    }
    snapshot->stiffness.now.flags |= flags;
    snapshot->stiffness.engaged.flags |= flags;
    snapshot->k_is_valid = true;
    if (model->is_spatial) {
        take_space(&snapshot->stiffness, across_n_per_mm, posture->theta_rad[BRACE_COXA],
                   joints->joint[BRACE_COXA].sound, (open & 1u << BRACE_COXA) != 0u, &snapshot->space);
    } else {
        no_space_k(&snapshot->space, 0);
    }
}
