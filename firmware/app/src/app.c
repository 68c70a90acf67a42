#include "brace/app.h"

#include <stddef.h>

#include "brace/app_memory.h"
#include "sigma.h"
#include "stiffness/stiffness.h"
#include "tip_load.h"

/* Of the words that must not change, some 370, so many are looked over, and so many fewer beside a job's work: all of
 * them in less than 100 ms, however long the ticks are. */
#define GUARDED_WORDS_PER_MS 8u
#define GUARDED_WORDS_FEWER 3u
#define WIRE_WORK_MOST 3u /* a tick in which the wires have done more (wire/wire.h) has no room for a job's step */
#define WIRE_WORK_FULL \
    5u /* nor for a step that has waited for long; where commands flood in, each fifth tick is emptier */
#define STEPS_IN_A_QUIET_TICK 2u
#define UNWATCHED_MOST 17u /* ticks after one another in which a job works and the sensors' watch waits */
#define LISTENED_US 20000u /* a tick that comes later has not listened meanwhile, and has not moved the limb either */
#define OLDEST_US 0x40000000 /* 18 minutes: no sample counts as older, or the clock would go round and make it young */
#define LATE_PERIODS 3u /* a tick that comes more than three periods after the one before is more than two late */

/* -------------------------------------------------------------------------------------------- start -- */

static bool door_is_complete(const brace_hal_t *hal)
{
    return hal->now_us != NULL && hal->joint_read != NULL && hal->nvm_read != NULL && hal->nvm_write != NULL &&
           hal->nvm_erase != NULL && hal->watchdog_feed != NULL && hal->reset_cause != NULL && hal->crash_clear != NULL;
}

/* What must not change between one configuration and the next: the parameters, and all that is made from them. */
static guard_span_t guarded(const controller_t *controller, uint32_t index)
{
#define SPAN(from, end) \
    (guard_span_t) \
    { \
        &(from), (uint32_t)((const uint8_t *)&(end) - (const uint8_t *)&(from)) / 4u \
    }
#define WHOLE(member) \
    (guard_span_t) \
    { \
        &(member), sizeof(member) / 4u \
    }
    const model_t *model = &controller->model;
    switch (index) {
    case 0: return SPAN(controller->parameters.in_force, controller->parameters.store);
    case 1: return SPAN(*model, model->spatial.yaw_rad_per_n_mm); /* the springs behind change in each tick */
    case 2: return SPAN(model->loaded, model->deflection_rad);
    case 3: return SPAN(controller->tip_force.fitted, *(&controller->tip_force + 1));
    case GUARDED_GRAVITY: return WHOLE(controller->gravity);
    default: break;
    }
    const flank_joint_t *joint = &controller->flank.joint[index - GUARDED_JOINTS];
    return SPAN(*joint, joint->machine.started); /* what the machine is set up with; its state is behind it */
#undef SPAN
#undef WHOLE
}

static void take_guard(controller_t *controller)
{
    for (uint32_t i = 0; i < (uint32_t)GUARDED_SPANS; i++) {
        const guard_span_t span = guarded(controller, i);
        guard_take(&controller->guard, i, &span);
    }
    controller->memory_is_wrong = false;
}

enum { CONFIGURE_MODEL = BRACE_LINK_COUNT + 2 };

/* One step of putting parameters in force. What is worked out from the parameters is worked out anew, one part in each
 * step, because all parts together cost more than a tick may. returns whether that was the last part */
