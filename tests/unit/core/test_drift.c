#include <math.h>
#include <string.h>

#include "brace/chain.h"
#include "brace/drift.h"
#include "close.h"
#include "noise.h"
#include "sample_limbs.h"
#include "unity.h"

/* The larger figures, against another simulation, are in tests/property/drift_figures.py. */

static const float postures[][2] = {{0.74f, 1.0f}, {1.51f, 2.23f}, {0.28f, 0.51f}, {2.15f, 2.69f}, {0.96f, 2.04f}};
enum { POSTURES = sizeof postures / sizeof postures[0], RUN = 12 };
#define NOISE_N 0.1f
#define STRETCHED 2 /* the posture that shows the tibia */

static const brace_drift_setup_t setup = {NOISE_N, 0.0005f, 0.02f, 0.2f};
static brace_drift_t drift;
static brace_limb_t believed, real;
static float warmer_degc, noise_n;

void setUp(void)
{
    noise_state = 7;
    warmer_degc = 0.0f;
    noise_n = NOISE_N;
    believed = sample_limb[SAMPLE_PAPER];
    real = believed;
    memset(&drift, 0x55, sizeof drift);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_learn(&drift, &believed, &setup));
}

void tearDown(void) {}

static brace_stiffness_t stiffness_of(const brace_limb_t *limb, const float posture[2])
{
    brace_chain_t chain;
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, posture[0], posture[1], &k));
    return k;
}

static brace_limb_t warmed(void)
{
    brace_limb_t limb = real;
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        limb.joint[joint].compliance_rad_per_n_mm *= 1.0f + 0.02f * warmer_degc;
    }
    return limb;
}

/* One run of the real limb at a posture, under an unknown load; the readings until an alarm. */
static int run(int posture, int along_z)
{
    const brace_limb_t limb = warmed();
    const brace_stiffness_t model = stiffness_of(&believed, postures[posture]),
                            k = stiffness_of(&limb, postures[posture]);
    int readings = 1;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_run(&drift));
    for (int i = 0; i < RUN; i++) {
        const float d = 0.635f * (float)(i % 2 == 0 ? i / 2 : -(i / 2)), dx = along_z ? 0.0f : d,
                    dz = along_z ? d : 0.0f;
        const brace_drift_reading_t reading = {
            postures[posture][0],
            postures[posture][1],
            30.0f + dx,
            dz - 20.0f,
            12.0f + k.k_xx_n_per_mm * dx + k.k_xz_n_per_mm * dz + noise_n * (float)noise_normal(),
            -9.0f + k.k_xz_n_per_mm * dx + k.k_zz_n_per_mm * dz + noise_n * (float)noise_normal(),
            warmer_degc};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        readings += drift.state == BRACE_DRIFT_WATCHING;
    }
    return readings;
}

static void rounds(int count)
{
    for (int i = 0; i < 2 * POSTURES * count; i++) {
        warmer_degc = 6.0f * (float)(i % 7 - 3) / 3.0f;
        run(i / 2 % POSTURES, i % 2);
    }
    warmer_degc = 0.0f;
}

static brace_drift_report_t report(void)
{
    brace_drift_report_t result;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_report(&drift, &believed, &result));
    return result;
}

static void learn_a_slightly_other_limb(void)
{
    real.link[BRACE_FEMUR].bending_mm_per_n *= 1.04f;
    real.link[BRACE_TIBIA].bending_mm_per_n *= 0.95f;
    real.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 0.96f;
    real.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= 1.05f;
    rounds(14);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
}

static void test_the_state_stays_small(void)
{
    TEST_ASSERT_LESS_OR_EQUAL(344, sizeof(brace_drift_t));
}

