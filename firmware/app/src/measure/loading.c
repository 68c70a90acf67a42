#include "measure/loading.h"

#include "measure/loading_read.h"
#include "motion/joints.h"

#define LEAST_KNEE_SINE 0.05f
#define TRAVEL_SPARE_RAD 0.01f
#define TORQUE_SHARE 0.95f       /* of the bound: a drive that limits its torque never passes it */
#define CORRECTION_US 50000.0f
#define CORRECTION_MOST_RAD 0.3f
#define CRAWL_RAD_PER_S 0.005f   /* at least: what is nearly there would take seconds to wind up against friction */
#define SETTLE_US 3000000u       /* for the servos, at most; then the step is read where it is */
#define THERE_SHARE 0.01f        /* of a step, of the joint that goes further */
#define NEAR_THERE 3.0f
#define RESTING_US 20000u        /* there, and not on its way through */
#define TRIM_RATE_RAD_PER_S 0.1f /* back to none */
#define SAME_POSTURE_RAD 0.01f
#define TIME_SPARE_US 2000000u

static bool inside(float value, float low, float high)
{
    return value >= low && value <= high;
}

/* Far out a float's last place is coarser than a tick's way at a slow rate: the shape would stand there for ever. */
static bool moves_everywhere(const brace_loading_setup_t *setup, uint32_t tick_us)
{
    const float furthest_mm = (float)setup->steps_per_side * setup->step_mm;
    return setup->rate_mm_per_s * 1e-6f * (float)tick_us >= BRACE_LOADING_LEAST_WAY * furthest_mm;
}

static bool setup_is_sound(const brace_loading_setup_t *setup)
{
    return (setup->axis == BRACE_AXIS_X || setup->axis == BRACE_AXIS_Z) && setup->steps_per_side >= 2u &&
           setup->steps_per_side <= 60u && inside(setup->step_mm, 0.001f, 50.0f) && setup->dwell_us >= 20000u &&
           setup->dwell_us <= 10000000u && inside(setup->rate_mm_per_s, 1e-3f, 1000.0f) &&
           inside(setup->force_max_n, 1e-6f, 1e6f) && inside(setup->torque_max_n_mm, 1e-6f, 1e6f) &&
           (setup->source == BRACE_LOADING_ENCODED || setup->source == BRACE_LOADING_COMMANDED);
}

/* Joint offsets that move the tip's free shape by 1 mm along the axis, and the levers they are worked out
 * from. */
static bool levers_allow(brace_app_t *app, brace_axis_t axis, float per_mm[2])
{
    const brace_point_t femur = app->pose.lever_femur, tibia = app->pose.lever_tibia;
    const float determinant = femur.z_mm * tibia.x_mm - femur.x_mm * tibia.z_mm;
    if (__builtin_fabsf(determinant) <
        LEAST_KNEE_SINE * app->parameters.limb.femur_mm * app->parameters.limb.tibia_mm) {
        return false;
    }
    per_mm[0] = (axis == BRACE_AXIS_X ? -tibia.z_mm : tibia.x_mm) / determinant;
    per_mm[1] = (axis == BRACE_AXIS_X ? -femur.z_mm : femur.x_mm) / determinant;
    return true;
}

/* The run's place among the runs so far. */
static void count_run(brace_loading_t *test, brace_axis_t axis, const float theta_rad[BRACE_LINK_COUNT])
{
    const bool elsewhere =
        test->run_count == 0 ||
        __builtin_fabsf(theta_rad[BRACE_FEMUR] - test->config_theta_rad[0]) > SAME_POSTURE_RAD ||
        __builtin_fabsf(theta_rad[BRACE_TIBIA] - test->config_theta_rad[1]) > SAME_POSTURE_RAD;
    test->run_count++;
    if (elsewhere) {
        test->config_count++;
        test->rep_count[0] = test->rep_count[1] = 0;
        test->config_theta_rad[0] = theta_rad[BRACE_FEMUR];
        test->config_theta_rad[1] = theta_rad[BRACE_TIBIA];
    }
    test->result.run = test->run_count;
    test->result.config = test->config_count;
    test->result.rep = test->rep_count[axis]++;
}

static uint32_t step_count(const brace_loading_t *test)
{
    return 4u * test->result.setup.steps_per_side + 1u;
}

