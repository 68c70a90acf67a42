#include "stiffness/model.h"

#include <string.h>

#define LEAST_FACTOR 1e-3f        /* no temperature makes a spring push the wrong way */
#define WARMER_MOST_DEGC 200.0f
#define NEWTON_STEPS 2
#define DEFLECTION_MOST_RAD 8.0f  /* no spring is wound further than a joint turns */
#define LOAD_MOST_N_MM 1e9f
#define STEPS_TO_REST_MOST 8u /* ticks that go on towards a rest before the search begins anew */

void model_configure_loaded(model_t *model, const brace_limb_t *limb, const brace_gravity_t *weights, bool is_spatial)
{
    model->is_spatial = is_spatial;
    if (is_spatial) {
        brace_loaded_space_collapse(limb, weights, &model->loaded_space);
        return;
    }
#ifdef __SOFTFP__
    brace_loaded_t loaded;
    brace_loaded_collapse(limb, weights, &loaded);
    brace_loaded_fixed_collapse(&loaded, &model->loaded);
#else
    brace_loaded_collapse(limb, weights, &model->loaded);
#endif
}

/* K where the tick's step leads. */
static brace_status_t plane_follow(const model_loaded_limb_t *limb, const float unbent_rad[BRACE_LINK_COUNT],
                                   const brace_load_t *load, bool is_bent, model_plane_place_t *place,
                                   brace_loaded_stiffness_t *found)
{
    const float theta1_rad = unbent_rad[BRACE_FEMUR], theta2_rad = unbent_rad[BRACE_TIBIA];
#ifdef __SOFTFP__
    return brace_loaded_fixed_follow(limb, theta1_rad, theta2_rad, load, is_bent, place, found);
#else
    return brace_loaded_follow(limb, theta1_rad, theta2_rad, load, is_bent, place, found);
#endif
}

static brace_status_t plane_settle(const model_loaded_limb_t *limb, const float unbent_rad[BRACE_LINK_COUNT],
                                   const brace_load_t *load, model_plane_work_t *work)
{
    const float theta1_rad = unbent_rad[BRACE_FEMUR], theta2_rad = unbent_rad[BRACE_TIBIA];
#ifdef __SOFTFP__
    return brace_loaded_fixed_stiffness(limb, theta1_rad, theta2_rad, load, work);
#else
    return brace_loaded_settle(limb, theta1_rad, theta2_rad, load, work);
#endif
}

static brace_status_t plane_stiffness(const model_loaded_limb_t *limb, const model_plane_work_t *work,
                                      brace_loaded_stiffness_t *result)
{
#ifdef __SOFTFP__
    (void)limb;
    *result = *work;
    return BRACE_OK;
#else
    return brace_loaded_stiffness_at(limb, work, result);
#endif
}

static bool springs_change(const brace_parameters_t *parameters)
{
    bool change = parameters->slow.joint_compliance_per_degc != 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        change = change || parameters->drive[i].hardening_n_mm_per_rad3 != 0.0f;
    }
    return change;
}

void model_configure(model_t *model, const brace_parameters_t *parameters, bool is_spatial, model_part_t part)
{
    const brace_limb_t *limb = &parameters->limb;
    switch (part) {
    case MODEL_LOADED:
        *model = (model_t){.springs_change = springs_change(parameters)};
        model_configure_loaded(model, limb, &parameters->gravity, is_spatial);
        break;
    case MODEL_PLANAR:
        model->is_collapsed =
            !is_spatial && !model->springs_change && brace_planar_collapse(limb, &model->planar) == BRACE_OK;
        break;
    default:
        if (is_spatial) {
            (void)brace_spatial_collapse(limb, &model->spatial);
        } else {
            brace_general_collapse(limb, &model->general);
        }
        break;
    }
}

static float spring_at_rest(const brace_parameters_t *parameters, int index, float temp_degc)
{
    const float warmer_degc = temp_degc - parameters->slow.reference_degc;
    const bool measured = __builtin_fabsf(warmer_degc) <= WARMER_MOST_DEGC;
    const float factor = measured ? 1.0f + parameters->slow.joint_compliance_per_degc * warmer_degc : 1.0f;
    return parameters->limb.joint[index].compliance_rad_per_n_mm * (factor > LEAST_FACTOR ? factor : LEAST_FACTOR);
}