static void test_a_limb_within_its_calibration_is_learned_and_raises_no_alarm(void)
{
    learn_a_slightly_other_limb();
    rounds(6);
    const brace_drift_report_t now = report();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, now.state);
    TEST_ASSERT_EQUAL(20 * 2 * POSTURES * RUN, now.steps);
    TEST_ASSERT_TRUE(now.baseline_sigmas < 3.0f);
    ASSERT_CLOSE(0.04, drift.offset[BRACE_DRIFT_FEMUR], 0.02);
    ASSERT_CLOSE(-0.04, drift.offset[BRACE_DRIFT_FEMUR_JOINT_OR_BASE], 0.01);
    ASSERT_CLOSE(0.037, drift.offset[BRACE_DRIFT_TIBIA_OR_KNEE], 0.01); /* 0.137 of it the tibia's */
}

/* Learning begins with the calibration's own trust: the first readings move the estimates, by no more than it. */
static void test_learning_begins_with_the_trust_of_the_calibration(void)
{
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_EQUAL_FLOAT(0.0f, drift.offset[i]);
    }
    const brace_drift_report_t before = report();
    TEST_ASSERT_EQUAL(BRACE_DRIFT_LEARNING, before.state);
    TEST_ASSERT_EQUAL(0, before.steps);
    const float trust = before.learned_sigma_ratio[0];
    TEST_ASSERT_TRUE(trust > 0.5f * believed.uncertainty.compliance_rel && trust < 1.0f);
    real.link[BRACE_FEMUR].bending_mm_per_n *= 1.0f + 0.5f * trust;
    run(0, 0);
    run(0, 1);
    TEST_ASSERT_TRUE(drift.offset[BRACE_DRIFT_FEMUR] > 0.05f * trust && drift.offset[BRACE_DRIFT_FEMUR] < trust);
    TEST_ASSERT_TRUE(report().learned_sigma_ratio[0] < trust);
}

/* Trust in each number by itself. A wrong length makes all compliances wrong, by twice its share each; and beside that
 * the femur's, by as much as its joint yields beside it. Nothing else is doubted: each number's own sigma is left. */
static void test_trust_in_each_number_of_the_calibration(void)
{
    enum { DOUBTS = 5 };
    static const int diagonal[7] = {0, 7, 13, 18, 22, 25, 27}; /* of the covariance's upper triangle */
    for (int doubted = 0; doubted < DOUBTS; doubted++) {
        believed.uncertainty = (brace_uncertainty_t){.compliance_rel = doubted == 0 ? 0.07f : 0.0f,
                                                     .gain_rel = doubted == 1 ? 0.03f : 0.0f,
                                                     .length_mm = doubted == 2 ? 2.0f : 0.0f,
                                                     .angle_rad = doubted == 3 ? 0.02f : 0.0f};
        brace_drift_setup_t trusting = setup;
        trusting.joint_compliance_trust_ratio = doubted == 4 ? 0.4f : 0.0f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_learn(&drift, &believed, &trusting));
        const double femur = 2.0 / (double)believed.femur_mm, tibia = 2.0 / (double)believed.tibia_mm;
        const double hip_c =
            (double)believed.joint[BRACE_FEMUR].compliance_rad_per_n_mm + (double)believed.base.rotation_rad_per_n_mm;
        const double bends = (double)believed.link[BRACE_FEMUR].bending_mm_per_n;
        const double beside = hip_c * (double)believed.femur_mm * (double)believed.femur_mm / bends;
        const double length = doubted == 2 ? femur * femur + tibia * tibia : 0.0;
        const double known = doubted == 0 ? 0.07 * 0.07 : 0.0, gain = doubted == 1 ? 0.03 * 0.03 : 0.0;
        const double common = gain + 4.0 * length;
        const double angle = doubted == 3 ? 0.02 * 0.02 : 0.0, heat = doubted == 4 ? 0.4 * 0.4 : 0.0;
        const double wanted[7] = {
            known + common + beside * beside * length, -1.0, known + common, 2.0 * angle, angle, heat, known};
        if (doubted == 0) { /* of each bending as a share of itself; the tibia's is a part of what its estimate is of */
            const double knee_mm = (double)believed.joint[BRACE_TIBIA].compliance_rad_per_n_mm *
                                   (double)believed.tibia_mm * (double)believed.tibia_mm;
            const double tibia_mm = (double)believed.link[BRACE_TIBIA].bending_mm_per_n;
            ASSERT_CLOSE(0.07, report().learned_sigma_ratio[0], 1e-4);
            ASSERT_CLOSE(0.07 * hypot(tibia_mm, knee_mm) / tibia_mm, report().learned_sigma_ratio[1], 1e-3);
        }
        for (int i = 0; i < 7; i++) {
            const double is = (double)drift.covariance[diagonal[i]];
            if (wanted[i] >= 0.0) {
                ASSERT_CLOSE(wanted[i], is, 1e-3 * wanted[i] + 2e-10);
            } else { /* tibia and knee: their parts' own sigmas are independent, and so are less together */
                TEST_ASSERT_TRUE(is >= 0.5 * known + common && is <= known + common + 2e-10);
            }
        }
    }
}