brace_status_t loading_start(brace_app_t *app, const brace_loading_setup_t *setup)
{
    brace_loading_t *test = &app->loading;
    const brace_snapshot_t *now = brace_app_snapshot(app);
    float per_mm[2];
    if (!setup_is_sound(setup) || !moves_everywhere(setup, app->tick_us)) {
        return BRACE_E_RANGE;
    }
    if (!now->k_is_valid || !levers_allow(app, setup->axis, per_mm)) {
        return BRACE_E_SINGULAR;
    }
    test->result = (brace_loading_result_t){.outcome = BRACE_LOADING_RUNNING, .setup = *setup};
    count_run(test, setup->axis, now->theta_rad);
    test->model = now->stiffness.engaged;
    const float furthest_rad = setup->step_mm * (__builtin_fabsf(per_mm[0]) > __builtin_fabsf(per_mm[1])
                                                     ? __builtin_fabsf(per_mm[0])
                                                     : __builtin_fabsf(per_mm[1]));
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const brace_drive_t *drive = &app->parameters.drive[BRACE_FEMUR + i];
        const bool held = now->play[BRACE_FEMUR + i].phase == BRACE_TAKEUP_HOLD;
        float most_n_mm = setup->torque_max_n_mm < drive->torque_range_n_mm ? setup->torque_max_n_mm
                                                                            : drive->torque_range_n_mm;
        if (held && app->play[i].backlash.params.takeup.torque_max_n_mm < most_n_mm) {
            most_n_mm = app->play[i].backlash.params.takeup.torque_max_n_mm;
        }
        test->per_mm[i] = per_mm[i];
        test->held[i] = held;
        test->torque_max_n_mm[i] = most_n_mm;
        test->give_rad_per_mm[i] = test->trim_rad[i] = 0.0f;
        /* within it nothing is corrected: an encoder knows no finer, and a servo that sticks would go to and fro */
        test->there_rad[i] = THERE_SHARE * furthest_rad + drive->angle_step_rad;
        test->start_motor_rad[i] = app->joint[i].sample.motor_rad;
    }
    test->along_mm = 0.0f;
    test->step = 0;
    test->test_us = 0;
    const float step_us = 2.0f * ((float)setup->dwell_us + 1e6f * setup->step_mm / setup->rate_mm_per_s);
    const float whole_us = (float)step_count(test) * (step_us + (float)SETTLE_US);
    test->limit_us = (whole_us < 3.0e9f ? (uint32_t)whole_us : 3000000000u) + TIME_SPARE_US;
    test->phase = LOADING_MOVE;
    (void)brace_drift_run(&app->drift);
    return BRACE_OK;
}

void loading_end(brace_app_t *app, brace_loading_outcome_t outcome)
{
    brace_loading_t *test = &app->loading;
    if (test->phase != LOADING_IDLE) {
        if (test->result.outcome == BRACE_LOADING_RUNNING) {
            test->result.outcome = outcome;
        }
        test->phase = LOADING_RETURN;
    }
}

/* The pass 0 -> +n -> 0 -> -n -> 0, in steps. */
static int32_t place_of(uint32_t step, uint32_t per_side)
{
    const int32_t at = (int32_t)step, n = (int32_t)per_side;
    return at <= n ? at : at <= 3 * n ? 2 * n - at : at - 4 * n;
}

static float nearer(float value, float target, float step)
{
    return value < target - step ? value + step : value > target + step ? value - step : target;
}

float loading_offset(const brace_loading_t *test, int index)
{
    return (test->per_mm[index] + test->give_rad_per_mm[index]) * test->along_mm + test->trim_rad[index];
}

/* Bounds that end a test. */
static brace_loading_outcome_t broken_bound(const brace_app_t *app, const brace_snapshot_t *snapshot)
{
    const brace_loading_t *test = &app->loading;
    const float most_n = test->result.setup.force_max_n;
    if (!(__builtin_fabsf(snapshot->force_x_n) <= 1e7f && __builtin_fabsf(snapshot->force_z_n) <= 1e7f)) {
        return BRACE_LOADING_E_NO_FORCE;
    }
    if (test->result.rows > 0 && (__builtin_fabsf(snapshot->force_x_n - test->result.preload_x_n) > most_n ||
                                  __builtin_fabsf(snapshot->force_z_n - test->result.preload_z_n) > most_n)) {
        return BRACE_LOADING_E_FORCE;
    }
    const int i = app->joint_of_tick; /* one joint a tick: the drives hold the torque's bound by themselves */
    const float moved_rad = app->joint[i].sample.motor_rad - test->start_motor_rad[i];
    if (test->held[i] && snapshot->play[BRACE_FEMUR + i].phase != BRACE_TAKEUP_HOLD) {
        return BRACE_LOADING_E_LOST;
    }
    if (__builtin_fabsf(app->joint[i].torque_n_mm) > TORQUE_SHARE * test->torque_max_n_mm[i]) {
        return BRACE_LOADING_E_TORQUE;
    }
    if (__builtin_fabsf(moved_rad) > 2.0f * __builtin_fabsf(loading_offset(test, i)) + TRAVEL_SPARE_RAD) {
        return BRACE_LOADING_E_TRAVEL;
    }
    if ((snapshot->stiffness.engaged.flags & BRACE_FLAG_OUT_OF_RANGE) != 0u) {
        return BRACE_LOADING_E_TRAVEL;
    }
    return test->test_us > test->limit_us ? BRACE_LOADING_E_TIME : BRACE_LOADING_RUNNING;
}

static float limited(float value, float most)
{
    return value > most ? most : value < -most ? -most : value;
}

/* Raises the offsets by what the servos give way by under load, so that the motors stand where the step wants them. A
 * linear limb wants the same per millimetre at each step, so what one step has learned serves the next. Where the free
 * shape is at its rest there is no such thing: what friction holds back there is trimmed. returns whether the motors
 * are there */
