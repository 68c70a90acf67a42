#include "brace/drift.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/check.h"
#include "base/trig.h"
#include "brace/kinematics.h"
#include "use/drift_model.h"

/* A new run begins when the posture changes by this much, and after so many readings, because sensors drift slowly. */
#define SAME_POSTURE_RAD 1e-3f
#define RUN_MOST 64

/* The check learns nothing from a reading that is further off than this. */
#define OUTLIER_SIGMAS 6.0f

/* The most evidence that one force component may add, so that no single reading raises an alarm. */
#define EVIDENCE_MOST 8.0f

/* Evidence that readings scatter more than their noise. It is the log likelihood ratio of a fourfold variance against
 * the noise's own, 3/8 nu^2/S - ln(4)/2 for a surprise nu of variance S. nu^2/S is limited. */
#define SCATTER_GAIN 0.375f
#define SCATTER_COST 0.69314718f
#define SCATTER_MOST 8.0f

/* A cause counts as nearly as likely as the likeliest if its log likelihood is lower by at most this, and a share of
 * the likeliest's. The share allows for large losses, which shift the force not quite as the slopes say. */
#define NEARLY_AS_LIKELY 3.0f
#define NEARLY_RATIO 0.1f

/* A baseline that has moved by this share of its compliance, and by six sigma, is an alarm too. */
#define WANDER_RATIO 0.10f
#define WANDER_SIGMAS 6.0f

/* The change of a link's compliance for which evidence is gathered and an outlook is computed: a tenth of the stiffness
 * lost. */
#define CHANGE_RATIO 0.08f
#define LOSS_LOOKED_FOR 0.111111f
#define INFINITY_RATIO 1e9f

/* How far each estimate may wander per reading; for a compliance this is a share of CHANGE_RATIO. The estimates thus
 * have a memory of some 10,000 readings. */
#define WALK_RATIO 1e-4f
#define ANGLE_WALK_RAD 3e-7f
#define THERMAL_WALK_RATIO 1e-5f

/* The covariance P of the estimates is symmetric, so only its upper triangle is stored, row by row. */
enum { ENTRIES = 28 };
static const uint8_t diagonal[DRIFT_OFFSETS] = {0, 7, 13, 18, 22, 25, 27};

static inline float square(float x)
{
    return x * x;
}

/* The sum of h[i] times the i-th number that follows. */
static inline float weigh(const float h[DRIFT_OFFSETS], float a, float b, float c, float d, float e, float f, float g)
{
    const float first = brace_fma(d, h[3], brace_fma(c, h[2], brace_fma(b, h[1], a * h[0])));
    return brace_fma(g, h[6], brace_fma(f, h[5], brace_fma(e, h[4], first)));
}

static inline float dot(const float a[DRIFT_OFFSETS], const float b[DRIFT_OFFSETS])
{
    return weigh(a, b[0], b[1], b[2], b[3], b[4], b[5], b[6]);
}

/* a += by b for the first `count` numbers. Unrolled: at seven numbers the loop itself would cost more than they do. */
static inline void add(float *a, const float *b, float by, int count)
{
#pragma GCC unroll 8
    for (int i = 0; i < count; i++) {
        a[i] = brace_fma(by, b[i], a[i]);
    }
}

/* g = P h */
static inline void spread(const float p[ENTRIES], const float h[DRIFT_OFFSETS], float g[DRIFT_OFFSETS])
{
    g[0] = weigh(h, p[0], p[1], p[2], p[3], p[4], p[5], p[6]);
    g[1] = weigh(h, p[1], p[7], p[8], p[9], p[10], p[11], p[12]);
    g[2] = weigh(h, p[2], p[8], p[13], p[14], p[15], p[16], p[17]);
    g[3] = weigh(h, p[3], p[9], p[14], p[18], p[19], p[20], p[21]);
    g[4] = weigh(h, p[4], p[10], p[15], p[19], p[22], p[23], p[24]);
    g[5] = weigh(h, p[5], p[11], p[16], p[20], p[23], p[25], p[26]);
    g[6] = weigh(h, p[6], p[12], p[17], p[21], p[24], p[26], p[27]);
}

