/* Joints, their commands, and the tip's sensor: does a fresh, finite, possible value come within a window of time? */
#include <math.h>

#include "selftest.h"

enum { WINDOW_US = 50000, AGE_MAX_US = 10000, JOINT_COUNT = 3 };
static const float angle_max_rad = 7.9f;   /* as the parameters allow */
static const float torque_max_n_mm = 1e6f;
static const float sentinel = 12345.0f;

typedef struct {
    uint32_t fresh, again, aged;
    int32_t answer; /* the last answer that was neither OK nor AGAIN */
    bool finite, possible, changed, time_changed;
    brace_hal_joint_t first;
} seen_t;

static const char *const names[JOINT_COUNT] = {"joint_read(0)", "joint_read(1)", "joint_read(2)"};

/* The angle by the encoder that there is: a joint may have one behind its gear alone. */
static float angle_rad(const brace_hal_joint_t *joint)
{
    return isnan(joint->motor_rad) ? joint->link_rad : joint->motor_rad;
}

static void look(const selftest_t *test, seen_t *seen, const brace_hal_joint_t *joint)
{
    const uint32_t age_us = test->hal->now_us(test->hal->context) - joint->taken_us;
    if (seen->fresh == 0u) {
        seen->first = *joint;
    }
    seen->fresh++;
    seen->finite = seen->finite && isfinite(angle_rad(joint)) && isfinite(joint->torque_n_mm) &&
                   !isinf(joint->link_rad) && !isinf(joint->temp_degc);
    seen->possible = seen->possible && !(fabsf(joint->motor_rad) > angle_max_rad) &&
                     !(fabsf(joint->torque_n_mm) > torque_max_n_mm) && !(fabsf(joint->link_rad) > angle_max_rad);
    seen->aged += age_us > AGE_MAX_US;
    seen->changed = seen->changed || angle_rad(joint) != angle_rad(&seen->first);
    seen->time_changed = seen->time_changed || joint->taken_us != seen->first.taken_us;
}

static seen_t watch(selftest_t *test, int32_t index)
{
    const brace_hal_t *const hal = test->hal;
    seen_t seen = {.answer = BRACE_HAL_OK, .finite = true, .possible = true};
    selftest_wait_t wait = selftest_wait(test, WINDOW_US);
    do { /* at most QUESTIONS_MAX */
        brace_hal_joint_t joint = {0};
        const int32_t answer = hal->joint_read(hal->context, index, &joint);
        if (answer == BRACE_HAL_OK) {
            look(test, &seen, &joint);
        } else if (answer == BRACE_HAL_AGAIN) {
            seen.again++;
        } else {
            seen.answer = answer;
        }
    } while (seen.answer == BRACE_HAL_OK && selftest_waiting(test, &wait));
    return seen;
}

static void judge_samples(selftest_t *test, const char *name, const seen_t *seen)
{
    if (!selftest_expect(test, seen->finite, name, "finite",
                         "an angle, torque or temperature is not finite: "
                         "NaN is for one of the two encoders and for temp_degc only")) {
        return;
    }
    selftest_expect(
        test, seen->possible, name, "within what a joint can be",
        "out of range: rad and N mm on the joint's side of the reduction are wanted; degrees, turns or counts?");
    if (test->clock_runs) {
        /* Compares most samples, not one: a host may stop the test between a sample and the check of its age. */
        selftest_expect(test, seen->aged <= seen->fresh / 2u, name, "samples are fresh",
                        "taken_us lies ahead of now_us or more than 10 ms back: it is to be by now_us, when sampled");
        selftest_expect(test, seen->time_changed || seen->fresh < 2u, name, "samples follow each other",
                        "the same sample is called new again and again: AGAIN is the answer for it");
    }
    if (!seen->changed) {
        selftest_report(test, test->setup->joints_are_moved ? BRACE_SELFTEST_FAIL : BRACE_SELFTEST_NOTE, name,
                        test->setup->joints_are_moved
                            ? "the encoder is stuck: the joint was moved and the angle was not"
                            : "the angle did not change by a step: move the joint to see that it does");
    }
}