/* The estimates narrow with each run. After the least number of readings they begin anew from the calibration's trust,
 * because the slopes before were those of the model. */
static void test_estimates_narrow_and_begin_anew_once(void)
{
    const float trust = report().learned_sigma_ratio[0];
    float before = trust;
    int anew = 0;
    for (int i = 0; drift.steps < 2u * BRACE_DRIFT_LEARN_LEAST && drift.state == BRACE_DRIFT_LEARNING; i++) {
        const uint32_t steps = drift.steps;
        run(i / 2 % POSTURES, i % 2);
        const float now = report().learned_sigma_ratio[0];
        if (steps < BRACE_DRIFT_LEARN_LEAST && drift.steps >= BRACE_DRIFT_LEARN_LEAST) {
            TEST_ASSERT_TRUE(now > 2.0f * before);
            anew++;
        } else {
            TEST_ASSERT_TRUE(now < 1.001f * before);
        }
        before = now;
        TEST_ASSERT_TRUE(i < 8 || anew > 0 || now < 0.7f * trust);
    }
    TEST_ASSERT_EQUAL(1, anew);
}

/* Evidence of one cause. A change of any size has the log likelihood score^2/(2 information). */
static void give_evidence(int cause, float evidence, float log_likelihood)
{
    drift.evidence[cause] = evidence;
    drift.information[cause] = 50.0f;
    drift.score[cause] = sqrtf(2.0f * 50.0f * log_likelihood);
}

/* A cause counts from half of an alarm's evidence on. The likeliest is reported, and every one that is nearly as
 * likely: less by 3 and a tenth at most. */
static void test_a_report_names_what_the_readings_support(void)
{
    const float half = 0.5f * BRACE_DRIFT_ALARM;
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) {
        const int other = (cause + 1) % BRACE_DRIFT_CAUSE_COUNT;
        setUp();
        give_evidence(cause, nextafterf(half, 0.0f), 20.0f);
        TEST_ASSERT_EQUAL(BRACE_DRIFT_UNEXPLAINED, report().cause);
        TEST_ASSERT_EQUAL(1u << BRACE_DRIFT_UNEXPLAINED, report().could_be);
        give_evidence(cause, half, 20.0f);
        TEST_ASSERT_EQUAL(cause, report().cause);
        TEST_ASSERT_EQUAL(1u << cause, report().could_be);
        give_evidence(other, half, 14.9f);
        TEST_ASSERT_EQUAL(1u << cause, report().could_be);
        give_evidence(other, half, 15.1f);
        TEST_ASSERT_EQUAL(cause, report().cause);
        TEST_ASSERT_EQUAL(1u << cause | 1u << other, report().could_be);
        give_evidence(other, half, 20.1f);
        TEST_ASSERT_EQUAL(other, report().cause);
        drift.information[cause] = 0.0f; /* nothing looked at it */
        TEST_ASSERT_EQUAL(1u << other, report().could_be);
    }
    setUp();
    give_evidence(BRACE_DRIFT_FEMUR, BRACE_DRIFT_ALARM, 20.0f); /* the compliance has grown by score/information */
    const double grown = sqrt(2.0 * 50.0 * 20.0) / 50.0;
    ASSERT_CLOSE(grown / (1.0 + grown), report().loss_ratio, 1e-5);
    ASSERT_CLOSE(1.0 / sqrt(50.0), report().loss_sigma_ratio, 1e-5);
}