/* P -= g g' / s */
static inline void narrow(float p[ENTRIES], const float g[DRIFT_OFFSETS], float per_s)
{
    add(p, g, -g[0] * per_s, 7);
    add(p + 7, g + 1, -g[1] * per_s, 6);
    add(p + 13, g + 2, -g[2] * per_s, 5);
    add(p + 18, g + 3, -g[3] * per_s, 4);
    add(p + 22, g + 4, -g[4] * per_s, 3);
    add(p + 25, g + 5, -g[5] * per_s, 2);
    add(p + 27, g + 6, -g[6] * per_s, 1);
}

/* The change of each cause for which evidence is gathered, as a share of the compliance that the cause belongs to. */
static void change_of(const drift_compliances_t *c, float change[BRACE_DRIFT_CAUSE_COUNT])
{
    change[BRACE_DRIFT_FEMUR] = CHANGE_RATIO;
    change[BRACE_DRIFT_TIBIA_OR_KNEE] = CHANGE_RATIO * c->tibia_share;
    change[BRACE_DRIFT_FEMUR_JOINT_OR_BASE] = CHANGE_RATIO;
}

static void forget(brace_drift_t *drift, int cause)
{
    if (cause < BRACE_DRIFT_CAUSE_COUNT) {
        for (int i = 0; i < DRIFT_OFFSETS; i++) {
            drift->left[cause][i] = i == cause ? 1.0f : 0.0f;
        }
        drift->score[cause] = drift->information[cause] = 0.0f;
    }
    drift->evidence[cause] = 0.0f;
    drift->since[cause] = 0;
}

static void forget_all(brace_drift_t *drift)
{
    for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
        forget(drift, cause);
    }
    drift->cause = BRACE_DRIFT_UNEXPLAINED;
}

/* One sigma of each estimate before anything is learned, from the calibration's own trust. A wrong length looks like
 * wrong compliances. The part of its effect that lies between the levers of the femur joint and of the knee goes to the
 * femur's bending. */
static void prior(const brace_limb_t *limb, const drift_compliances_t *c, float trust, float sigma[DRIFT_OFFSETS])
{
    const brace_uncertainty_t *u = &limb->uncertainty;
    const float by_femur = u->length_mm / limb->femur_mm, by_tibia = u->length_mm / limb->tibia_mm;
    const float common = square(u->gain_rel) + 4.0f * (square(by_femur) + square(by_tibia));
    const float levers =
        c->femur_mm_per_n > 0.0f ? c->hip_rad_per_n_mm * square(limb->femur_mm) / c->femur_mm_per_n : 0.0f;
    const float shares = square(c->tibia_share) + square(1.0f - c->tibia_share);
    const float known = square(u->compliance_rel);
    const float variance[DRIFT_OFFSETS] = {
        known + common + square(levers) * (square(by_femur) + square(by_tibia)),
        known * shares + common,
        known + common,
        2.0f * square(u->angle_rad),
        square(u->angle_rad),
        square(trust),
        known,
    };
    for (int i = 0; i < DRIFT_OFFSETS; i++) {
        sigma[i] = sqrtf(variance[i] + 1e-10f);
    }
}

/* Sets the covariance back to its first values, so that the estimates can be learned anew. */
static void doubt(brace_drift_t *drift, const brace_limb_t *limb)
{
    const drift_compliances_t c = drift_compliances(limb);
    float sigma[DRIFT_OFFSETS];
    prior(limb, &c, drift->setup.joint_compliance_trust_ratio, sigma);
    for (int i = 0; i < ENTRIES; i++) {
        drift->covariance[i] = 0.0f;
    }
    for (int i = 0; i < DRIFT_OFFSETS; i++) {
        drift->covariance[diagonal[i]] = square(sigma[i]);
    }
}

brace_status_t brace_drift_learn(brace_drift_t *drift, const brace_limb_t *limb, const brace_drift_setup_t *setup)
{
    if (drift == NULL || setup == NULL) {
        return BRACE_E_NULL;
    }
    brace_status_t status = brace_limb_check(limb);
    if (status == BRACE_OK) {
        status = brace_check_two(setup->noise_n, 0.0f, 1e6f);
    }
    if (status == BRACE_OK) {
        status = brace_check_two(setup->model_error_ratio, setup->joint_compliance_per_degc, 0.1f);
    }
    if (status == BRACE_OK) {
        status = brace_check_magnitude(setup->joint_compliance_trust_ratio, 1.0f);
    }
    if (status == BRACE_OK &&
        (!(setup->noise_n > 0.0f) || setup->model_error_ratio < 0.0f || setup->joint_compliance_trust_ratio < 0.0f)) {
        status = BRACE_E_RANGE;
    }
    if (status != BRACE_OK) {
        return status;
    }
    *drift = (brace_drift_t){.setup = *setup, .state = BRACE_DRIFT_LEARNING};
    doubt(drift, limb);
    forget_all(drift);
    return BRACE_OK;
}