static brace_loaded_joint_t linear(float compliance_rad_per_n_mm)
{
    return (brace_loaded_joint_t){compliance_rad_per_n_mm, compliance_rad_per_n_mm};
}

/* A spring of torque = deflection / compliance + hardening * deflection^3 at a load. A load changes little in a tick,
 * so the deflection is followed with two of Newton's steps from the last one. After a jump of the load the deflection
 * is right within a few ticks. */
static brace_loaded_joint_t hardened_spring(float *deflection_rad, float hardening_n_mm_per_rad3, float load_n_mm,
                                            float compliance_rad_per_n_mm)
{
    const bool hardens = hardening_n_mm_per_rad3 > 0.0f && compliance_rad_per_n_mm > 0.0f;
    if (!hardens || !(__builtin_fabsf(load_n_mm) <= LOAD_MOST_N_MM)) {
        return linear(compliance_rad_per_n_mm);
    }
    const float linear_n_mm_per_rad = 1.0f / compliance_rad_per_n_mm;
    float deflection = *deflection_rad;
    for (int i = 0; i < NEWTON_STEPS; i++) {
        const float cubic_n_mm_per_rad = hardening_n_mm_per_rad3 * deflection * deflection;
        deflection =
            (load_n_mm + 2.0f * cubic_n_mm_per_rad * deflection) / (linear_n_mm_per_rad + 3.0f * cubic_n_mm_per_rad);
    }
    /* From within this bound Newton's steps stay finite, whatever the spring. */
    if (!(__builtin_fabsf(deflection) <= DEFLECTION_MOST_RAD)) {
        deflection = load_n_mm < 0.0f ? -DEFLECTION_MOST_RAD : DEFLECTION_MOST_RAD;
    }
    *deflection_rad = deflection;
    const float cubic_n_mm_per_rad = hardening_n_mm_per_rad3 * deflection * deflection;
    return (brace_loaded_joint_t){1.0f / (linear_n_mm_per_rad + cubic_n_mm_per_rad),
                                  1.0f / (linear_n_mm_per_rad + 3.0f * cubic_n_mm_per_rad)};
}

void model_springs_at_rest(const brace_parameters_t *parameters, const float temp_degc[BRACE_LINK_COUNT],
                           brace_loaded_joint_t springs[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        springs[i] = linear(spring_at_rest(parameters, i, temp_degc[i]));
    }
}

brace_loaded_joint_t model_spring(const model_t *model, const brace_parameters_t *parameters, int index,
                                  float load_n_mm, float temp_degc, float *deflection_rad)
{
    return model->springs_change ? hardened_spring(deflection_rad, parameters->drive[index].hardening_n_mm_per_rad3,
                                                   load_n_mm, spring_at_rest(parameters, index, temp_degc))
                                 : linear(parameters->limb.joint[index].compliance_rad_per_n_mm);
}

void model_springs(model_t *model, const brace_parameters_t *parameters, const float load_n_mm[BRACE_LINK_COUNT],
                   const float temp_degc[BRACE_LINK_COUNT], brace_loaded_joint_t springs[BRACE_LINK_COUNT])
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        springs[i] = model_spring(model, parameters, i, load_n_mm[i], temp_degc[i], &model->deflection_rad[i]);
    }
}