/* Readings since an evidence left zero: none where it is zero, and one more with each reading. */
static void test_readings_are_counted_since_the_evidence_left_zero(void)
{
    learn_a_slightly_other_limb();
    real.link[BRACE_FEMUR].bending_mm_per_n /= 0.97f;
    uint32_t since[BRACE_DRIFT_CAUSE_COUNT + 1], zeros = 0, most = 0;
    const float *posture = postures[STRETCHED];
    const brace_stiffness_t model = stiffness_of(&believed, posture), k = stiffness_of(&real, posture);
    for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
        since[cause] = drift.since[cause];
    }
    for (int j = 0; j < 60 && drift.state == BRACE_DRIFT_WATCHING; j++) {
        const float dz = 0.3f * (float)(j % 5 - 2);
        const brace_drift_reading_t reading = {posture[0],
                                               posture[1],
                                               0.0f,
                                               dz,
                                               k.k_xz_n_per_mm * dz + noise_n * (float)noise_normal(),
                                               k.k_zz_n_per_mm * dz + noise_n * (float)noise_normal(),
                                               0.0f};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
            if (drift.evidence[cause] <= 0.0f) {
                TEST_ASSERT_EQUAL(0, drift.since[cause]);
                zeros++;
            } else if (j > 0) { /* the first of a run has no mean before it */
                TEST_ASSERT_TRUE(drift.since[cause] == since[cause] + 1u || drift.since[cause] == 1u);
            }
            most = drift.since[cause] > most ? drift.since[cause] : most;
            since[cause] = drift.since[cause];
        }
    }
    TEST_ASSERT_TRUE(zeros > 10 && most > 3);
}

/* What was no alarm while learning is no evidence when watching begins. */
static void test_watching_begins_without_evidence(void)
{
    int i = 0;
    for (; i < 400 && drift.state == BRACE_DRIFT_LEARNING; i++) {
        real.link[BRACE_FEMUR].bending_mm_per_n =
            believed.link[BRACE_FEMUR].bending_mm_per_n * (i % 40 < 20 ? 1.0f : 1.2f);
        const brace_limb_t limb = warmed();
        const float *posture = postures[i / 2 % POSTURES];
        const brace_stiffness_t model = stiffness_of(&believed, posture), k = stiffness_of(&limb, posture);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_run(&drift));
        for (int j = 0; j < RUN && drift.state == BRACE_DRIFT_LEARNING; j++) {
            const float d = 0.635f * (float)(j % 2 == 0 ? j / 2 : -(j / 2));
            const float dx = i % 2 ? d : 0.0f, dz = i % 2 ? 0.0f : d;
            const brace_drift_reading_t reading = {posture[0],
                                                   posture[1],
                                                   dx,
                                                   dz,
                                                   k.k_xx_n_per_mm * dx + k.k_xz_n_per_mm * dz,
                                                   k.k_xz_n_per_mm * dx + k.k_zz_n_per_mm * dz,
                                                   0.0f};
            TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        }
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
    for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
        TEST_ASSERT_EQUAL_FLOAT(0.0f, drift.evidence[cause]);
        TEST_ASSERT_EQUAL(0, drift.since[cause]);
    }
    for (int cause = 0; cause < BRACE_DRIFT_CAUSE_COUNT; cause++) { /* the baseline is what has been learned */
        TEST_ASSERT_TRUE(drift.offset[cause] < 0.0f || drift.offset[cause] > 0.0f);
        TEST_ASSERT_EQUAL_FLOAT(drift.offset[cause], drift.held[cause]);
    }
}