brace_status_t brace_drift_reset(brace_drift_t *drift)
{
    if (drift == NULL) {
        return BRACE_E_NULL;
    }
    if (drift->state == BRACE_DRIFT_DRIFTED) {
        drift->state = BRACE_DRIFT_WATCHING;
    }
    forget_all(drift);
    return brace_drift_run(drift);
}

brace_status_t brace_drift_run(brace_drift_t *drift)
{
    if (drift == NULL) {
        return BRACE_E_NULL;
    }
    drift->run_count = 0;
    return BRACE_OK;
}

static inline bool within(float value, float limit)
{
    return fabsf(value) <= limit;
}

static brace_status_t check(const brace_limb_t *limb, const brace_stiffness_t *stiffness,
                            const brace_drift_reading_t *reading)
{
    if (limb == NULL || stiffness == NULL || reading == NULL) {
        return BRACE_E_NULL;
    }
    /* A sum is finite only if all its terms are. Values in range are far from the end of the float format. */
    const float sum = reading->theta1_rad + reading->theta2_rad + reading->dx_mm + reading->dz_mm + reading->fx_n +
                      reading->fz_n + reading->warmer_degc + stiffness->k_xz_n_per_mm;
    if (!brace_is_finite(sum)) {
        return BRACE_E_NOT_FINITE;
    }
    const bool sound = within(reading->theta1_rad, BRACE_ANGLE_LIMIT_RAD) &&
                       within(reading->theta2_rad, BRACE_ANGLE_LIMIT_RAD) && within(reading->dx_mm, 1e4f) &&
                       within(reading->dz_mm, 1e4f) && within(reading->fx_n, 1e6f) && within(reading->fz_n, 1e6f) &&
                       within(reading->warmer_degc, 200.0f) && stiffness->lambda_min_n_per_mm > 0.0f &&
                       stiffness->lambda_max_n_per_mm < 1e12f;
    return sound ? BRACE_OK : BRACE_E_RANGE;
}

/* Takes a value into the mean of its run. Returns the difference between the value and the mean before. */
static float from_mean(float *mean, float value, float gain)
{
    const float differs = value - *mean;
    *mean = brace_fma(gain, differs, *mean);
    return differs;
}

/* Replaces displacement and force of a reading by their differences from the mean of their run. Returns false for the
 * first reading of a run, which has no mean before it. Differences from the mean of all earlier readings are
 * independent of one another, with a variance of 1 + 1/count. */
static bool take_into_run(brace_drift_t *drift, brace_drift_reading_t *reading)
{
    if (fabsf(reading->theta1_rad - drift->run_theta_rad[0]) > SAME_POSTURE_RAD ||
        fabsf(reading->theta2_rad - drift->run_theta_rad[1]) > SAME_POSTURE_RAD || drift->run_count >= RUN_MOST) {
        drift->run_count = 0;
    }
    if (drift->run_count == 0u) {
        drift->run_theta_rad[0] = reading->theta1_rad;
        drift->run_theta_rad[1] = reading->theta2_rad;
        for (int i = 0; i < 4; i++) {
            drift->run_mean[i] = 0.0f;
        }
    }
    drift->run_count++;
    const float gain = 1.0f / (float)drift->run_count;
    reading->dx_mm = from_mean(&drift->run_mean[0], reading->dx_mm, gain);
    reading->dz_mm = from_mean(&drift->run_mean[1], reading->dz_mm, gain);
    reading->fx_n = from_mean(&drift->run_mean[2], reading->fx_n, gain);
    reading->fz_n = from_mean(&drift->run_mean[3], reading->fz_n, gain);
    return drift->run_count > 1u;
}