static bool configure_step(controller_t *controller)
{
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    const bool is_spatial = controller->joints.joint[BRACE_COXA].fitted;
    const uint32_t part = controller->configure_part++;
    switch (part) {
    case BRACE_COXA:
    case BRACE_FEMUR:
    case BRACE_TIBIA: flank_configure(&controller->flank, (int)part, &controller->joints, parameters); return false;
    case BRACE_LINK_COUNT:
        tip_force_configure(&controller->tip_force, controller->hal, &parameters->sensor);
        return false;
    case BRACE_LINK_COUNT + 1: gravity_configure(&controller->gravity, &parameters->gravity); return false;
    case CONFIGURE_MODEL:
        question_job_forget(&controller->question);
        sigma_job_forget(&controller->sigma);
        softening_start(&controller->softening);
        model_configure(&controller->model, parameters, is_spatial, MODEL_LOADED);
        return false;
    case CONFIGURE_MODEL + MODEL_PLANAR:
    case CONFIGURE_MODEL + MODEL_GENERAL:
        model_configure(&controller->model, parameters, is_spatial, (model_part_t)(part - CONFIGURE_MODEL));
        return false;
    case CONFIGURE_MODEL + MODEL_PARTS: take_guard(controller); return false;
    default:
        drift_job_configure(&controller->drift, parameter_job_is_fresh(&controller->parameters));
        controller->parameters.comes_in_force = false;
        return true;
    }
}

static drift_inputs_t drift_inputs(const controller_t *controller)
{
    const brace_mode_t mode = controller->mode.now;
    return (drift_inputs_t){.hal = controller->hal,
                            .parameters = &controller->parameters.in_force,
                            .parameter_crc = controller->parameters.crc,
                            .origin = controller->parameters.origin,
                            .may_write = (mode == BRACE_MODE_MONITOR || mode == BRACE_MODE_FAULT) &&
                                         !parameter_job_is_busy(&controller->parameters)};
}

static question_inputs_t question_inputs(controller_t *controller)
{
    return (question_inputs_t){.model = &controller->model,
                               .parameters = &controller->parameters.in_force,
                               .is_calibrated = parameter_job_is_calibrated(&controller->parameters),
                               .joints = &controller->joints,
                               .down = controller->gravity.down};
}

static void blank_snapshot(const controller_t *controller, brace_snapshot_t *snapshot)
{
    const float unknown = __builtin_nanf("");
    *snapshot = (brace_snapshot_t){.taken_us = controller->now_us,
                                   .parameter_crc = controller->parameters.crc,
                                   .parameter_origin = controller->parameters.origin,
                                   .faults = controller->faults.now,
                                   .tip_mm = {unknown, unknown},
                                   .play_shift_mm = {unknown, unknown},
                                   .force_x_n = unknown,
                                   .force_y_n = unknown,
                                   .force_z_n = unknown,
                                   .gravity_direction_rad = controller->gravity.direction_rad,
                                   .gravity_lean_rad = controller->gravity.lean_rad,
                                   .temp_degc = unknown};
    stiffness_unknown(snapshot, BRACE_FLAG_STALE);
    snapshot->force_x_interval_n = snapshot->force_y_interval_n = snapshot->force_z_interval_n =
        (brace_interval_t){unknown, unknown};
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        snapshot->load_interval_n_mm[i] = snapshot->force_x_interval_n;
        snapshot->theta_rad[i] = snapshot->motor_rad[i] = snapshot->torque_n_mm[i] = unknown;
    }
}

/* A board that keeps a key is guarded; all others are benches. */
static void start_ownership(controller_t *controller)
{
    const brace_hal_t *hal = controller->hal;
    uint8_t key[SIPHASH_KEY_BYTES];
    const bool has_key = hal->key_read != NULL && hal->random_read != NULL && hal->key_read(hal->context, key) > 0;
    uint32_t seed = 0;
    if (hal->random_read == NULL || hal->random_read(hal->context, &seed) != BRACE_HAL_OK) {
        seed = controller->now_us;
    }
    session_t *session = &controller->ownership.session;
    session_start(session, hal->key_read == NULL, has_key ? key : NULL, seed);
    session->life_us = hal->silence_us != 0u ? hal->silence_us : session->life_us;
}

_Static_assert(offsetof(brace_app_t, controller) == 0, "requests find their controller there");