/* Readings that fit, within what the model itself may be off, are no evidence of anything. */
static void test_readings_that_fit_are_no_evidence(void)
{
    const brace_drift_setup_t rough = {NOISE_N, 0.02f, 0.02f, 0.2f};
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_learn(&drift, &believed, &rough));
    noise_n = 0.0f;
    rounds(20);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
    for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
        TEST_ASSERT_TRUE(drift.evidence[cause] < 0.25f * BRACE_DRIFT_ALARM);
    }
    TEST_ASSERT_TRUE(report().evidence < 0.25f * BRACE_DRIFT_ALARM);
}

/* The model may be off by its share of both forces together, also where they are alike. */
static void test_what_the_model_may_be_off_is_no_evidence(void)
{
    const brace_drift_setup_t rough = {0.1f * NOISE_N, 0.02f, 0.02f, 0.2f};
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_learn(&drift, &believed, &rough));
    noise_n = 0.1f * NOISE_N;
    rounds(20);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
    for (int posture = 0; posture < POSTURES; posture++) {
        const brace_stiffness_t k = stiffness_of(&believed, postures[posture]);
        const float det = k.lambda_min_n_per_mm * k.lambda_max_n_per_mm, x_n = 8.0f, z_n = 8.0f;
        const float dx = (k.k_zz_n_per_mm * x_n - k.k_xz_n_per_mm * z_n) / det;
        const float dz = (k.k_xx_n_per_mm * z_n - k.k_xz_n_per_mm * x_n) / det;
        for (int i = 0; i < 30; i++) {
            const float sign = i % 2 == 0 ? 1.0f : -1.0f, off = 1.0f + 0.018f * (float)(posture % 2 == 0 ? 1 : -1);
            const brace_drift_reading_t reading = {postures[posture][0], postures[posture][1], sign * dx, sign * dz,
                                                   sign * x_n * off,     sign * z_n * off,     0.0f};
            TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &k, &reading));
            for (int cause = 0; cause <= BRACE_DRIFT_CAUSE_COUNT; cause++) {
                TEST_ASSERT_TRUE(drift.evidence[cause] < 0.25f * BRACE_DRIFT_ALARM);
            }
        }
    }
}

static void check_loss(int link, brace_drift_cause_t cause)
{
    learn_a_slightly_other_limb();
    real.link[link].bending_mm_per_n /= 0.9f;
    const uint32_t steps_before = drift.steps;
    int readings = 0;
    for (int i = 0; i < 4 && drift.state == BRACE_DRIFT_WATCHING; i++) {
        readings += run(STRETCHED, 0);
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, drift.state);
    TEST_ASSERT_LESS_OR_EQUAL(30, readings);
    rounds(1); /* other postures separate the causes */
    const brace_drift_report_t now = report();
    TEST_ASSERT_EQUAL(cause, now.cause);
    TEST_ASSERT_EQUAL(1u << cause, now.could_be & 1u << cause);
    ASSERT_CLOSE(0.1, now.loss_ratio, 4.0f * now.loss_sigma_ratio);
    TEST_ASSERT_TRUE(now.loss_sigma_ratio < 0.02f);
    TEST_ASSERT_UINT32_WITHIN(20u, drift.steps - steps_before, now.since_steps); /* when the change began */
    rounds(12); /* by now the estimates have taken up much of it */
    ASSERT_CLOSE(0.1, report().loss_ratio, 0.015);
}

static void test_a_tenth_of_the_femurs_stiffness_lost_is_reported(void)
{
    check_loss(BRACE_FEMUR, BRACE_DRIFT_FEMUR);
}

static void test_a_tenth_of_the_tibias_stiffness_lost_is_reported(void)
{
    check_loss(BRACE_TIBIA, BRACE_DRIFT_TIBIA_OR_KNEE);
}