/* The error of the model that the check always allows for [N]. */
static float bias_of(const brace_drift_t *drift, const drift_expected_t *expected)
{
    return drift->setup.model_error_ratio * (fabsf(expected->force_n[0]) + fabsf(expected->force_n[1]));
}

/* One force component of a reading, with the values that follow from it. */
typedef struct {
    const float *slopes; /* how the expected force shifts with each estimate */
    float off_n; /* measured less expected */
    float bias_n; /* bound of the error that is always allowed for */
    float gain[DRIFT_OFFSETS]; /* P times the slopes */
    float per_variance; /* one over the variance of off_n, its noise and the estimates' together */
} component_t;

/* Gathers evidence for each cause: how much likelier off_n is if that cause has changed by `change`. The part of such a
 * change that the estimates have already absorbed does not show any more (drift->left). */
static void gather_evidence(brace_drift_t *drift, const component_t *component, bool teaches,
                            const float change[BRACE_DRIFT_CAUSE_COUNT])
{
    const float off = component->off_n, bias = component->bias_n, per_variance = component->per_variance;
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
        const float shows = dot(component->slopes, drift->left[cause]);
        const float step = shows * change[cause];
        const float more = (step * off - 0.5f * step * step - fabsf(step) * bias) * per_variance;
        drift->evidence[cause] += more < EVIDENCE_MOST ? more : EVIDENCE_MOST;
        drift->score[cause] += shows * off * per_variance;
        drift->information[cause] += shows * shows * per_variance;
        if (teaches) {
            add(drift->left[cause], component->gain, -shows * per_variance, DRIFT_OFFSETS);
        }
    }
    const float beyond = fabsf(off) > bias ? fabsf(off) - bias : 0.0f;
    const float scatter = beyond * beyond * per_variance;
    drift->evidence[BRACE_DRIFT_UNEXPLAINED] +=
        SCATTER_GAIN * (scatter < SCATTER_MOST ? scatter : SCATTER_MOST) - SCATTER_COST;
}

/* Takes in one force component: the update of a Kalman filter, and evidence once the baseline is held.
 * noise: the component's variance; learned: grows by the step that the estimates are to take. */
static void take(brace_drift_t *drift, const float slopes[DRIFT_OFFSETS], float off_n, float noise, float bias_n,
                 const float change[BRACE_DRIFT_CAUSE_COUNT], float learned[DRIFT_OFFSETS])
{
    component_t component = {.slopes = slopes, .off_n = off_n, .bias_n = bias_n};
    spread(drift->covariance, slopes, component.gain);
    const float variance = dot(slopes, component.gain) + noise;
    component.per_variance = 1.0f / variance;
    const bool is_held = drift->state != BRACE_DRIFT_LEARNING;
    const bool is_outlier = is_held && fabsf(off_n) > OUTLIER_SIGMAS * sqrtf(variance);
    if (is_held) {
        gather_evidence(drift, &component, !is_outlier, change);
    }
    if (is_outlier) {
        drift->outliers = (uint8_t)(drift->outliers + (drift->outliers < UINT8_MAX));
        return;
    }
    add(learned, component.gain, off_n * component.per_variance, DRIFT_OFFSETS);
    narrow(drift->covariance, component.gain, component.per_variance);
}

static float sigma_of(const brace_drift_t *drift, int offset)
{
    return sqrtf(drift->covariance[diagonal[offset]]);
}

/* Ends learning: the present estimates become the baseline. */
static void hold(brace_drift_t *drift)
{
    for (int i = 0; i < BRACE_DRIFT_CAUSE_COUNT; i++) {
        drift->held[i] = drift->offset[i];
        drift->held_sigma[i] = sigma_of(drift, i);
    }
    drift->state = BRACE_DRIFT_WATCHING;
    forget_all(drift);
}

