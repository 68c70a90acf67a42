#include "stiffness/stiffness.h"

static void no_plane_k(brace_gap_stiffness_t *stiffness, uint32_t flags)
{
    const float unknown = __builtin_nanf("");
    const brace_stiffness_t none = {unknown, unknown, unknown, unknown, unknown, unknown, flags};
    stiffness->now = stiffness->engaged = none;
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

void stiffness_unknown(brace_snapshot_t *snapshot, uint32_t flags)
{
    snapshot->k_is_valid = false;
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

void stiffness_take(model_t *model, const brace_parameters_t *parameters, brace_parameter_origin_t origin,
                    const joints_t *joints, const flank_t *flank, const posture_t *posture,
                    brace_snapshot_t *snapshot)
{
    const uint32_t plane_joints = 1u << BRACE_FEMUR | 1u << BRACE_TIBIA;
    const uint32_t open = flank_open_gaps(flank);
    const bool sound = joints_plane_is_sound(joints), inside = posture->is_inside_travel;
    float load_n_mm[BRACE_LINK_COUNT], temp_degc[BRACE_LINK_COUNT], springs_rad_per_n_mm[BRACE_LINK_COUNT];
    float across_n_per_mm;
    brace_stiffness_t engaged;

    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        load_n_mm[i] = flank->joint[i].out.load_n_mm;
    }
    joints_temperatures(joints, temp_degc);
    model_springs(model, parameters, load_n_mm, temp_degc, springs_rad_per_n_mm);

    const uint32_t flags = (origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u) |
                           (sound ? 0u : (uint32_t)BRACE_FLAG_STALE) |
                           (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE);
    const bool computed =
        sound && inside && posture->has_levers &&
        model_stiffness(model, parameters, posture->theta_rad[BRACE_FEMUR], posture->theta_rad[BRACE_TIBIA],
                        springs_rad_per_n_mm, &engaged, &across_n_per_mm) == BRACE_OK &&
        brace_gap_stiffness_known(&engaged, &posture->pose, open & plane_joints, &snapshot->stiffness) == BRACE_OK;
    snapshot->space.is_fitted = model->is_spatial;
    if (!computed) { /* with sound samples inside the travel, only a singular posture has no K */
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