static void test_a_spring_that_goes_soft_is_not_taken_for_the_femur(void)
{
    learn_a_slightly_other_limb();
    real.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 1.1f;
    rounds(2);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, report().state);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_FEMUR_JOINT_OR_BASE, report().cause);
}

static void test_an_alarm_stays_until_reset(void)
{
    learn_a_slightly_other_limb();
    const brace_limb_t sound = real;
    real.link[BRACE_FEMUR].bending_mm_per_n *= 1.3f;
    rounds(1);
    real = sound;
    rounds(1);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, report().state);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_reset(&drift));
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, report().state);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, report().evidence);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_UNEXPLAINED, report().cause); /* nothing to explain is left */
}

static void test_one_wild_reading_is_no_alarm(void)
{
    learn_a_slightly_other_limb();
    const brace_stiffness_t model = stiffness_of(&believed, postures[STRETCHED]);
    run(STRETCHED, 0);
    const brace_drift_reading_t wild = {
        postures[STRETCHED][0], postures[STRETCHED][1], 31.0f, -20.0f, -140.0f, 120.0f, 0.0f};
    const int outliers = drift.outliers;
    float before[6];
    memcpy(before, drift.offset, sizeof before);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &wild));
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
    TEST_ASSERT_EQUAL_MEMORY(before, drift.offset, sizeof before);
    TEST_ASSERT_EQUAL(2, drift.outliers - outliers);
    rounds(1);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
}

static void test_scatter_beyond_the_noise_is_told_apart(void)
{
    learn_a_slightly_other_limb();
    const brace_stiffness_t model = stiffness_of(&believed, postures[0]), k = stiffness_of(&real, postures[0]);
    brace_drift_run(&drift);
    for (int i = 0; i < 60 && drift.state == BRACE_DRIFT_WATCHING; i++) {
        const float d = (float)(i % 5 - 2), off = noise_uniform() < 0.5 ? 0.4f : -0.4f;
        const brace_drift_reading_t reading = {postures[0][0],
                                               postures[0][1],
                                               d,
                                               0,
                                               k.k_xx_n_per_mm * d + off,
                                               k.k_xz_n_per_mm * d + (noise_uniform() < 0.5 ? 0.4f : -0.4f),
                                               0};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
    }
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, report().state);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_UNEXPLAINED, report().cause);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, report().loss_ratio);
}

static void test_a_baseline_that_has_walked_away_is_an_alarm(void)
{
    learn_a_slightly_other_limb();
    drift.held[BRACE_DRIFT_FEMUR] -= 0.4f; /* as after a loss too slow for the evidence */
    run(0, 0);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, report().state);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_FEMUR, report().cause);
    ASSERT_CLOSE(0.4 / 1.4, report().loss_ratio, 0.05);
}