brace_status_t brace_app_start(brace_app_t *app, const brace_hal_t *hal)
{
    if (app == NULL || hal == NULL) {
        return BRACE_E_NULL;
    }
    if (!door_is_complete(hal)) {
        return BRACE_E_PARAMETER;
    }
    *app = (brace_app_t){.controller = {.hal = hal}};
    controller_t *controller = &app->controller;
    controller->now_us = hal->now_us(hal->context);
    controller->has_crashed = hal->reset_cause(hal->context) == BRACE_RESET_FAULT;
    mode_start(&controller->mode);
    start_ownership(controller);
    drives_start(&controller->drives);
    frozen_start(&controller->frozen);
    joints_start(&controller->joints, hal);
    posture_start(&controller->posture);
    interval_start(&controller->interval);
    parameter_job_start(&controller->parameters, hal);
    for (bool done = false; !done;) { /* at most once for each part */
        done = configure_step(controller);
    }
    controller->drift.is_erased = false; /* what the journal knows of this set counts */
    const drift_inputs_t inputs = drift_inputs(controller);
    const uint32_t steps_most = 2u + (uint32_t)BRACE_JOURNAL_SCANS; /* learn the limb, open the journal, search it */
    for (uint32_t i = 0; i < steps_most && drift_job_is_starting(&controller->drift); i++) {
        (void)drift_job_work(&controller->drift, &inputs);
    }
    controller->faults.now = controller->parameters.faults;
    blank_snapshot(controller, &controller->snapshot[0]);
    blank_snapshot(controller, &controller->snapshot[1]);
    wires_start(&app->wires, hal, &controller->parameters.in_force);
    return BRACE_OK;
}

/* --------------------------------------------------------------------------------------------- tick -- */

/* Is this tick more than two periods late? Every late tick is counted. Only in CONFIGURATION a late tick is no fault,
 * because storing a set may stop the processor. */
static bool tick_is_late(controller_t *controller, uint32_t now_us)
{
    const uint32_t tick_us = controller->parameters.in_force.controller.tick_us;
    controller->since_us = controller->has_ticked ? now_us - controller->now_us : 0u;
    const bool late = controller->since_us > LATE_PERIODS * tick_us;
    if (late) {
        brace_count(&controller->counters.ticks_late);
    }
    controller->now_us = now_us;
    controller->has_ticked = true;
    return late && controller->mode.now != BRACE_MODE_CONFIGURATION;
}

/* Is what moves the limb still somebody's? Else it stands, whatever it was about to do. */
static void step_ownership(brace_app_t *app)
{
    controller_t *controller = &app->controller;
    ownership_t *ownership = &controller->ownership;
    const brace_hal_t *hal = controller->hal;
    const bool tests = loading_runs(&controller->loading), takes_up = controller_takes_up(controller);
    parameter_job_age(&controller->parameters, controller->since_us);
    if (!tests && !takes_up && ownership_is_idle(ownership)) {
        return;
    }
    const ownership_inputs_t inputs = {
        .runs = tests || takes_up,
        .moves = tests || (takes_up && !takeup_holds(&controller->takeup, &controller->flank)),
        .configures = controller->mode.now == BRACE_MODE_CONFIGURATION,
        .stores = parameter_job_is_busy(&controller->parameters),
        .since_us = controller->since_us < LISTENED_US ? controller->since_us : LISTENED_US,
        .let_go_after_us = 1000u * controller->parameters.in_force.controller.let_go_after_ms};
    uint32_t low, high;
    if (ownership->session.setting == BRACE_SETTING_GUARDED && !ownership->session.has_challenge &&
        hal->random_read(hal->context, &low) == BRACE_HAL_OK && hal->random_read(hal->context, &high) == BRACE_HAL_OK) {
        session_challenge(&ownership->session, (uint64_t)high << 32 | low);
    }
    switch (ownership_step(ownership, &inputs)) {
    case OWNERSHIP_STOPS: loading_end(&controller->loading, BRACE_LOADING_STOPPED); break;
    case OWNERSHIP_BEGINS: controller_begin(controller); break;
    case OWNERSHIP_LETS_GO: (void)brace_app_let_go(app); break;
    default: break;
    }
}

