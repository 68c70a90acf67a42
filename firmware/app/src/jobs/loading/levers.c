#include "jobs/loading/levers.h"

#include "stiffness/stiffness.h"

#define LEAST_KNEE_SINE 0.05f
#define ASIDE_RAD 0.01f /* the error of a central difference, a sixth of the square, is below 2e-5 of it */

enum { LISTENED = 50 }; /* ticks whose mean is the load */
/* The rest is worked out at the posture first, then to both sides of it. Where a link's angle is measured, it is worked
 * out at the posture twice: first with the motor at the link's angle, then with the motor where that rest puts it. */
enum { AT_POSTURE = 2, PLACES = 6 };

static void take_straight_levers(brace_loading_t *test, const brace_pose_t *pose)
{
    test->lever_femur = pose->lever_femur;
    /* theta2 is flexion: a positive turn of the knee turns the tibia clockwise. */
    test->lever_knee = (brace_point_t){-pose->lever_tibia.x_mm, -pose->lever_tibia.z_mm};
}

void levers_begin(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const posture_t *posture = inputs->posture;
    take_straight_levers(test, &posture->unbent);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        test->lever_rad[i] = posture->unbent_rad[i];
    }
    inputs->work->is_under_way = false;
}

bool levers_listen(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const brace_snapshot_load_t *load = &inputs->now->load;
    const float share = 1.0f / (float)LISTENED;
    if (!load->is_counted || test->lever_step >= LISTENED) {
        return false;
    }
    test->lever_force_n.x += share * load->force_x_n;
    test->lever_force_n.y += share * load->force_y_n;
    test->lever_force_n.z += share * load->force_z_n;
    test->lever_step++;
    return true;
}

/* Takes the straight links' levers anew, once the motors' angles are known. */
static void see_straight(brace_loading_t *test, const brace_limb_t *limb)
{
    brace_pose_t pose;
    brace_kinematics_pose(limb, test->lever_rad[BRACE_FEMUR], test->lever_rad[BRACE_TIBIA], &pose);
    take_straight_levers(test, &pose);
}

static int32_t rest_at(const brace_loading_t *test, const loading_inputs_t *inputs, uint32_t place, model_rest_t *rest)
{
    if (inputs->work->is_under_way) {
        return model_loaded_go_on(inputs->model, &inputs->parameters->limb, inputs->work, rest);
    }
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    float theta_rad[BRACE_LINK_COUNT] = {test->lever_rad[0], test->lever_rad[1], test->lever_rad[2]};
    if (place >= AT_POSTURE) {
        const uint32_t side = place - AT_POSTURE;
        theta_rad[side < 2u ? BRACE_FEMUR : BRACE_TIBIA] += side % 2u == 0u ? ASIDE_RAD : -ASIDE_RAD;
    }
    stiffness_springs_of_now(inputs->model, inputs->parameters, inputs->joints, inputs->flank, springs);
    return model_loaded_begin(inputs->model, theta_rad, springs, test->lever_force_n, inputs->down, inputs->work);
}

/* Where an encoder behind the gear measures the angle, the motor stands where the load has not turned the joint.
 * returns whether there is such an encoder */
static bool go_to_motors(brace_loading_t *test, const posture_t *posture, const float joint_turn_rad[BRACE_LINK_COUNT])
{
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA; i++) {
        test->behind_rad[i] = posture->is_measured[i] ? joint_turn_rad[i] : 0.0f;
        test->lever_rad[i] = posture->unbent_rad[i] - test->behind_rad[i];
    }
    return posture->is_measured[BRACE_FEMUR] || posture->is_measured[BRACE_TIBIA];
}

static void add_difference(brace_point_t *lever, brace_displacement_t ahead, brace_displacement_t behind)
{
    lever->x_mm += (ahead.x_mm - behind.x_mm) / (2.0f * ASIDE_RAD);
    lever->z_mm += (ahead.z_mm - behind.z_mm) / (2.0f * ASIDE_RAD);
}

bool levers_work(brace_loading_t *test, const loading_inputs_t *inputs)
{
    const uint32_t place = test->lever_step - LISTENED;
    model_rest_t rest;
    if (!inputs->now->load.is_counted || test->lever_step < LISTENED) { /* the load has been lost on the way */
        return true;
    }
    if (place == AT_POSTURE && !inputs->work->is_under_way) {
        see_straight(test, &inputs->parameters->limb);
    }
    const int32_t status = rest_at(test, inputs, place, &rest);
    if (status != BRACE_OK) {
        return status != MODEL_LATER;
    }
    if (place < AT_POSTURE) {
        const bool again = go_to_motors(test, inputs->posture, rest.bend.joint_turn_rad);
        test->lever_step = (uint8_t)(LISTENED + (again ? place + 1u : AT_POSTURE));
        return false;
    }
    test->lever_moved_mm[place - AT_POSTURE] = (brace_displacement_t){rest.bend.tip_mm.x, rest.bend.tip_mm.z};
    test->lever_step++;
    if (place + 1u < PLACES) {
        return false;
    }
    add_difference(&test->lever_femur, test->lever_moved_mm[0], test->lever_moved_mm[1]);
    add_difference(&test->lever_knee, test->lever_moved_mm[2], test->lever_moved_mm[3]);
    return true;
}

bool levers_offsets_per_mm(const brace_loading_t *test, const brace_limb_t *limb, brace_axis_t axis, float per_mm[2])
{
    const brace_point_t femur = test->lever_femur, knee = test->lever_knee;
    const float determinant_mm2 = femur.x_mm * knee.z_mm - femur.z_mm * knee.x_mm;
    if (__builtin_fabsf(determinant_mm2) < LEAST_KNEE_SINE * limb->femur_mm * limb->tibia_mm) {
        return false;
    }
    per_mm[0] = (axis == BRACE_AXIS_X ? knee.z_mm : -knee.x_mm) / determinant_mm2;
    per_mm[1] = (axis == BRACE_AXIS_X ? -femur.z_mm : femur.x_mm) / determinant_mm2;
    return true;
}