static void test_short_runs_count_the_noise_of_their_first_reading(void)
{
    learn_a_slightly_other_limb();
    const brace_stiffness_t model = stiffness_of(&believed, postures[0]);
    for (int i = 0; i < 800; i++) {
        const brace_drift_reading_t reading = {
            postures[0][0], postures[0][1], 0, 0, NOISE_N * (float)noise_normal(), NOISE_N * (float)noise_normal(), 0};
        if (i % 2 == 0) {
            brace_drift_run(&drift);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        TEST_ASSERT_TRUE(report().evidence < 12.0f);
    }
}

static void test_a_calibration_that_does_not_fit_shows_in_the_baseline(void)
{
    real.link[BRACE_FEMUR].bending_mm_per_n *= 1.6f; /* cracked before commissioning */
    rounds(6);
    TEST_ASSERT_TRUE(report().baseline_sigmas > 5.0f);
}

static void test_the_outlook_shows_where_a_loss_shows(void)
{
    learn_a_slightly_other_limb();
    brace_drift_outlook_t stretched, bent;
    for (int i = 0; i < 2; i++) {
        const float *posture = postures[i == 0 ? STRETCHED : 4];
        const brace_stiffness_t model = stiffness_of(&believed, posture);
        const brace_drift_reading_t like = {posture[0], posture[1], 1.5f, 0, 0, 0, 0};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_outlook(&drift, &believed, &model, &like, i == 0 ? &stretched : &bent));
    }
    TEST_ASSERT_LESS_THAN(30, stretched.steps_needed[BRACE_DRIFT_TIBIA_OR_KNEE]);
    TEST_ASSERT_LESS_OR_EQUAL(stretched.steps_needed[BRACE_DRIFT_TIBIA_OR_KNEE],
                              stretched.steps_needed[BRACE_DRIFT_FEMUR]);
    TEST_ASSERT_GREATER_THAN(60, bent.steps_needed[BRACE_DRIFT_TIBIA_OR_KNEE]);
    TEST_ASSERT_TRUE(bent.sigma_of_loss_ratio[BRACE_DRIFT_TIBIA_OR_KNEE] >
                     2.0f * stretched.sigma_of_loss_ratio[BRACE_DRIFT_TIBIA_OR_KNEE]);
}

/* A run ends by itself where its posture does, in either joint, and after 64 readings. */
static void test_a_run_is_of_one_posture_and_of_64_readings(void)
{
    const brace_stiffness_t model = stiffness_of(&believed, postures[0]);
    brace_drift_reading_t reading = {postures[0][0], postures[0][1], 1.0f, 0.0f, 4.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_run(&drift));
    for (int i = 1; i <= 70; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        TEST_ASSERT_EQUAL(i <= 64 ? i : i - 64, drift.run_count);
    }
    for (int joint = 0; joint < 2; joint++) {
        *(joint == 0 ? &reading.theta1_rad : &reading.theta2_rad) += 0.1f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        TEST_ASSERT_EQUAL(1, drift.run_count);
    }
}

/* However far off the sensor's zero and the tip were in the run before: the new run's mean does not know of it. */
static void test_a_run_knows_nothing_of_the_run_before(void)
{
    const brace_stiffness_t model = stiffness_of(&believed, postures[0]);
    brace_drift_t reported[2];
    for (int is_off = 0; is_off < 2; is_off++) {
        brace_drift_reading_t reading = {postures[0][0], postures[0][1], 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
        reading.dx_mm = reading.dz_mm = is_off != 0 ? 1e4f : 0.0f;
        reading.fx_n = reading.fz_n = is_off != 0 ? 1e6f : 0.0f;
        setUp();
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_run(&drift));
        for (int i = 0; i < 5; i++) {
            reading.dx_mm = 0.1f + 0.3f * (float)i, reading.dz_mm = 0.7f;
            reading.fx_n = 4.01f + 0.2f * (float)i, reading.fz_n = -3.03f;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        }
        reported[is_off] = drift;
    }
    TEST_ASSERT_EQUAL_MEMORY(reported[0].run_mean, reported[1].run_mean, sizeof reported[0].run_mean);
    TEST_ASSERT_EQUAL_MEMORY(reported[0].offset, reported[1].offset, sizeof reported[0].offset);
}

