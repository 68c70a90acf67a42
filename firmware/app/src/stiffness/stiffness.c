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
    const brace_stiffness_spatial_t none = {
        unknown, unknown, unknown, unknown, unknown, unknown, {unknown, unknown, unknown}, {unknown, unknown, unknown},
        flags};
    space->is_valid = false;
    space->across_n_per_mm = space->engaged_across_n_per_mm = unknown;
    space->now = space->engaged = none;
}

static void no_load(brace_snapshot_load_t *load)
{
    const float unknown = __builtin_nanf("");
    *load = (brace_snapshot_load_t){.force_x_n = unknown,
                                    .force_y_n = unknown,
                                    .force_z_n = unknown,
                                    .moved_x_mm = unknown,
                                    .moved_y_mm = unknown,
                                    .moved_z_mm = unknown,
                                    .buckling_factor = unknown,
                                    .unloaded = no_k(0),
                                    .unloaded_across_n_per_mm = unknown};
}

void stiffness_unknown_sigma(brace_snapshot_t *snapshot)
{
    const float unknown = __builtin_nanf("");
    snapshot->sigma_is_known = false;
    snapshot->sigma_age_us = 0;
    snapshot->sigma = (brace_stiffness_sigma_t){unknown, unknown, unknown, unknown, unknown, unknown, 0u};
    snapshot->sigma_space = (brace_space_sigma_t){
        unknown, unknown, unknown, unknown, unknown, unknown, {unknown, unknown, unknown}, unknown};
}