/* Is it an alarm? Evidence that falls to zero starts again, because a change may begin at any reading. */
static void judge(brace_drift_t *drift, const float change[BRACE_DRIFT_CAUSE_COUNT])
{
    for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
        if (drift->state == BRACE_DRIFT_WATCHING) {
            if (drift->evidence[cause] >= BRACE_DRIFT_ALARM) {
                drift->state = BRACE_DRIFT_DRIFTED;
            } else if (drift->evidence[cause] <= 0.0f) {
                forget(drift, cause);
                continue;
            }
        }
        drift->since[cause] = (uint16_t)(drift->since[cause] + (drift->since[cause] < UINT16_MAX));
    }
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
        const float away =
            fabsf(drift->offset[cause] - drift->held[cause]) - change[cause] * (WANDER_RATIO / CHANGE_RATIO);
        const float variance = drift->covariance[diagonal[cause]] + square(drift->held_sigma[cause]);
        if (away > 0.0f && away * away > square(WANDER_SIGMAS) * variance && drift->state == BRACE_DRIFT_WATCHING) {
            drift->state = BRACE_DRIFT_DRIFTED;
            drift->cause = (uint8_t)cause;
        }
    }
}

brace_status_t brace_drift_step(brace_drift_t *drift, const brace_limb_t *limb, const brace_stiffness_t *stiffness,
                                const brace_drift_reading_t *reading)
{
    if (drift == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check(limb, stiffness, reading);
    if (status != BRACE_OK) {
        return status;
    }
    drift->steps += drift->steps < UINT32_MAX;
    if (drift->steps == BRACE_DRIFT_LEARN_LEAST && drift->state == BRACE_DRIFT_LEARNING) {
        /* The slopes so far were those of the model, not of this limb: keep the estimates, but not their covariance. */
        doubt(drift, limb);
    }
    brace_drift_reading_t differs = *reading;
    if (!take_into_run(drift, &differs)) {
        return BRACE_OK;
    }
    drift_expected_t expected;
    drift_expect(limb, stiffness, &differs, drift->offset, drift->setup.joint_compliance_per_degc, &expected);
    const drift_compliances_t c = drift_compliances(limb);
    float change[BRACE_DRIFT_CAUSE_COUNT];
    change_of(&c, change);
    const float count = (float)(drift->run_count - 1u);
    const float noise = square(drift->setup.noise_n) * (1.0f + 1.0f / count);
    const float bias = bias_of(drift, &expected);
    float learned[DRIFT_OFFSETS] = {0};
    const float off = differs.fx_n - expected.force_n[0];
    take(drift, expected.per_offset[0], off, noise, bias + expected.doubt_n[0], change, learned);
    /* The second component is compared with the estimates that the first has just changed. */
    const float still = differs.fz_n - expected.force_n[1] - dot(expected.per_offset[1], learned);
    take(drift, expected.per_offset[1], still, noise, bias + expected.doubt_n[1], change, learned);
    add(drift->offset, learned, 1.0f, DRIFT_OFFSETS);
    for (int i = 0; i < DRIFT_OFFSETS; i++) {
        const float walk = i < BRACE_DRIFT_CAUSE_COUNT ? WALK_RATIO * change[i]
                           : i < DRIFT_THERMAL         ? ANGLE_WALK_RAD
                                                       : THERMAL_WALK_RATIO; /* and the axial compliance */
        drift->covariance[diagonal[i]] += walk * walk;
    }
    if (drift->state != BRACE_DRIFT_LEARNING) {
        judge(drift, change);
    } else if (drift->steps >= BRACE_DRIFT_LEARN_MOST ||
               (drift->steps >= BRACE_DRIFT_LEARN_LEAST && sigma_of(drift, 0) <= BRACE_DRIFT_LEARNED_TO &&
                sigma_of(drift, 1) <= BRACE_DRIFT_LEARNED_TO * c.tibia_share)) {
        hold(drift);
    }
    return BRACE_OK;
}

/* How well a cause of any size explains the readings since its evidence left zero; 0 for a cause without evidence. */
static float support(const brace_drift_t *drift, int cause)
{
    const float score = drift->score[cause];
    const bool seen = drift->evidence[cause] >= 0.5f * BRACE_DRIFT_ALARM && drift->information[cause] > 0.0f;
    return seen ? 0.5f * score * score / drift->information[cause] : 0.0f;
}

brace_status_t brace_drift_report(const brace_drift_t *drift, const brace_limb_t *limb, brace_drift_report_t *report)
{
    if (drift == NULL || limb == NULL || report == NULL) {
        return BRACE_E_NULL;
    }
    const drift_compliances_t c = drift_compliances(limb);
    float sigma[DRIFT_OFFSETS];
    prior(limb, &c, drift->setup.joint_compliance_trust_ratio, sigma);
    *report = (brace_drift_report_t){.state = (brace_drift_state_t)drift->state,
                                     .cause = BRACE_DRIFT_UNEXPLAINED,
                                     .evidence = drift->evidence[BRACE_DRIFT_UNEXPLAINED],
                                     .steps = drift->steps};
    if (drift->state == BRACE_DRIFT_DRIFTED) {
        report->cause = (brace_drift_cause_t)drift->cause;
    }
    float most = 0.0f;
    for (int i = 0; i < BRACE_DRIFT_CAUSE_COUNT; i++) {
        if (support(drift, i) > most) {
            most = support(drift, i);
            report->cause = (brace_drift_cause_t)i;
        }
        const float off = fabsf(drift->offset[i]) / sigma[i];
        report->baseline_sigmas = off > report->baseline_sigmas ? off : report->baseline_sigmas;
        report->evidence = drift->evidence[i] > report->evidence ? drift->evidence[i] : report->evidence;
    }
    const int cause = (int)report->cause;
    report->could_be = 1u << cause;
    report->since_steps = drift->since[cause];
    const float share[BRACE_DRIFT_CAUSE_COUNT] = {1.0f, c.tibia_share, 1.0f};
    for (int i = 0; i < 2; i++) {
        report->learned_sigma_ratio[i] = sigma_of(drift, i) / share[i];
    }
    for (int i = 0; i < BRACE_DRIFT_CAUSE_COUNT; i++) {
        const bool nearly = support(drift, i) >= most - NEARLY_AS_LIKELY - NEARLY_RATIO * most;
        report->could_be |= most > 0.0f && nearly ? 1u << i : 0u;
    }
    if (cause < BRACE_DRIFT_CAUSE_COUNT) {
        const bool sudden = most > 0.0f;
        const float walked = drift->offset[cause] - drift->held[cause];
        const float size = sudden ? drift->score[cause] / drift->information[cause] : walked;
        const float sigma_size = sudden ? 1.0f / sqrtf(drift->information[cause]) : sigma_of(drift, cause);
        report->loss_ratio = size / (share[cause] + size);
        report->loss_sigma_ratio = sigma_size / share[cause];
    }
    return BRACE_OK;
}

brace_status_t brace_drift_outlook(const brace_drift_t *drift, const brace_limb_t *limb,
                                   const brace_stiffness_t *stiffness, const brace_drift_reading_t *reading,
                                   brace_drift_outlook_t *outlook)
{
    if (drift == NULL || outlook == NULL) {
        return BRACE_E_NULL;
    }
    const brace_status_t status = check(limb, stiffness, reading);
    if (status != BRACE_OK) {
        return status;
    }
    drift_expected_t expected;
    drift_expect(limb, stiffness, reading, drift->offset, drift->setup.joint_compliance_per_degc, &expected);
    const drift_compliances_t c = drift_compliances(limb);
    float change[BRACE_DRIFT_CAUSE_COUNT];
    change_of(&c, change);
    const float bias = bias_of(drift, &expected);
    float information[BRACE_DRIFT_CAUSE_COUNT] = {0}, gain[BRACE_DRIFT_CAUSE_COUNT] = {0};
    for (int axis = 0; axis < 2; axis++) {
        const float *h = expected.per_offset[axis];
        float g[DRIFT_OFFSETS];
        spread(drift->covariance, h, g);
        const float per_variance = 1.0f / (dot(h, g) + square(drift->setup.noise_n));
        for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
            const float step = fabsf(h[cause]) * change[cause];
            const float shown = step * (LOSS_LOOKED_FOR / CHANGE_RATIO);
            information[cause] += h[cause] * h[cause] * per_variance;
            gain[cause] += step * (shown - 0.5f * step - bias - expected.doubt_n[axis]) * per_variance;
        }
    }
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
        const bool shows = gain[cause] * (float)UINT16_MAX > BRACE_DRIFT_ALARM;
        const float root = change[cause] * sqrtf(information[cause]);
        outlook->sigma_of_loss_ratio[cause] = root > 0.0f ? CHANGE_RATIO / root : INFINITY_RATIO;
        outlook->steps_needed[cause] = shows ? (uint32_t)(BRACE_DRIFT_ALARM / gain[cause]) + 1u : BRACE_DRIFT_NEVER;
    }
    return BRACE_OK;
}
