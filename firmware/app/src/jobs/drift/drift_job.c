#include "jobs/drift/drift_job.h"

_Static_assert(BRACE_JOURNAL_STATE_BYTES == sizeof(brace_drift_t), "what is kept is what the check knows");

#define EVIDENCE_WORTH_KEEPING 4.0f /* of the 20 that raise the alarm */
#define LEARNING_READINGS 512u
#define WATCHING_READINGS 4096u
#define TICKS_BETWEEN_WRITES 8u     /* a write may block for 1 ms, so two ticks in a row would come late */
#define ROOM_FOR_ALARMS 2u          /* records that are left for a change of the check's state */

#define LEAST_NOISE_N 1e-3f
#define MODEL_ERROR_RATIO 0.0005f   /* a larger one would hide the loss of a tenth of the tibia's stiffness */
#define COMPLIANCE_TRUST_RATIO 0.2f

#define READINGS_OF_A_TEST 64u      /* a long one: what more readings are needed for, another posture shows sooner */
#define EVIDENCE_THAT_GROWS 10.0f   /* half of what raises the alarm: worth another test */

/* Remembers what the newest record says, so that a later look can tell whether another record is worth writing. */
static void remember_kept(drift_job_t *job)
{
    job->kept_state = job->drift.state;
    job->kept_steps = job->drift.steps;
    for (int i = 0; i <= BRACE_DRIFT_CAUSE_COUNT; i++) {
        job->kept_evidence[i] = job->drift.evidence[i];
    }
}

void drift_job_configure(drift_job_t *job, bool is_fresh)
{
    job->learns_anew = true;
    job->is_erased = is_fresh;
    job->opens = job->scans = job->has_reading = job->looks = job->foresees = job->has_outlook = false;
}

/* Begins to learn the limb in force. */
static void learn_anew(drift_job_t *job, const drift_inputs_t *inputs)
{
    const brace_parameters_t *parameters = inputs->parameters;
    const float noise_n = parameters->sensor.noise_n;
    const brace_drift_setup_t setup = {.noise_n = noise_n > LEAST_NOISE_N ? noise_n : LEAST_NOISE_N,
                                       .model_error_ratio = MODEL_ERROR_RATIO,
                                       .joint_compliance_per_degc = parameters->slow.joint_compliance_per_degc,
                                       .joint_compliance_trust_ratio = COMPLIANCE_TRUST_RATIO};
    (void)brace_drift_learn(&job->drift, &parameters->limb, &setup);
    remember_kept(job);
    job->learns_anew = false;
    job->opens = true;
}

/* Opens the journal in the slot of the limb in force. A record belongs to this set of parameters, and to this setup of
 * the check. */
static void open_journal(drift_job_t *job, const drift_inputs_t *inputs)
{
    const bool is_kept = inputs->origin == BRACE_PARAMETERS_SLOT_A || inputs->origin == BRACE_PARAMETERS_SLOT_B;
    const uint32_t slot = is_kept ? (uint32_t)inputs->origin - 1u : (uint32_t)BRACE_NVM_SLOT_COUNT;
    const uint32_t identity =
        brace_crc32(inputs->parameter_crc, (const uint8_t *)&job->drift.setup, sizeof job->drift.setup);
    if (job->is_erased) {
        brace_journal_open_erased(&job->journal, inputs->hal, slot, identity);
    } else {
        brace_journal_open(&job->journal, inputs->hal, slot, identity);
    }
    job->opens = false;
    job->scans = !job->is_erased;
    job->reports = true;
    job->memory_failed = false;
}

/* Goes on from the record that the scan has found. A full journal is not kept up to date, so that its evidence may be
 * of long ago: only an alarm is believed then. */
static void resume(drift_job_t *job)
{
    (void)brace_drift_run(&job->drift);
    if (brace_journal_room(&job->journal) <= ROOM_FOR_ALARMS && job->drift.state != BRACE_DRIFT_DRIFTED) {
        (void)brace_drift_reset(&job->drift);
    }
    remember_kept(job);
    job->reports = true;
}

static void scan(drift_job_t *job)
{
    job->scans = brace_journal_scan(&job->journal, &job->drift);
    if (!job->scans && job->journal.found) {
        resume(job);
    }
}

static float square_of_displacement(const brace_drift_reading_t *reading)
{
    return reading->dx_mm * reading->dx_mm + reading->dz_mm * reading->dz_mm;
}

static bool is_same_posture(const brace_drift_reading_t *a, const brace_drift_reading_t *b)
{
    return a->theta1_rad == b->theta1_rad && a->theta2_rad == b->theta2_rad;
}

static void take_in(drift_job_t *job, const brace_limb_t *limb)
{
    const brace_drift_reading_t *reading = &job->reading;
    if (!is_same_posture(reading, &job->widest) ||
        square_of_displacement(reading) > square_of_displacement(&job->widest)) {
        job->widest = *reading;
    }
    (void)brace_drift_step(&job->drift, limb, &job->model, &job->reading);
    if (job->run_ends) {
        (void)brace_drift_run(&job->drift);
    }
    job->has_reading = false;
    job->looks = job->reports = job->foresees = true;
}

