#include "sigma.h"

#include "stiffness/stiffness.h"
#include "tip_load.h"

#define LEAST_LOAD_RATIO 0.05f /* of the torque range */

/* Bits of what kind of K it is, above those of the open gaps. */
enum { LOAD_IS_COUNTED = 1 << BRACE_LINK_COUNT, FORCE_IS_SENSED = 2 << BRACE_LINK_COUNT };

static uint32_t kind_of(const controller_t *controller, const brace_snapshot_t *snapshot)
{
    return flank_open_gaps(&controller->flank) | (snapshot->load.is_counted ? (uint32_t)LOAD_IS_COUNTED : 0u) |
           (snapshot->force_is_sensed ? (uint32_t)FORCE_IS_SENSED : 0u);
}

/* How far a joint's load may be from the load that K counts [N mm], with a sign. The mean lags behind; friction in
 * motor, gear and joint carries a part of the load, which grows with it; and the torque by current is known to a share
 * of itself. The first two are bounds, all are independent. NaN: not known */
static float load_off_n_mm(const controller_t *controller, int index)
{
    const brace_drive_t *drive = &controller->parameters.in_force.drive[index];
    const float lag_n_mm = flank_lag_n_mm(&controller->flank, &controller->joints, index);
    const float load_n_mm = __builtin_fabsf(controller->flank.joint[index].out.load_n_mm);
    const float share = drive->motor_friction_per_torque_ratio + drive->motor_friction_per_load_ratio;
    const float friction_n_mm =
        (drive->motor_friction_n_mm + share * load_n_mm) * (1.0f + drive->motor_friction_tolerance_ratio) +
        drive->coulomb_n_mm + drive->coulomb_per_load_ratio * load_n_mm;
    const float gain_n_mm = drive->torque_gain_rel * load_n_mm;
    return __builtin_copysignf(
        __builtin_sqrtf(lag_n_mm * lag_n_mm + friction_n_mm * friction_n_mm + gain_n_mm * gain_n_mm), lag_n_mm);
}

/* Does a joint's load change K? Where a sensor at the tip measures the force, only the coxa joint still tells a part of
 * it; but every joint's load hardens its spring. */
static bool load_counts(const controller_t *controller, const brace_snapshot_t *now, int index)
{
    return now->load.is_counted && controller->joints.joint[index].sound &&
           (index == BRACE_COXA || !now->force_is_sensed || controller->model.springs_change);
}

/* K's inputs if one joint's load were larger, and smaller: by as much as it may be off now, or as it may soon be. The
 * deflection that the model keeps between ticks is left unchanged. */
static void take_other_load(const controller_t *controller, int index, const sigma_inputs_t *inputs,
                            sigma_load_t *other)
{
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    const model_t *model = &controller->model;
    const brace_vec3_t tip_n = inputs->k.tip_n;
    const float off_n_mm = __builtin_fabsf(load_off_n_mm(controller, index));
    const float least_n_mm = LEAST_LOAD_RATIO * parameters->drive[index].torque_range_n_mm;
    float load_n_mm[BRACE_LINK_COUNT];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        load_n_mm[i] = inputs->load_n_mm[i];
    }
    const float told_n_mm = load_n_mm[index];
    const brace_vec3_t before = tip_load_n(controller, load_n_mm);
    other->by_n_mm = off_n_mm > least_n_mm ? off_n_mm : least_n_mm;
    for (int side = 0; side < SIGMA_SIDES; side++) {
        load_n_mm[index] = side == 0 ? told_n_mm + other->by_n_mm : told_n_mm - other->by_n_mm;
        const brace_vec3_t after = tip_load_n(controller, load_n_mm);
        other->tip_n[side] = (brace_vec3_t){tip_n.x + (after.x - before.x), tip_n.y + (after.y - before.y),
                                            tip_n.z + (after.z - before.z)};
        for (int i = 0; i < BRACE_LINK_COUNT; i++) {
            other->spring[side][i] = inputs->k.spring[i];
        }
        float deflection_rad = model->deflection_rad[index];
        other->spring[side][index] =
            model_spring(model, parameters, index, load_n_mm[index], inputs->temp_degc[index], &deflection_rad);
        stiffness_hold_measured_joints(&controller->posture, other->spring[side]);
    }
}