static bool correct(brace_app_t *app)
{
    brace_loading_t *test = &app->loading;
    if (test->result.setup.source != BRACE_LOADING_ENCODED) {
        return true;
    }
    const float gain = (float)app->tick_us / CORRECTION_US, along_mm = test->along_mm;
    const float crawl_rad = CRAWL_RAD_PER_S * 1e-6f * (float)app->tick_us;
    bool there = true;
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        const float moved_rad = app->joint[i].sample.motor_rad - test->start_motor_rad[i];
        const float off_rad = test->per_mm[i] * along_mm - moved_rad;
        const float near_rad = test->rests[i] ? NEAR_THERE * test->there_rad[i] : test->there_rad[i];
        test->rests[i] = __builtin_fabsf(off_rad) <= near_rad;
        if (test->rests[i]) {
            continue;
        }
        there = false;
        const float more_rad = gain * off_rad + (off_rad > 0.0f ? crawl_rad : -crawl_rad);
        if (along_mm == 0.0f) {
            test->trim_rad[i] = limited(test->trim_rad[i] + more_rad, CORRECTION_MOST_RAD);
        } else {
            test->give_rad_per_mm[i] = limited(test->give_rad_per_mm[i] + more_rad / along_mm,
                                               CORRECTION_MOST_RAD / __builtin_fabsf(along_mm));
        }
    }
    return there;
}

static void move(brace_app_t *app, float step_mm)
{
    brace_loading_t *test = &app->loading;
    const brace_loading_setup_t *setup = &test->result.setup;
    /* the free shape goes the other way: the tip stays, and is displaced against it */
    const float target_mm = -setup->step_mm * (float)place_of(test->step, setup->steps_per_side);
    if (test->along_mm != target_mm) {
        test->along_mm = nearer(test->along_mm, target_mm, step_mm);
        test->rests[0] = test->rests[1] = false;
        test->resting_us = 0;
        test->phase_us = 0;
        return;
    }
    test->phase_us += app->tick_us;
    test->resting_us = correct(app) ? test->resting_us + app->tick_us : 0u;
    if (test->resting_us >= RESTING_US || test->phase_us >= SETTLE_US) {
        test->phase = LOADING_DWELL;
        test->phase_us = 0;
        loading_read_begin(test);
    }
}

static void dwell(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    brace_loading_t *test = &app->loading;
    test->phase_us += app->tick_us;
    if (2u * test->phase_us <= test->result.setup.dwell_us) {
        (void)correct(app);
    } else {
        loading_read_sample(app, snapshot);
    }
    if (test->phase_us >= test->result.setup.dwell_us) {
        test->phase = LOADING_READ;
    }
}

static void go_back(brace_app_t *app, float step_mm)
{
    brace_loading_t *test = &app->loading;
    bool back = true;
    test->along_mm = nearer(test->along_mm, 0.0f, step_mm);
    for (int i = 0; i < BRACE_APP_JOINTS; i++) {
        test->trim_rad[i] = nearer(test->trim_rad[i], 0.0f, TRIM_RATE_RAD_PER_S * 1e-6f * (float)app->tick_us);
        back = back && test->trim_rad[i] == 0.0f;
    }
    test->phase = back && test->along_mm == 0.0f ? (uint8_t)LOADING_IDLE : (uint8_t)LOADING_RETURN;
}

void loading_advance(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    brace_loading_t *test = &app->loading;
    const float step_mm = test->result.setup.rate_mm_per_s * 1e-6f * (float)app->tick_us;
    test->test_us += app->tick_us;
    if (test->phase == LOADING_MOVE || test->phase == LOADING_DWELL) {
        const brace_loading_outcome_t broken = broken_bound(app, snapshot);
        if (broken != BRACE_LOADING_RUNNING) {
            loading_end(app, broken);
        } else if (test->phase == LOADING_MOVE) {
            move(app, step_mm);
        } else {
            dwell(app, snapshot);
        }
    } else if (test->phase == LOADING_RETURN) {
        go_back(app, step_mm);
    }
}

static void next_step(brace_app_t *app)
{
    brace_loading_t *test = &app->loading;
    test->step++;
    test->phase = test->step < step_count(test) ? LOADING_MOVE : LOADING_JUDGE;
}

void loading_piece(brace_app_t *app)
{
    brace_loading_t *test = &app->loading;
    test->test_us += app->tick_us;
    if (test->phase == LOADING_READ) {
        if (loading_read(app)) {
            test->phase = LOADING_DRIFT;
        } else {
            loading_end(app, BRACE_LOADING_E_NO_FORCE);
        }
    } else if (test->phase == LOADING_DRIFT) {
        loading_drift(app);
        next_step(app);
    } else if (test->phase == LOADING_JUDGE) {
        if (loading_judge(app)) {
            test->phase = LOADING_COMPARE;
        } else {
            loading_end(app, BRACE_LOADING_E_FLAT);
        }
    } else if (test->phase == LOADING_COMPARE) {
        loading_compare(app);
        test->phase = LOADING_TELL;
    } else if (test->phase == LOADING_TELL) {
        loading_tell(app);
        loading_end(app, BRACE_LOADING_DONE);
    }
}