/* When the samples were taken. What was old in the tick before stays old until there is a sound sample again. */
static uint32_t taken_us(const controller_t *controller)
{
    const uint32_t now_us = controller->now_us, oldest_us = joints_taken_us(&controller->joints);
    const uint32_t before_us = controller->snapshot[controller->newest].taken_us;
    const bool was_old = (int32_t)(now_us - before_us) >= OLDEST_US && !controller->joints.joint[BRACE_FEMUR].sound;
    return was_old || (int32_t)(now_us - oldest_us) > OLDEST_US ? now_us - (uint32_t)OLDEST_US : oldest_us;
}

/* Angles as the joints tell them, and levers as far as the load is known from the tick before. */
static void take_posture(controller_t *controller, brace_snapshot_t *snapshot)
{
    float offset_rad[BRACE_LINK_COUNT], link_rad[BRACE_LINK_COUNT];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        const joint_t *joint = &controller->joints.joint[i];
        snapshot->play[i] = controller->flank.joint[i].out;
        snapshot->motor_rad[i] = joint->is_link_only ? __builtin_nanf("") : joint->sample.motor_rad;
        snapshot->torque_n_mm[i] = joint->sample.torque_n_mm;
        offset_rad[i] = snapshot->play[i].offset_rad;
    }
    joints_link_angles(&controller->joints, link_rad);
    posture_take(&controller->posture, &controller->parameters.in_force, snapshot->motor_rad, offset_rad, link_rad);
}

/* The load that K counts. */
static void take_force(const controller_t *controller, brace_snapshot_t *snapshot)
{
    const float load_n_mm[BRACE_LINK_COUNT] = {snapshot->play[BRACE_COXA].load_n_mm,
                                               snapshot->play[BRACE_FEMUR].load_n_mm,
                                               snapshot->play[BRACE_TIBIA].load_n_mm};
    const brace_vec3_t tip_n = tip_load_n(controller, load_n_mm);
    snapshot->force_is_sensed = tip_load_is_sensed(controller);
    snapshot->force_x_n = tip_n.x;
    snapshot->force_y_n = tip_n.y;
    snapshot->force_z_n = tip_n.z;
}

/* Where that load lies with 90 %: another part of it in every tick. */
static void take_interval(controller_t *controller, brace_snapshot_t *snapshot)
{
    interval_t *interval = &controller->interval;
    const interval_inputs_t inputs = {.joints = &controller->joints,
                                      .flank = &controller->flank,
                                      .posture = &controller->posture,
                                      .force = &controller->tip_force,
                                      .is_sensed = snapshot->force_is_sensed,
                                      .parameters = &controller->parameters.in_force,
                                      .down = controller->gravity.down};
    interval_step(interval, &inputs);
    snapshot->force_x_interval_n = interval->x_n;
    snapshot->force_y_interval_n = interval->y_n;
    snapshot->force_z_interval_n = interval->z_n;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        snapshot->load_interval_n_mm[i] = interval->load_n_mm[i];
    }
}

/* K of these samples. There is none in CONFIGURATION, nor while a set comes into force: the model is in the making. */
static void take_stiffness(controller_t *controller, brace_snapshot_t *snapshot)
{
    if (controller->mode.now == BRACE_MODE_CONFIGURATION || controller->parameters.comes_in_force) {
        posture_settle(&controller->posture, NULL);
        stiffness_unknown(snapshot, BRACE_FLAG_STALE);
    } else {
        stiffness_take(&controller->model, &controller->parameters.in_force,
                       parameter_job_is_calibrated(&controller->parameters), &controller->joints, &controller->flank,
                       &controller->gravity, &controller->softening, &controller->posture, snapshot);
    }
    if (snapshot->k_is_valid) {
        sigma_report(controller, snapshot);
    }
}

/* Where the limb stands, once K has found the equilibrium. */
static void take_place(const controller_t *controller, brace_snapshot_t *snapshot)
{
    const float unknown = __builtin_nanf("");
    const posture_t *posture = &controller->posture;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        snapshot->theta_rad[i] = posture->theta_rad[i];
    }
    snapshot->tip_mm = snapshot->play_shift_mm = (brace_point_t){unknown, unknown};
    if (posture->has_levers) {
        snapshot->tip_mm = posture->pose.tip;
        (void)brace_backlash_tip_shift(&posture->pose, snapshot->play[BRACE_FEMUR].offset_rad,
                                       snapshot->play[BRACE_TIBIA].offset_rad, &snapshot->play_shift_mm);
    }
    snapshot->gravity_direction_rad = controller->gravity.direction_rad;
    snapshot->gravity_lean_rad = controller->gravity.lean_rad;
}