/* How exactly a joint's angle is known: where its flank is not known, it stands anywhere in its gap. */
static float angle_sigma_rad(const controller_t *controller, int index)
{
    const brace_limb_t *limb = &controller->parameters.in_force.limb;
    const bool is_open = (flank_open_gaps(&controller->flank) & 1u << index) != 0u;
    const float known_rad = limb->uncertainty.angle_rad,
                stands_rad = is_open ? 0.5f * limb->joint[index].gap_rad : 0.0f;
    return __builtin_sqrtf(known_rad * known_rad + stands_rad * stands_rad);
}

static void take_inputs(controller_t *controller, const brace_snapshot_t *now, sigma_inputs_t *inputs)
{
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    const posture_t *posture = &controller->posture;
    const bool is_counted = now->load.is_counted;
    const brace_vec3_t nothing = {0.0f, 0.0f, 0.0f};
    const brace_vec3_t tip_n = {now->load.force_x_n, now->load.force_y_n, now->load.force_z_n};
    brace_k_inputs_t *k = &inputs->k;
    inputs->is_spatial = controller->model.is_spatial;
    inputs->taken_us = controller->now_us;
    inputs->kind = kind_of(controller, now);
    inputs->down = is_counted ? controller->gravity.down : nothing;
    k->limb = parameters->limb;
    k->tip_n = is_counted ? tip_n : nothing;
    k->sensor_gain_rel = now->force_is_sensed ? parameters->limb.uncertainty.gain_rel : 0.0f;
    stiffness_springs_of_now(&controller->model, parameters, &controller->joints, &controller->flank, k->spring);
    stiffness_hold_measured_joints(posture, k->spring);
    joints_temperatures(&controller->joints, inputs->temp_degc);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        k->angle_rad[i] = posture->unbent_rad[i];
        k->angle_sigma_rad[i] = angle_sigma_rad(controller, i);
        inputs->load_n_mm[i] = controller->flank.joint[i].out.load_n_mm;
        inputs->load[i].counts = load_counts(controller, now, i);
    }
}

/* The loads are those of the inputs; only the levers may be those of a tick that comes soon after. */
static void take_other_loads(const controller_t *controller, sigma_inputs_t *inputs)
{
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        if (inputs->load[i].counts) {
            take_other_load(controller, i, inputs, &inputs->load[i]);
        }
    }
}

bool sigma_begin(controller_t *controller)
{
    const brace_snapshot_t *now = &controller->snapshot[controller->newest];
    sigma_job_t *job = &controller->sigma;
    const bool is_same_kind = job->has_inputs && kind_of(controller, now) == job->inputs.kind;
    job->has_inputs = false;
    if (!now->k_is_valid) {
        return false;
    }
    if (is_same_kind) {
        take_other_loads(controller, &job->inputs);
        sigma_job_begin(job);
    } else {
        take_inputs(controller, now, &job->inputs);
        sigma_job_take(job);
    }
    return true;
}

void sigma_report(const controller_t *controller, brace_snapshot_t *snapshot)
{
    if (joints_plane_may_have_moved(&controller->joints)) {
        stiffness_unknown_sigma(snapshot);
        return;
    }
    sigma_now_t now = {.unbent_rad = controller->posture.unbent_rad,
                       .kind = kind_of(controller, snapshot),
                       .now_us = controller->now_us};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        now.off_n_mm[i] = load_counts(controller, snapshot, i) ? load_off_n_mm(controller, i) : 0.0f;
    }
    sigma_job_tell(&controller->sigma, &now, snapshot);
}