brace_status_t model_stiffness(model_t *model, const brace_limb_t *limb, float theta1_rad, float theta2_rad,
                               const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_stiffness_t *stiffness,
                               float *across_n_per_mm)
{
    const float hip_rad_per_n_mm = springs[BRACE_FEMUR].slope_rad_per_n_mm + limb->base.rotation_rad_per_n_mm;
    const float knee_rad_per_n_mm = springs[BRACE_TIBIA].slope_rad_per_n_mm;
    if (model->is_spatial) {
        brace_spatial_set_springs(&model->spatial, springs[BRACE_COXA].slope_rad_per_n_mm, hip_rad_per_n_mm,
                                  knee_rad_per_n_mm);
        return brace_spatial_in_plane(&model->spatial, theta1_rad, theta2_rad, stiffness, across_n_per_mm);
    }
    const brace_status_t status = model->is_collapsed
                                      ? brace_planar_stiffness(&model->planar, theta1_rad, theta2_rad, stiffness)
                                      : brace_general_stiffness(&model->general, theta1_rad, theta2_rad,
                                                                hip_rad_per_n_mm, knee_rad_per_n_mm, stiffness);
    if (status == BRACE_OK) {
        *across_n_per_mm = __builtin_nanf("");
    }
    return status;
}

static float square(float a)
{
    return a * a;
}

static brace_load_t plane_load(const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n,
                               brace_vec3_t down)
{
    return (brace_load_t){
        .tip = {tip_n.x, tip_n.z}, .down = {down.x, down.z}, .hip = springs[BRACE_FEMUR], .knee = springs[BRACE_TIBIA]};
}

static brace_space_load_t space_load(const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n,
                                     brace_vec3_t down)
{
    return (brace_space_load_t){.tip_n = tip_n,
                                .down = down,
                                .yaw = springs[BRACE_COXA],
                                .hip = springs[BRACE_FEMUR],
                                .knee = springs[BRACE_TIBIA]};
}

/* Joint and base's rotation turn together, each by its share of what yields. theta2 is flexion: it turns clockwise. */
static void report_plane(const brace_limb_t *limb, float hip_yields_rad_per_n_mm, const brace_loaded_stiffness_t *found,
                         model_rest_t *rest)
{
    const float joint = hip_yields_rad_per_n_mm, both = joint + limb->base.rotation_rad_per_n_mm;
    const brace_vec_t moved = {found->displacement.x_mm, found->displacement.z_mm};
    rest->plane = found->stiffness;
    rest->plane.flags |=
        brace_loaded_flags(found->buckling_factor, square(moved.x) + square(moved.z), limb->femur_mm + limb->tibia_mm);
    rest->bend = (posture_bend_t){
        .tip_mm = moved,
        .tibia_mm = found->tibia_mm,
        .tip_across_mm = 0.0f,
        .tibia_across_mm = 0.0f,
        .joint_turn_rad = {0.0f, both > 0.0f ? joint / both * found->hip_turn_rad : 0.0f, -found->knee_turn_rad}};
    rest->moved_across_mm = __builtin_nanf("");
    rest->buckling_factor = found->buckling_factor;
}

static brace_status_t report_space(const brace_limb_t *limb, const brace_space_result_t *found, model_rest_t *rest)
{
    const brace_status_t status = brace_loaded_space_in_plane(&found->k, &rest->plane);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_vec3_t moved = found->displacement_mm;
    rest->plane.flags |=
        found->flags | brace_loaded_flags(__builtin_nanf(""), square(moved.x) + square(moved.y) + square(moved.z),
                                          limb->femur_mm + limb->tibia_mm);
    rest->space = found->k;
    rest->bend = (posture_bend_t){.tip_mm = {moved.x, moved.z},
                                  .tibia_mm = {found->tibia_mm.x, found->tibia_mm.z},
                                  .tip_across_mm = moved.y,
                                  .tibia_across_mm = found->tibia_mm.y,
                                  .joint_turn_rad = {found->yaw_turn_rad, found->hip_turn_rad, -found->knee_turn_rad}};
    rest->moved_across_mm = moved.y;
    rest->buckling_factor = __builtin_nanf("");
    return BRACE_OK;
}

/* Joints that do not yield, in bits: a joint whose angle is measured behind its spring has nowhere to be turned to. */
static uint8_t unyielding(const brace_loaded_joint_t springs[BRACE_LINK_COUNT])
{
    uint32_t joints = 0u;
    for (uint32_t i = 0; i < BRACE_LINK_COUNT; i++) {
        uint32_t bits;
        memcpy(&bits, &springs[i].yields_by_rad_per_n_mm, sizeof bits); /* cheaper than to compare floats in software */
        joints |= bits == 0u ? 1u << i : 0u;
    }
    return (uint8_t)joints;
}