/* Looks over another slice of what must not change. What has changed is made anew from the store; where down is has
 * to be sent again by the main computer, if it had sent it. */
static void step_guard(controller_t *controller, bool has_worked)
{
    if (controller->parameters.comes_in_force) {
        return;
    }
    const guard_span_t span = guarded(controller, controller->guard.span);
    const uint32_t due_words = controller->parameters.in_force.controller.tick_us * GUARDED_WORDS_PER_MS / 1000u;
    const uint32_t half_words = due_words / 2u;
    const uint32_t fewer_words = half_words < GUARDED_WORDS_FEWER ? half_words : GUARDED_WORDS_FEWER;
    const uint32_t words = has_worked ? due_words - fewer_words : due_words;
    if (!guard_step(&controller->guard, &span, GUARDED_SPANS, words)) {
        controller->memory_is_wrong = true;
    }
    if (controller->memory_is_wrong) {
        controller->gravity.is_sent = false;
        controller->configure_part = 0;
        parameter_job_reload(&controller->parameters);
    }
}

/* One step of the job that stores parameters, or of putting a stored set in force. */
static void step_parameters(brace_app_t *app)
{
    controller_t *controller = &app->controller;
    if (controller->parameters.comes_in_force) {
        (void)configure_step(controller);
    } else if (parameter_job_step(&controller->parameters)) {
        controller->configure_part = 0;
    }
    if (controller->mode.now == BRACE_MODE_CONFIGURATION &&
        parameter_job_idle_us(&controller->parameters, controller->since_us) >= BRACE_CONFIGURATION_PATIENCE_US) {
        (void)brace_app_configuration_leave(app);
    }
}

/* The parts of a tick in their order. Each that is done is another digit, so that only a tick with all of them feeds
 * the watchdog. */
enum {
    PART_SENSED = 1,
    PART_STIFFNESS = 2,
    PART_JOBS = 3,
    PART_COMMANDED = 4,
    PART_WIRES = 5,
    PART_WORKED = 6,
    PART_GUARDED = 7,
    PART_HEARD = 8
};
#define ALL_PARTS 0x81234567u

static void part_is_done(controller_t *controller, uint32_t part)
{
    controller->parts_done = controller->parts_done << 4 | part;
}

/* Sensors that tell the same whatever the limb does. */
static void watch_sensors(controller_t *controller)
{
    const frozen_inputs_t inputs = {.joints = &controller->joints,
                                    .posture = &controller->posture,
                                    .force = &controller->tip_force,
                                    .parameters = &controller->parameters.in_force,
                                    .down = controller->gravity.down,
                                    .commanded_offset_rad = controller->drives.commanded_offset_rad,
                                    .limit_n_mm = controller->drives.limit_n_mm};
    frozen_watch(&controller->frozen, &inputs);
}

/* A tick passes for every job. */
static void step_jobs(brace_app_t *app, const brace_snapshot_t *snapshot)
{
    controller_t *controller = &app->controller;
    if (!controller->ownership.is_held) {
        const loading_inputs_t inputs = controller_loading_inputs(controller, snapshot);
        takeup_step(&controller->takeup, &controller->flank);
        loading_step(&controller->loading, &inputs);
    }
    step_parameters(app);
    question_job_age(&controller->question);
    sigma_job_age(&controller->sigma);
    softening_age(&controller->softening, controller->model.is_spatial && snapshot->load.is_counted);
}

/* The wires look at all that has come: stops and sessions come before everything. Whoever has hung up is gone before
 * the next one is heard. */