static void test_refused_calls_leave_everything_as_it_was(void)
{
    const brace_stiffness_t model = stiffness_of(&believed, postures[0]);
    const brace_drift_reading_t sound = {0.74f, 1.0f, 1.0f, 0, 4.0f, 0, 0};
    brace_drift_reading_t reading = sound;
    const brace_drift_t before = drift;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_step(NULL, &believed, &model, &sound));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_step(&drift, NULL, &model, &sound));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_step(&drift, &believed, NULL, &sound));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_step(&drift, &believed, &model, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_report(&drift, &believed, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_outlook(&drift, &believed, &model, &sound, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_reset(NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_learn(NULL, &believed, &setup));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_learn(&drift, &believed, NULL));
    brace_drift_outlook_t outlook;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_outlook(&drift, NULL, &model, &sound, &outlook));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_run(NULL));
    reading.fx_n = NAN;
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_drift_step(&drift, &believed, &model, &reading));
    reading.fx_n = INFINITY;
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_drift_step(&drift, &believed, &model, &reading));
    reading = sound;
    reading.dx_mm = 2e4f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &model, &reading));
    reading = sound;
    reading.theta2_rad = 8.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &model, &reading));
    float *const value[] = {&reading.theta1_rad, &reading.theta2_rad, &reading.dx_mm,      &reading.dz_mm,
                            &reading.fx_n,       &reading.fz_n,       &reading.warmer_degc};
    static const float beyond[] = {8.0f, 8.0f, 1.1e4f, 1.1e4f, 1.1e6f, 1.1e6f, 201.0f};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        reading = sound;
        *value[i] = -beyond[i];
        TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &model, &reading));
    }
    brace_drift_report_t report;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_report(NULL, &believed, &report));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_report(&drift, NULL, &report));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_drift_outlook(NULL, &believed, &model, &sound, &outlook));
    brace_stiffness_t broken = model;
    broken.lambda_max_n_per_mm = 2e12f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &broken, &sound));
    broken = model;
    broken.lambda_min_n_per_mm = -1.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &broken, &sound));
    brace_drift_setup_t wrong = setup;
    wrong.noise_n = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_learn(&drift, &believed, &wrong));
    wrong = setup;
    wrong.model_error_ratio = -0.001f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_learn(&drift, &believed, &wrong));
    wrong = setup;
    wrong.joint_compliance_trust_ratio = -0.001f;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_learn(&drift, &believed, &wrong));
    wrong = setup;
    wrong.joint_compliance_trust_ratio = NAN;
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, brace_drift_learn(&drift, &believed, &wrong));
    brace_limb_t no_limb = believed;
    no_limb.femur_mm = 0.0f;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_drift_learn(&drift, &no_limb, &setup));
    TEST_ASSERT_EQUAL_MEMORY(&before, &drift, sizeof drift);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_state_stays_small);
    RUN_TEST(test_a_limb_within_its_calibration_is_learned_and_raises_no_alarm);
    RUN_TEST(test_learning_begins_with_the_trust_of_the_calibration);
    RUN_TEST(test_trust_in_each_number_of_the_calibration);
    RUN_TEST(test_estimates_narrow_and_begin_anew_once);
    RUN_TEST(test_a_report_names_what_the_readings_support);
    RUN_TEST(test_readings_are_counted_since_the_evidence_left_zero);
    RUN_TEST(test_watching_begins_without_evidence);
    RUN_TEST(test_readings_that_fit_are_no_evidence);
    RUN_TEST(test_what_the_model_may_be_off_is_no_evidence);
    RUN_TEST(test_a_tenth_of_the_femurs_stiffness_lost_is_reported);
    RUN_TEST(test_a_tenth_of_the_tibias_stiffness_lost_is_reported);
    RUN_TEST(test_a_spring_that_goes_soft_is_not_taken_for_the_femur);
    RUN_TEST(test_an_alarm_stays_until_reset);
    RUN_TEST(test_one_wild_reading_is_no_alarm);
    RUN_TEST(test_scatter_beyond_the_noise_is_told_apart);
    RUN_TEST(test_a_baseline_that_has_walked_away_is_an_alarm);
    RUN_TEST(test_short_runs_count_the_noise_of_their_first_reading);
    RUN_TEST(test_a_calibration_that_does_not_fit_shows_in_the_baseline);
    RUN_TEST(test_the_outlook_shows_where_a_loss_shows);
    RUN_TEST(test_a_run_is_of_one_posture_and_of_64_readings);
    RUN_TEST(test_a_run_knows_nothing_of_the_run_before);
    RUN_TEST(test_refused_calls_leave_everything_as_it_was);
    return UNITY_END();
}