void stiffness_unknown(brace_snapshot_t *snapshot, uint32_t flags)
{
    snapshot->k_is_valid = false;
    stiffness_unknown_sigma(snapshot);
    no_load(&snapshot->load);
    no_plane_k(&snapshot->stiffness, flags);
    no_space_k(&snapshot->space, flags);
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

/* K with every gap closed: in the plane, across it, and as a whole where a load couples both. */
typedef struct {
    brace_stiffness_t plane;
    float across_n_per_mm;
    brace_k3_t space;
    bool is_coupled; /* space is there */
} engaged_t;

/* K at the equilibrium under the tip's force and the weight; the posture goes there.
 * flags: SOFTENED where there is no such equilibrium
 * returns as model_loaded */
static brace_status_t take_loaded(model_t *model, const brace_limb_t *limb, const brace_loaded_joint_t *springs,
                                  brace_vec3_t down, softening_t *softening, posture_t *posture,
                                  brace_snapshot_t *snapshot, engaged_t *engaged, uint32_t *flags)
{
    brace_snapshot_load_t *load = &snapshot->load;
    model_rest_t rest;
    const brace_vec3_t tip_n = {snapshot->force_x_n, snapshot->force_y_n, snapshot->force_z_n};
    const brace_status_t status =
        model_loaded(model, limb, posture->unbent_rad, springs, tip_n, down, &softening->now, &rest);
    if (status != BRACE_OK) {
        *flags |= status == BRACE_E_SINGULAR ? (uint32_t)BRACE_FLAG_SOFTENED : 0u;
        return status;
    }
    posture_settle(posture, &rest.bend);
    engaged->plane = rest.plane;
    load->is_counted = true;
    load->force_x_n = tip_n.x;
    load->force_y_n = tip_n.y;
    load->force_z_n = tip_n.z;
    load->moved_x_mm = rest.bend.tip_mm.x;
    load->moved_y_mm = rest.moved_across_mm;
    load->moved_z_mm = rest.bend.tip_mm.z;
    load->buckling_factor = rest.buckling_factor;
    if (model->is_spatial) {
        engaged->space = rest.space;
        engaged->across_n_per_mm = rest.space.yy_n_per_mm;
        engaged->is_coupled = true;
        load->buckling_factor = softening->factor;
        *flags |= softening_flags(softening);
    }
    return BRACE_OK;
}

/* Is the load known on every side? */
static bool load_is_known(const model_t *model, const brace_snapshot_t *snapshot)
{
    const bool is_known_across = !model->is_spatial || snapshot->force_y_n == snapshot->force_y_n;
    return snapshot->force_x_n == snapshot->force_x_n && snapshot->force_z_n == snapshot->force_z_n && is_known_across;
}

/* K in the limb's plane, and across it, with every gap closed, under the load where it can be counted.
 * flags: why not, or as take_loaded */
static brace_status_t take_engaged(model_t *model, const brace_limb_t *limb, const brace_loaded_joint_t *springs,
                                   const gravity_t *gravity, softening_t *softening, posture_t *posture,
                                   brace_snapshot_t *snapshot, engaged_t *engaged, uint32_t *flags)
{
    brace_snapshot_load_t *load = &snapshot->load;
    const bool is_counted = load_is_known(model, snapshot);
    engaged->is_coupled = false;
    if (is_counted && model->is_spatial) {
        load->unloaded = softening->unloaded;
        load->unloaded_across_n_per_mm = softening->unloaded_across_n_per_mm;
        return take_loaded(model, limb, springs, gravity->down, softening, posture, snapshot, engaged, flags);
    }
    const brace_status_t status =
        model_stiffness(model, limb, posture->unbent_rad[BRACE_FEMUR], posture->unbent_rad[BRACE_TIBIA], springs,
                        &engaged->plane, &engaged->across_n_per_mm);
    if (status != BRACE_OK) {
        return status;
    }
    if (!is_counted) {
        no_load(load);
        *flags |= BRACE_FLAG_LOAD_UNKNOWN;
    }
    load->unloaded = engaged->plane;
    load->unloaded_across_n_per_mm = engaged->across_n_per_mm;
    return is_counted ? take_loaded(model, limb, springs, gravity->down, softening, posture, snapshot, engaged, flags)
                      : BRACE_OK;
}

/* K in space of now, where a gap may be open: an open gap of the coxa joint carries nothing across the plane.
 * returns as brace_loaded_space_turn and brace_spatial_turn */
static brace_status_t turn(float theta0_rad, const engaged_t *engaged, const brace_gap_stiffness_t *plane,
                           float across_now_n_per_mm, bool is_open, brace_space_stiffness_t *space)
{
    brace_status_t status = engaged->is_coupled ? brace_loaded_space_turn(theta0_rad, &engaged->space, &space->engaged)
                                                : brace_spatial_turn(theta0_rad, &engaged->plane,
                                                                     engaged->across_n_per_mm, &space->engaged);
    if (status != BRACE_OK) {
        return status;
    }
    space->engaged.flags |= plane->engaged.flags;
    space->now = space->engaged;
    return is_open ? brace_spatial_turn(theta0_rad, &plane->now, across_now_n_per_mm, &space->now) : BRACE_OK;
}

/* open, assumed: joints, as flank_open_gaps and flank_assumed return them */
static void take_space(const engaged_t *engaged, const brace_gap_stiffness_t *plane, float theta0_rad,
                       bool coxa_is_sound, uint32_t open, uint32_t assumed, brace_space_stiffness_t *space)
{
    const bool coxa_is_open = (open & 1u << BRACE_COXA) != 0u;
    const float across_now_n_per_mm = coxa_is_open ? 0.0f : engaged->across_n_per_mm;
    if (!coxa_is_sound) {
        no_space_k(space, plane->now.flags | (uint32_t)BRACE_FLAG_STALE);
        return;
    }
    if (turn(theta0_rad, engaged, plane, across_now_n_per_mm, open != 0u, space) != BRACE_OK) {
        no_space_k(space, plane->now.flags | (uint32_t)BRACE_FLAG_NEAR_SINGULAR);
        return;
    }
    space->is_valid = true;
    space->across_n_per_mm = across_now_n_per_mm;
    space->engaged_across_n_per_mm = engaged->across_n_per_mm;
    space->now.flags |= coxa_is_open ? (uint32_t)BRACE_FLAG_GAP_OPEN : 0u;
    space->now.flags |= (assumed & 1u << BRACE_COXA) != 0u ? (uint32_t)BRACE_FLAG_PLAY_ASSUMED : 0u;
}

/* Do the encoders of the plane's joints agree, and is the temperature known where their springs follow it? */
static bool springs_are_known(const brace_parameters_t *parameters, const joints_t *joints)
{
    float temp_degc[BRACE_LINK_COUNT];
    joints_temperatures(joints, temp_degc);
    const bool is_measured =
        temp_degc[BRACE_FEMUR] == temp_degc[BRACE_FEMUR] && temp_degc[BRACE_TIBIA] == temp_degc[BRACE_TIBIA];
    return !joints->joint[BRACE_FEMUR].contradicts && !joints->joint[BRACE_TIBIA].contradicts &&
           (is_measured || parameters->slow.joint_compliance_per_degc == 0.0f);
}

void stiffness_take(model_t *model, const brace_parameters_t *parameters, bool is_calibrated, const joints_t *joints,
                    const flank_t *flank, const gravity_t *gravity, softening_t *softening, posture_t *posture,
                    brace_snapshot_t *snapshot)
{
    const uint32_t plane_joints = 1u << BRACE_FEMUR | 1u << BRACE_TIBIA;
    const uint32_t open = flank_open_gaps(flank);
    const bool sound = joints_plane_is_sound(joints), inside = posture->is_inside_travel;
    uint32_t flags = (is_calibrated ? 0u : (uint32_t)BRACE_FLAG_UNCALIBRATED) |
                     (sound && !joints_plane_may_have_moved(joints) ? 0u : (uint32_t)BRACE_FLAG_STALE) |
                     ((flank_assumed(flank) & plane_joints) != 0u ? (uint32_t)BRACE_FLAG_PLAY_ASSUMED : 0u) |
                     (inside && springs_are_known(parameters, joints) ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE);
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    engaged_t engaged;

    stiffness_springs_of_now(model, parameters, joints, flank, springs);
    stiffness_hold_measured_joints(posture, springs);
    posture_settle(posture, NULL);
    const bool is_seen = sound && inside && posture->has_levers;
    /* A limb that is not seen may rest elsewhere when it is seen again. */
    softening->now.is_there = softening->now.is_there && is_seen;
    const bool computed = is_seen &&
                          take_engaged(model, &parameters->limb, springs, gravity, softening, posture, snapshot,
                                       &engaged, &flags) == BRACE_OK &&
                          brace_gap_stiffness_known(&engaged.plane, &posture->pose, open & plane_joints,
                                                    &snapshot->stiffness) == BRACE_OK;
    snapshot->space.is_fitted = model->is_spatial;
    if (!computed) { /* with sound samples inside the travel, only a singular posture has no K, or one that folds */
        stiffness_unknown(snapshot, flags | (sound && inside ? (uint32_t)BRACE_FLAG_NEAR_SINGULAR : 0u));
        return;
    }
    snapshot->stiffness.now.flags |= flags;
    snapshot->stiffness.engaged.flags |= flags;
    snapshot->k_is_valid = true;
    if (model->is_spatial) {
        take_space(&engaged, &snapshot->stiffness, posture->unbent_rad[BRACE_COXA], joints->joint[BRACE_COXA].sound,
                   open, flank_assumed(flank), &snapshot->space);
    } else if (snapshot->space.now.flags != 0u) { /* Else this snapshot has none since it was started. */
        no_space_k(&snapshot->space, 0);
    }
}