static void hear(brace_app_t *app, uint32_t now_us)
{
    controller_t *controller = &app->controller;
    session_t *session = &controller->ownership.session;
    if (session->is_open && controller_has_hung_up(controller, session->owner)) {
        session_hang_up(session);
    }
    controller->ownership.is_by_wire = true;
    wires_hear(&app->wires, controller->hal, app, &controller->counters, now_us);
    controller->ownership.is_by_wire = false;
}

/* The wires answer questions and send what is due. returns how much they have done (wire/wire.h) */
static uint32_t serve_wires(brace_app_t *app, uint32_t now_us)
{
    controller_t *controller = &app->controller;
    controller->ownership.is_by_wire = true;
    const uint32_t wire_work = wires_tick(&app->wires, controller->hal, app, &controller->counters, now_us);
    controller->ownership.is_by_wire = false;
    return wire_work;
}

/* returns whether there was work to do, as the functions below do */
static bool work_on_question(controller_t *controller, uint32_t steps_most)
{
    const question_inputs_t inputs = question_inputs(controller);
    return question_job_work(&controller->question, &inputs, steps_most);
}

static bool work_on_drift(controller_t *controller)
{
    const drift_inputs_t inputs = drift_inputs(controller);
    return drift_job_work(&controller->drift, &inputs);
}

/* A reading of the test goes to the drift check. */
static bool work_on_loading(controller_t *controller, const brace_snapshot_t *now)
{
    const loading_inputs_t inputs = controller_loading_inputs(controller, now);
    loading_reading_t reading;
    const bool has_worked = loading_work(&controller->loading, &inputs, &controller->recorder, &reading);
    if (reading.is_there && reading.is_fit) {
        drift_job_take(&controller->drift, &reading.reading, &reading.model, reading.run_ends);
    } else if (reading.is_there) {
        drift_job_end_run(&controller->drift);
    }
    return has_worked;
}

static void work_on_softening(controller_t *controller)
{
    softening_work(&controller->softening, &controller->model, &controller->parameters.in_force.limb,
                   controller->posture.unbent_rad);
}

/* returns whether there was work to do */
static bool work_on_sigma(controller_t *controller)
{
    if (!sigma_job_is_under_way(&controller->sigma)) {
        return sigma_begin(controller);
    }
    sigma_job_step(&controller->sigma, &controller->parameters.in_force);
    return true;
}

/* One step of one job: the first that has something to do takes it. After eight steps, questions leave a tick to the
 * jobs behind them. Where the wires had nothing to do, a question has room for two steps.
 *   wire_work: how much the wires have done in this tick
 * returns whether a job has worked */
static bool work_on_jobs(controller_t *controller, const brace_snapshot_t *now, uint32_t wire_work)
{
    return work_on_question(controller, wire_work == 0u ? STEPS_IN_A_QUIET_TICK : 1u) || work_on_drift(controller) ||
           (!controller->ownership.is_held && work_on_loading(controller, now));
}

/* What costs much and moves nothing comes last, where the wires have left room for it. Whoever uses K needs to know how
 * exactly it is known: a step of that job which has waited for too long comes before all others, also where the wires
 * have done more. In the tick that a flood of commands leaves to jobs, another one has its step too. A tick that is
 * full of a burst or of commands has no step at all.
 * returns whether a job has worked, so that the sensors' watch waits */
static bool work(brace_app_t *app, const brace_snapshot_t *now, uint32_t wire_work)
{
    controller_t *controller = &app->controller;
    softening_t *softening = &controller->softening;
    if (controller->parameters.comes_in_force) { /* then the model may be that of the set before */
        return false;
    }
    if (controller->model.is_spatial && controller->ticks_unwatched >= UNWATCHED_MOST) {
        return false;
    }
    if (wire_work > WIRE_WORK_FULL) {
        return false;
    }
    const bool was_overdue = sigma_job_is_overdue(&controller->sigma) && work_on_sigma(controller);
    if (wire_work > WIRE_WORK_MOST || (was_overdue && !app->wires.leaves_room)) {
        return was_overdue;
    }
    if (softening_is_overdue(softening)) {
        work_on_softening(controller);
        return true;
    }
    if (work_on_jobs(controller, now, was_overdue ? WIRE_WORK_MOST : wire_work) || was_overdue) {
        return true;
    }
    const bool softens = wire_work == 0u && softening_is_due(softening);
    if (softens) {
        work_on_softening(controller);
    }
    for (uint32_t i = softens ? 1u : 0u; i < (wire_work == 0u ? STEPS_IN_A_QUIET_TICK : 1u); i++) {
        (void)work_on_sigma(controller);
    }
    return softens;
}