static bool is_worth_a_record(const drift_job_t *job)
{
    const brace_drift_t *drift = &job->drift;
    const uint32_t every = drift->state == BRACE_DRIFT_LEARNING ? LEARNING_READINGS : WATCHING_READINGS;
    bool moved = drift->steps - job->kept_steps >= every;
    for (int i = 0; i <= BRACE_DRIFT_CAUSE_COUNT; i++) {
        moved = moved || __builtin_fabsf(drift->evidence[i] - job->kept_evidence[i]) >= EVIDENCE_WORTH_KEEPING;
    }
    return drift->state != job->kept_state || (moved && brace_journal_room(&job->journal) > ROOM_FOR_ALARMS);
}

/* Writes a record if one is worth it, a piece of it in each call. */
static void keep(drift_job_t *job)
{
    if (job->journal.state == BRACE_JOURNAL_BUSY) {
        if (brace_journal_step(&job->journal) == BRACE_JOURNAL_FAILED) {
            job->memory_failed = true;
            job->looks = false;
        }
        return; /* when the record stands there is another look, because readings may have come meanwhile */
    }
    job->looks = is_worth_a_record(job) && brace_journal_begin(&job->journal, &job->drift);
    if (job->looks) {
        remember_kept(job);
    }
}

void drift_job_take(drift_job_t *job, const brace_drift_reading_t *reading, const brace_stiffness_t *model,
                    bool run_ends)
{
    job->reading = *reading;
    job->model = *model;
    job->run_ends = run_ends;
    job->has_reading = true;
}

void drift_job_end_run(drift_job_t *job)
{
    if (job->has_reading) {
        job->run_ends = true;
    } else {
        (void)brace_drift_run(&job->drift);
    }
}

void drift_job_clear(drift_job_t *job)
{
    (void)brace_drift_reset(&job->drift);
    job->looks = job->reports = true;
}

/* returns whether it has kept a piece */
static bool keep_if_due(drift_job_t *job)
{
    job->ticks_to_write = job->ticks_to_write > 0u ? (uint8_t)(job->ticks_to_write - 1u) : 0u;
    if (job->ticks_to_write > 0u) {
        return false;
    }
    job->ticks_to_write = TICKS_BETWEEN_WRITES;
    keep(job);
    return true;
}

bool drift_job_work(drift_job_t *job, const drift_inputs_t *inputs)
{
    const brace_limb_t *limb = &inputs->parameters->limb;
    if (job->learns_anew) {
        learn_anew(job, inputs);
    } else if (job->opens) {
        open_journal(job, inputs);
    } else if (job->scans) {
        scan(job);
    } else if (job->has_reading) {
        take_in(job, limb);
    } else if (job->reports) {
        (void)brace_drift_report(&job->drift, limb, &job->report);
        job->reports = false;
    } else if (job->foresees) {
        job->has_outlook = brace_drift_outlook(&job->drift, limb, &job->model, &job->widest, &job->outlook) == BRACE_OK;
        job->foresees = false;
    } else {
        return job->looks && inputs->may_write && keep_if_due(job);
    }
    return true;
}

/* Would another test at this posture show whether the suspected cause is the one? */
static bool shows_here(const drift_job_t *job)
{
    const brace_drift_cause_t cause = job->report.cause;
    return cause == BRACE_DRIFT_UNEXPLAINED ||
           (job->has_outlook && job->outlook.steps_needed[cause] <= READINGS_OF_A_TEST);
}

brace_drift_next_t drift_job_next_step(const drift_job_t *job)
{
    const brace_drift_report_t *report = &job->report;
    const bool is_single = (report->could_be & (report->could_be - 1u)) == 0u;
    if (report->state == BRACE_DRIFT_LEARNING) {
        return BRACE_DRIFT_NEXT_LEARN;
    }
    if (report->state == BRACE_DRIFT_WATCHING) {
        return report->evidence < EVIDENCE_THAT_GROWS ? BRACE_DRIFT_NEXT_NOTHING
               : shows_here(job)                      ? BRACE_DRIFT_NEXT_REPEAT_TEST
                                                      : BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE;
    }
    if (!is_single) {
        return BRACE_DRIFT_NEXT_TEST_ANOTHER_POSTURE;
    }
    switch (report->cause) {
    case BRACE_DRIFT_FEMUR: return BRACE_DRIFT_NEXT_INSPECT_FEMUR_LINK;
    case BRACE_DRIFT_TIBIA_OR_KNEE: return BRACE_DRIFT_NEXT_INSPECT_TIBIA_LINK_AND_KNEE_JOINT;
    case BRACE_DRIFT_FEMUR_JOINT_OR_BASE: return BRACE_DRIFT_NEXT_INSPECT_FEMUR_JOINT_AND_BASE;
    case BRACE_DRIFT_UNEXPLAINED:
    default: return BRACE_DRIFT_NEXT_CHECK_SENSOR_AND_MOUNTING;
    }
}