/* Where several ticks have found no rest, the next one begins anew. */
static void note_search(model_place_t *place, bool has_found)
{
    place->ticks_without = has_found ? 0u : (uint8_t)(place->ticks_without % STEPS_TO_REST_MOST + 1u);
    place->is_there = place->ticks_without < STEPS_TO_REST_MOST;
}

brace_status_t model_loaded(const model_t *model, const brace_limb_t *limb, const float unbent_rad[BRACE_LINK_COUNT],
                            const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n, brace_vec3_t down,
                            model_place_t *place, model_rest_t *rest)
{
    brace_status_t status;
    if (!model->is_spatial) {
        const uint8_t before = place->unyielding;
        place->unyielding = unyielding(springs);
        const bool goes_on = place->is_there && place->unyielding == before;
        const brace_load_t load = plane_load(springs, tip_n, down);
        brace_loaded_stiffness_t found;
        status = plane_follow(&model->loaded, unbent_rad, &load, goes_on, &place->at.plane, &found);
        if (status == BRACE_OK) {
            report_plane(limb, load.hip.yields_by_rad_per_n_mm, &found, rest);
        }
        note_search(place, status == BRACE_OK);
        return status;
    }
    const brace_space_load_t load = space_load(springs, tip_n, down);
    brace_space_result_t found;
    status = brace_loaded_space_follow(&model->loaded_space, unbent_rad[BRACE_FEMUR], unbent_rad[BRACE_TIBIA], &load,
                                       place->is_there, &place->at.space);
    if (status == BRACE_OK) {
        status = brace_loaded_space_stiffness(&model->loaded_space, &place->at.space, &found);
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        place->springs[i] = springs[i];
    }
    note_search(place, status == BRACE_OK);
    return status == BRACE_OK ? report_space(limb, &found, rest) : status;
}

/* --- in steps ---------------------------------------------------------------------------------------------------- */

int32_t model_loaded_begin(const model_t *model, const float unbent_rad[BRACE_LINK_COUNT],
                           const brace_loaded_joint_t springs[BRACE_LINK_COUNT], brace_vec3_t tip_n, brace_vec3_t down,
                           model_work_t *work)
{
    brace_status_t status;
    work->hip_yields_rad_per_n_mm = springs[BRACE_FEMUR].yields_by_rad_per_n_mm;
    if (model->is_spatial) {
        const brace_space_load_t load = space_load(springs, tip_n, down);
        status = brace_loaded_space_begin(&model->loaded_space, unbent_rad[BRACE_FEMUR], unbent_rad[BRACE_TIBIA], &load,
                                          &work->of.space);
    } else {
        const brace_load_t load = plane_load(springs, tip_n, down);
        status = plane_settle(&model->loaded, unbent_rad, &load, &work->of.plane);
    }
    work->is_under_way = status == BRACE_OK;
    return work->is_under_way ? (int32_t)MODEL_LATER : status;
}

static int32_t go_on_in_space(const model_t *model, const brace_limb_t *limb, model_work_t *work, model_rest_t *rest)
{
    brace_space_result_t found;
    brace_status_t status;
    if (!brace_loaded_space_step(&model->loaded_space, &work->of.space, &found, &status)) {
        return MODEL_LATER;
    }
    work->is_under_way = false;
    return status == BRACE_OK ? report_space(limb, &found, rest) : status;
}

int32_t model_loaded_go_on(const model_t *model, const brace_limb_t *limb, model_work_t *work, model_rest_t *rest)
{
    if (model->is_spatial) {
        return go_on_in_space(model, limb, work, rest);
    }
    brace_loaded_stiffness_t found;
    const brace_status_t status = plane_stiffness(&model->loaded, &work->of.plane, &found);
    if (status == BRACE_OK) {
        report_plane(limb, work->hip_yields_rad_per_n_mm, &found, rest);
    }
    work->is_under_way = false;
    return status;
}