/* Watches sensors and memory. A tick in which a job has worked, or which is full, skips the sensors; where a job has
 * worked less memory is looked over, too. That delays little, because the proof of a stuck sensor takes a quarter of a
 * second anyway. After UNWATCHED_MOST such ticks in a row none is full, and of a limb in space no job works, which has
 * work in every tick where masters ask. */
static void step_watches(controller_t *controller, bool has_worked, uint32_t wire_work)
{
    const bool is_full = wire_work > WIRE_WORK_FULL && controller->ticks_unwatched < UNWATCHED_MOST;
    const bool waits = has_worked || is_full;
    controller->ticks_unwatched += waits;
    if (!waits) {
        controller->ticks_unwatched = 0;
        watch_sensors(controller);
    }
    step_guard(controller, has_worked);
}

static void update_faults(controller_t *controller, bool late, bool bus_off)
{
    const joint_t *joint = controller->joints.joint;
    const bool coxa_is_missing = joint[BRACE_COXA].fitted && !joint[BRACE_COXA].sound;
    const bool store_failed = controller->drift.memory_failed;
    const uint32_t causes = (joint[BRACE_FEMUR].sound ? 0u : (uint32_t)BRACE_FAULT_SENSOR_FEMUR) |
                            (joint[BRACE_TIBIA].sound ? 0u : (uint32_t)BRACE_FAULT_SENSOR_TIBIA) |
                            (coxa_is_missing ? (uint32_t)BRACE_FAULT_SENSOR_COXA : 0u) |
                            (frozen_any(&controller->frozen) ? (uint32_t)BRACE_FAULT_ENCODER_STUCK : 0u) |
                            (late ? (uint32_t)BRACE_FAULT_TICK_LATE : 0u) |
                            (bus_off ? (uint32_t)BRACE_FAULT_CAN_BUS_OFF : 0u) |
                            (drives_refuse(&controller->drives) ? (uint32_t)BRACE_FAULT_DRIVE_REFUSES : 0u) |
                            (controller->memory_is_wrong ? (uint32_t)BRACE_FAULT_MEMORY : 0u);
    const uint32_t jumps = (joint[BRACE_COXA].has_jumped ? (uint32_t)BRACE_FAULT_JUMP_COXA : 0u) |
                           (joint[BRACE_FEMUR].has_jumped ? (uint32_t)BRACE_FAULT_JUMP_FEMUR : 0u) |
                           (joint[BRACE_TIBIA].has_jumped ? (uint32_t)BRACE_FAULT_JUMP_TIBIA : 0u);
    const uint32_t lasting = controller->parameters.faults | jumps | (store_failed ? (uint32_t)BRACE_FAULT_STORE : 0u) |
                             (drift_job_alarms(&controller->drift) ? (uint32_t)BRACE_FAULT_MODEL_DRIFT : 0u) |
                             (controller->has_crashed ? (uint32_t)BRACE_FAULT_CRASHED : 0u);
    faults_update(&controller->faults, causes, lasting, controller->mode.now != BRACE_MODE_START,
                  controller->parameters.in_force.controller.tick_us);
}

/* A fault that makes K invalid ends a loading test and lets the backlash go. Both still move the limb back to where
 * they began, at their own pace. */
static void update_mode(controller_t *controller)
{
    const mode_inputs_t inputs = {.joints_are_sound = joints_plane_is_sound(&controller->joints),
                                  .faults = controller->faults.now,
                                  .tests = loading_runs(&controller->loading),
                                  .takes_up = controller_takes_up(controller),
                                  .tick_us = controller->parameters.in_force.controller.tick_us};
    if (mode_update(&controller->mode, &inputs)) {
        loading_end(&controller->loading, BRACE_LOADING_E_LOST);
        takeup_let_go(&controller->takeup);
    }
}