static void one_joint(selftest_t *test, int32_t index)
{
    const char *const name = names[index];
    const seen_t seen = watch(test, index);
    if (seen.answer == BRACE_HAL_E_UNSUPPORTED) {
        selftest_report(test, index == 0 ? BRACE_SELFTEST_NOTE : BRACE_SELFTEST_FAIL, name,
                        index == 0 ? "no such joint: a limb in a plane"
                                   : "no such joint: without femur and tibia there is no K");
    } else if (seen.answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, name, "the device refuses: encoder powered, wired, addressed?",
                              seen.answer, "answer");
    } else if (seen.fresh == 0u) {
        selftest_report(test, BRACE_SELFTEST_FAIL, name,
                        "AGAIN for ever: no new sample in 50 ms; does the sampling interrupt or DMA run?");
    } else {
        selftest_report_value(test, BRACE_SELFTEST_PASS, name, "new samples", (int32_t)seen.fresh, "in 50 ms");
        judge_samples(test, name, &seen);
    }
}

static void refusals(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    static const struct {
        int32_t index;
        const char *passed, *failed;
    } none[] = {
        {-1, "a joint before the first is refused", "joint -1 is answered or written to: check the index first"},
        {JOINT_COUNT, "a joint after the last is refused", "joint 3 is answered or written to: check the index first"},
    };
    for (uint32_t i = 0u; i < sizeof none / sizeof none[0]; i++) {
        brace_hal_joint_t joint = {.motor_rad = sentinel};
        const int32_t answer = hal->joint_read(hal->context, none[i].index, &joint);
        selftest_expect(test, answer < BRACE_HAL_AGAIN && joint.motor_rad == sentinel, "joint_read", none[i].passed,
                        none[i].failed);
    }
}

/* Every call of joint_command is a command: also one for no offset moves a joint that had another, and a port that
 * does not check the index may command another joint. So it is called only where the limb hangs free. */
static void commands(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    const brace_hal_joint_command_t nothing = {0.0f, INFINITY}; /* no offset and no limit */
    if (hal->joint_command == 0) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "joint_command", "not there: the firmware can not move this limb");
        return;
    }
    if (!test->setup->limb_is_free) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "joint_command", "not tried: the limb was not said to hang free");
        return;
    }
    selftest_expect(test, hal->joint_command(hal->context, 1, &nothing) == BRACE_HAL_OK, "joint_command",
                    "no offset is accepted",
                    "joint 1 refuses an offset of 0; null is right when the limb can not be moved");
    selftest_expect(test, hal->joint_command(hal->context, JOINT_COUNT, &nothing) < 0, "joint_command",
                    "a joint that can not be is refused", "joint 3 is accepted: check the index first");
}

/* What the board's own file allows: numbers in an order in which they can hold. */
static void ceilings(selftest_t *test)
{
    const brace_hal_ceiling_t *const ceiling = test->hal->ceiling;
    if (ceiling == 0) {
        return;
    }
    bool is_right = true;
    for (int32_t index = 0; index < JOINT_COUNT; index++) {
        const brace_hal_ceiling_t *const one = &ceiling[index];
        is_right = is_right && one->torque_most_n_mm > 0.0f && one->speed_most_rad_per_s > 0.0f &&
                   one->angle_least_rad < one->angle_most_rad;
    }
    selftest_expect(test, is_right, "ceiling", "torque, travel and speed are possible",
                    "a torque or speed is not above 0, or a travel ends before it begins");
}

static void tip_force(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    if (hal->tip_force_read == 0) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "tip_force_read", "not there: no force sensor");
        return;
    }
    float x_n = 0.0f, z_n = 0.0f;
    int32_t answer;
    selftest_wait_t wait = selftest_wait(test, WINDOW_US);
    do { /* at most QUESTIONS_MAX */
        answer = hal->tip_force_read(hal->context, &x_n, &z_n);
    } while (answer == BRACE_HAL_AGAIN && selftest_waiting(test, &wait));
    if (answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "tip_force_read",
                              "no sample in 50 ms; null is right when there is no sensor", answer, "answer");
        return;
    }
    selftest_expect(test, isfinite(x_n) && isfinite(z_n), "tip_force_read", "finite", "a force is not finite");
}

void selftest_joints(selftest_t *test)
{
    for (int32_t index = 0; index < JOINT_COUNT; index++) {
        one_joint(test, index);
    }
    refusals(test);
    commands(test);
    ceilings(test);
    tip_force(test);
}