static void command_drives(controller_t *controller)
{
    drives_test_t test = {.runs = loading_runs(&controller->loading)};
    /* When parameters come into force, the take-ups begin anew. They do not know what was commanded before. */
    const bool stands = controller->ownership.is_held || controller->parameters.comes_in_force;
    for (int i = 0; i < BRACE_LINK_COUNT && test.runs; i++) {
        test.offset_rad[i] = loading_offset_rad(&controller->loading, i);
        test.torque_limit_n_mm[i] = loading_torque_limit_n_mm(&controller->loading, i);
    }
    drives_command(&controller->drives, controller->hal, &controller->joints, &controller->flank,
                   takeup_runs(&controller->takeup), &test, stands, controller->parameters.in_force.controller.tick_us,
                   &controller->counters.commands_failed);
}

/* The snapshot is complete: it is the newest from here on. */
static void publish(controller_t *controller, brace_snapshot_t *snapshot)
{
    snapshot->mode = controller->mode.now;
    snapshot->faults = controller->faults.now;
    snapshot->parameter_crc = controller->parameters.crc;
    snapshot->parameter_origin = controller->parameters.origin;
    snapshot->parameter_sequence = brace_store_sequence(&controller->parameters.store);
    snapshot->parameter_sequence_wanted = brace_store_wanted_sequence(&controller->parameters.store);
    if (!mode_reports_k(snapshot->mode)) {
        stiffness_unknown(snapshot, snapshot->stiffness.now.flags | BRACE_FLAG_STALE);
    }
    snapshot->sequence = ++controller->sequence;
    controller->newest = 1u - controller->newest;
}

void brace_app_tick(brace_app_t *app, uint32_t now_us)
{
    controller_t *controller = &app->controller;
    const brace_hal_t *hal = controller->hal;
    const brace_parameters_t *parameters = &controller->parameters.in_force;
    brace_snapshot_t *snapshot = &controller->snapshot[1u - controller->newest];
    const bool late = tick_is_late(controller, now_us);
    controller->parts_done = 0;

    session_pass(&controller->ownership.session, controller->since_us); /* before anything is heard that may be old */
    hear(app, now_us);
    part_is_done(controller, PART_HEARD);
    step_ownership(app);

    /* Sense. */
    joints_read(&controller->joints, hal, parameters, now_us, &controller->counters.samples_bad);
    tip_force_read(&controller->tip_force, hal, parameters, controller->since_us);
    snapshot->taken_us = taken_us(controller);
    snapshot->temp_degc = joints_warmest_degc(&controller->joints);
    part_is_done(controller, PART_SENSED);

    /* Which flank carries, where the limb stands, how stiff it is. */
    flank_tick(&controller->flank, &controller->joints, &controller->tip_force, &controller->posture,
               controller->gravity.down, parameters, controller->ownership.is_held, now_us);
    take_posture(controller, snapshot);
    take_force(controller, snapshot);
    take_interval(controller, snapshot);
    take_stiffness(controller, snapshot);
    take_place(controller, snapshot);
    part_is_done(controller, PART_STIFFNESS);

    step_jobs(app, snapshot);
    part_is_done(controller, PART_JOBS);

    /* Faults and mode, and what follows from them. */
    update_faults(controller, late, wires_are_bus_off(&app->wires));
    update_mode(controller);
    command_drives(controller);
    part_is_done(controller, PART_COMMANDED);

    /* Tell, and work on what takes longer than a tick. */
    publish(controller, snapshot);
    const uint32_t wire_work = serve_wires(app, now_us);
    part_is_done(controller, PART_WIRES);
    const bool has_worked = work(app, snapshot, wire_work);
    part_is_done(controller, PART_WORKED);
    step_watches(controller, has_worked, wire_work);
    part_is_done(controller, PART_GUARDED);

    /* A tick that left a part out, or did one twice, feeds no watchdog. */
    if (controller->parts_done == ALL_PARTS) {
        hal->watchdog_feed(hal->context);
    }
}
