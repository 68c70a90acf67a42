/* The drift check beside the same filter in double precision, with whole matrices, one reading at a time: what a
 * reading teaches, what evidence it is of, and what follows from that (docs/drift.md). */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "brace/chain.h"
#include "brace/drift.h"
#include "brace/kinematics.h"
#include "noise.h"
#include "sample_limbs.h"
#include "unity.h"
#include "use/drift_model.h"

enum { N = DRIFT_OFFSETS, CAUSES = BRACE_DRIFT_CAUSE_COUNT, RUN_MOST = 64, RUN = 12 };
#define NOISE_N 0.1

static const float postures[][2] = {{0.74f, 1.0f}, {1.51f, 2.23f}, {0.28f, 0.51f}, {2.15f, 2.69f}, {0.96f, 2.04f}};
static const brace_drift_setup_t setup = {(float)NOISE_N, 0.0005f, 0.02f, 0.2f};

static brace_limb_t believed, real;
static brace_drift_t drift;

/* The state as the filter knows it. */
typedef struct {
    double offset[N], p[N][N], held[CAUSES], held_sigma[CAUSES], left[CAUSES][N];
    double evidence[CAUSES + 1], score[CAUSES], information[CAUSES], mean[4];
    uint32_t steps, since[CAUSES + 1], run_count, state, cause, outliers;
} filter_t;

static filter_t filter;
static double change[CAUSES], learned_to[CAUSES];
static int outliers_met, alarms_met, forgotten_met, learned_met;

void setUp(void)
{
    noise_state = 11;
    believed = sample_limb[SAMPLE_PAPER];
    real = believed;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_learn(&drift, &believed, &setup));
    const double share = (double)drift_compliances(&believed).tibia_share;
    for (int c = 0; c < CAUSES; c++) {
        const double of_cause = c == BRACE_DRIFT_TIBIA_OR_KNEE ? share : 1.0;
        change[c] = 0.08 * of_cause;
        learned_to[c] = (double)BRACE_DRIFT_LEARNED_TO * of_cause;
    }
}

void tearDown(void) {}

static void take_covariance(const brace_drift_t *from)
{
    for (int i = 0, at = 0; i < N; i++) {
        for (int j = i; j < N; j++, at++) {
            filter.p[i][j] = filter.p[j][i] = (double)from->covariance[at];
        }
    }
}

static void doubles_of(double *to, const float *from, int count)
{
    for (int i = 0; i < count; i++) {
        to[i] = (double)from[i];
    }
}

static void begin_with(const brace_drift_t *from)
{
    memset(&filter, 0, sizeof filter);
    take_covariance(from);
    doubles_of(filter.offset, from->offset, N);
    doubles_of(filter.held, from->held, CAUSES);
    doubles_of(filter.held_sigma, from->held_sigma, CAUSES);
    doubles_of(filter.evidence, from->evidence, CAUSES + 1);
    doubles_of(filter.score, from->score, CAUSES);
    doubles_of(filter.information, from->information, CAUSES);
    doubles_of(filter.mean, from->run_mean, 4);
    for (int c = 0; c < CAUSES; c++) {
        doubles_of(filter.left[c], from->left[c], N);
    }
    for (int c = 0; c <= CAUSES; c++) {
        filter.since[c] = from->since[c];
    }
    filter.steps = from->steps, filter.run_count = from->run_count, filter.state = from->state;
    filter.cause = from->cause, filter.outliers = from->outliers;
}

/* ------------------------------------------------------------------------------------------ the filter -- */

static double product(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void count_evidence(const double *h, const double *gain, double off, double s, double bias, bool teaches)
{
    for (int c = 0; c < CAUSES; c++) {
        const double shows = product(h, filter.left[c]), step = shows * change[c];
        filter.evidence[c] += fmin((step * off - step * step / 2.0 - fabs(step) * bias) / s, 8.0);
        filter.score[c] += shows * off / s;
        filter.information[c] += shows * shows / s;
        for (int i = 0; i < N && teaches; i++) {
            filter.left[c][i] -= gain[i] * shows / s;
        }
    }
    const double beyond = fmax(fabs(off) - bias, 0.0);
    filter.evidence[CAUSES] += 0.375 * fmin(beyond * beyond / s, 8.0) - log(2.0);
}

/* One component of a reading. */
static void take(const double *h, double off, double noise, double bias, double learned[N])
{
    double gain[N], s = noise;
    for (int i = 0; i < N; i++) {
        gain[i] = product(filter.p[i], h);
    }
    s += product(h, gain);
    const bool is_held = filter.state != BRACE_DRIFT_LEARNING, is_outlier = is_held && fabs(off) > 6.0 * sqrt(s);
    if (is_held) {
        count_evidence(h, gain, off, s, bias, !is_outlier);
    }
    filter.outliers += is_outlier && filter.outliers < UINT8_MAX;
    outliers_met += is_outlier;
    for (int i = 0; i < N && !is_outlier; i++) {
        learned[i] += gain[i] * off / s;
        for (int j = 0; j < N; j++) {
            filter.p[i][j] -= gain[i] * gain[j] / s;
        }
    }
}

static void forget(int cause)
{
    for (int i = 0; i < N && cause < CAUSES; i++) {
        filter.left[cause][i] = i == cause;
    }
    if (cause < CAUSES) {
        filter.score[cause] = filter.information[cause] = 0.0;
    }
    filter.evidence[cause] = 0.0;
    filter.since[cause] = 0;
}

static void judge(void)
{
    for (int c = 0; c <= CAUSES; c++) {
        if (filter.state == BRACE_DRIFT_WATCHING && filter.evidence[c] >= 20.0) {
            filter.state = BRACE_DRIFT_DRIFTED;
            alarms_met++;
        }
        if (filter.state == BRACE_DRIFT_WATCHING && filter.evidence[c] <= 0.0) {
            forget(c);
            forgotten_met++;
        } else {
            filter.since[c] += filter.since[c] < UINT16_MAX;
        }
    }
    for (int c = 0; c < CAUSES; c++) {
        const double away = fabs(filter.offset[c] - filter.held[c]) - 1.25 * change[c];
        const double sigma = sqrt(filter.p[c][c] + filter.held_sigma[c] * filter.held_sigma[c]);
        if (filter.state == BRACE_DRIFT_WATCHING && away > 0.0 && away > 6.0 * sigma) {
            filter.state = BRACE_DRIFT_DRIFTED;
            filter.cause = (uint32_t)c;
        }
    }
}

static void hold_if_learned(void)
{
    const bool knows = sqrt(filter.p[0][0]) <= learned_to[0] && sqrt(filter.p[1][1]) <= learned_to[1];
    if (filter.steps < BRACE_DRIFT_LEARN_MOST && !(filter.steps >= BRACE_DRIFT_LEARN_LEAST && knows)) {
        return;
    }
    learned_met++;
    filter.state = BRACE_DRIFT_WATCHING;
    filter.cause = BRACE_DRIFT_UNEXPLAINED;
    for (int c = 0; c < CAUSES; c++) {
        filter.held[c] = filter.offset[c];
        filter.held_sigma[c] = sqrt(filter.p[c][c]);
    }
    for (int c = 0; c <= CAUSES; c++) {
        forget(c);
    }
}

static void filter_reading(const brace_stiffness_t *k, const brace_drift_reading_t *reading)
{
    static const double walk_rad = 3e-7, walk_rate = 1e-5;
    brace_drift_reading_t differs = *reading;
    float *const part[4] = {&differs.dx_mm, &differs.dz_mm, &differs.fx_n, &differs.fz_n};
    filter.steps++;
    if (filter.steps == BRACE_DRIFT_LEARN_LEAST && filter.state == BRACE_DRIFT_LEARNING) {
        brace_drift_t fresh;
        (void)brace_drift_learn(&fresh, &believed, &setup);
        take_covariance(&fresh);
    }
    filter.run_count = filter.run_count >= RUN_MOST ? 1u : filter.run_count + 1u;
    for (int i = 0; i < 4; i++) {
        const double value = (double)*part[i];
        *part[i] = (float)(value - filter.mean[i]);
        filter.mean[i] = filter.run_count == 1u ? value : filter.mean[i] + (value - filter.mean[i]) / filter.run_count;
    }
    if (filter.run_count == 1u) {
        return;
    }
    drift_expected_t expected;
    float offset[N];
    double learned[N] = {0}, h[2][N];
    for (int i = 0; i < N; i++) {
        offset[i] = (float)filter.offset[i];
    }
    drift_expect(&believed, k, &differs, offset, setup.joint_compliance_per_degc, &expected);
    doubles_of(h[0], expected.per_offset[0], N);
    doubles_of(h[1], expected.per_offset[1], N);
    const double noise = NOISE_N * NOISE_N * (1.0 + 1.0 / (filter.run_count - 1u));
    const double fx = (double)expected.force_n[0], fz = (double)expected.force_n[1];
    const double bias = 0.0005 * (fabs(fx) + fabs(fz));
    take(h[0], (double)differs.fx_n - fx, noise, bias + (double)expected.doubt_n[0], learned);
    take(h[1], (double)differs.fz_n - fz - product(h[1], learned), noise, bias + (double)expected.doubt_n[1], learned);
    for (int i = 0; i < N; i++) {
        const double walk = i < CAUSES ? 1e-4 * change[i] : i < DRIFT_THERMAL ? walk_rad : walk_rate;
        filter.offset[i] += learned[i];
        filter.p[i][i] += walk * walk;
    }
    if (filter.state == BRACE_DRIFT_LEARNING) {
        hold_if_learned();
    } else {
        judge();
    }
}

/* ------------------------------------------------------------------------------------------- the judge -- */

/* A float's rounding in one reading, beside what a number is known to. */
static void expect_state(const brace_drift_t *is)
{
    double sigma[N];
    TEST_ASSERT_EQUAL(filter.state, is->state);
    TEST_ASSERT_EQUAL(filter.cause, is->cause);
    TEST_ASSERT_EQUAL(filter.steps, is->steps);
    TEST_ASSERT_EQUAL(filter.run_count, is->run_count);
    TEST_ASSERT_EQUAL(filter.outliers, is->outliers);
    for (int i = 0; i < N; i++) {
        sigma[i] = sqrt((double)is->covariance[(int[]){0, 7, 13, 18, 22, 25, 27}[i]]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * sigma[i] + 1e-6 * fabs(filter.offset[i]), filter.offset[i], is->offset[i]);
    }
    for (int i = 0, at = 0; i < N; i++) {
        for (int j = i; j < N; j++, at++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * sigma[i] * sigma[j], filter.p[i][j], is->covariance[at]);
        }
    }
    for (int c = 0; c <= CAUSES; c++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, filter.evidence[c], is->evidence[c]);
        TEST_ASSERT_EQUAL(filter.since[c], is->since[c]);
    }
    for (int c = 0; c < CAUSES; c++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * sigma[c], filter.held[c], is->held[c]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * sigma[c], filter.held_sigma[c], is->held_sigma[c]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * fabs(filter.score[c]) + 1e-2, filter.score[c], is->score[c]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * filter.information[c], filter.information[c], is->information[c]);
        for (int i = 0; i < N; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-4 * (i == c ? 1.0 : sigma[i] / sigma[c]), filter.left[c][i], is->left[c][i]);
        }
    }
}

static brace_stiffness_t stiffness_of(const brace_limb_t *limb, int posture)
{
    brace_chain_t chain;
    brace_stiffness_t k;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_build(limb, &chain));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_chain_stiffness(&chain, postures[posture][0], postures[posture][1], &k));
    return k;
}

/* A run of the real limb, each reading by both. wild_n: what the last is off beside noise */
static void run(int posture, float wild_n)
{
    const float warmer_degc = (float)(posture - 2);
    brace_limb_t limb = real;
    for (int joint = BRACE_FEMUR; joint <= BRACE_TIBIA; joint++) {
        limb.joint[joint].compliance_rad_per_n_mm *= 1.0f + setup.joint_compliance_per_degc * warmer_degc;
    }
    const brace_stiffness_t model = stiffness_of(&believed, posture), k = stiffness_of(&limb, posture);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_run(&drift));
    for (int i = 0; i < RUN; i++) {
        const float dx = (float)(2.0 * noise_normal()), dz = (float)(2.0 * noise_normal());
        const float off_n = i == RUN - 1 ? wild_n : 0.0f;
        const brace_drift_reading_t reading = {
            postures[posture][0],
            postures[posture][1],
            30.0f + dx,
            dz - 20.0f,
            12.0f + k.k_xx_n_per_mm * dx + k.k_xz_n_per_mm * dz + (float)(NOISE_N * noise_normal()),
            off_n - 9.0f + k.k_xz_n_per_mm * dx + k.k_zz_n_per_mm * dz + (float)(NOISE_N * noise_normal()),
            warmer_degc};
        begin_with(&drift);
        filter_reading(&model, &reading);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &model, &reading));
        expect_state(&drift);
    }
}

static void test_it_learns_and_watches_as_the_filter_does(void)
{
    outliers_met = alarms_met = forgotten_met = learned_met = 0;
    real.link[BRACE_FEMUR].bending_mm_per_n *= 1.04f;
    for (int i = 0; i < 150 && learned_met == 0; i++) {
        run(i % 5, 0.0f);
    }
    TEST_ASSERT_EQUAL(1, learned_met);
    for (int i = 0; i < 40; i++) {
        run(i % 5, i % 4 == 0 ? 20.0f : 0.0f);
    }
    TEST_ASSERT_GREATER_THAN(5, outliers_met);
    TEST_ASSERT_GREATER_THAN(20, forgotten_met);
    TEST_ASSERT_EQUAL(0, alarms_met);
    real.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 1.3f;
    for (int i = 0; i < 40; i++) {
        run(i % 5, 0.0f);
    }
    TEST_ASSERT_EQUAL(1, alarms_met);
    TEST_ASSERT_EQUAL(BRACE_DRIFT_DRIFTED, drift.state);
}

/* Estimates that are known exactly wander all the same, each by its own step in a reading. */
static void test_what_is_known_wanders(void)
{
    const brace_stiffness_t k = stiffness_of(&believed, 0);
    memset(drift.covariance, 0, sizeof drift.covariance);
    for (int i = 0; i < 2; i++) {
        const brace_drift_reading_t reading = {postures[0][0], postures[0][1], 0.1f * (float)i, 0.2f, 1.0f, 2.0f, 1.0f};
        TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_step(&drift, &believed, &k, &reading));
    }
    for (int i = 0, at = 0; i < N; i++) {
        for (int j = i; j < N; j++, at++) {
            const double walk = i < CAUSES ? 1e-4 * change[i] : i < DRIFT_THERMAL ? 3e-7 : 1e-5;
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 * walk * walk, i == j ? walk * walk : 0.0, drift.covariance[at]);
        }
    }
}

/* Learning ends with the first reading behind its end that is compared with another. */
static void test_learning_has_an_end(void)
{
    for (uint32_t left = 1; left <= 2u; left++) { /* the first reading of a run has none before it */
        setUp();
        learned_met = 0;
        drift.steps = BRACE_DRIFT_LEARN_MOST - left;
        run(0, 0.0f);
        TEST_ASSERT_EQUAL(1, learned_met);
        TEST_ASSERT_EQUAL(BRACE_DRIFT_WATCHING, drift.state);
    }
}

/* The likeliest cause, how much of its link's or joint's stiffness is lost by what the readings say, and how sure that
 * is; the evidence is the largest of all. */
static void test_a_report_is_of_the_likeliest_cause(void)
{
    const double share[CAUSES] = {1.0, (double)drift_compliances(&believed).tibia_share, 1.0};
    for (int cause = 0; cause < CAUSES; cause++) {
        brace_drift_report_t reported;
        for (int c = 0; c < CAUSES; c++) {
            drift.evidence[c] = c == cause ? 30.0f : 15.0f;
            drift.score[c] = c == cause ? 90.0f : 4.0f;
            drift.information[c] = 100.0f + 10.0f * (float)c;
            drift.since[c] = (uint16_t)(7 + c);
        }
        for (int unexplained = 0; unexplained < 2; unexplained++) {
            drift.evidence[CAUSES] = unexplained != 0 ? 40.0f : 1.0f;
            TEST_ASSERT_EQUAL(BRACE_OK, brace_drift_report(&drift, &believed, &reported));
            TEST_ASSERT_EQUAL(cause, reported.cause);
            TEST_ASSERT_EQUAL_HEX32(1u << cause, reported.could_be);
            TEST_ASSERT_EQUAL_FLOAT(unexplained != 0 ? 40.0f : 30.0f, reported.evidence);
            TEST_ASSERT_EQUAL_UINT32(7 + cause, reported.since_steps);
            const double information = 100.0 + 10.0 * cause, size = 90.0 / information;
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, size / (share[cause] + size), reported.loss_ratio);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5 / share[cause], 1.0 / sqrt(information) / share[cause],
                                      reported.loss_sigma_ratio);
        }
    }
}

/* What a number of a setup or of a reading may be: from `least` to `most`, both taken. */
typedef struct {
    size_t at;
    float least, most;
} bound_t;

static brace_status_t learn(const void *bytes)
{
    brace_drift_setup_t asked;
    memcpy(&asked, bytes, sizeof asked);
    return brace_drift_learn(&drift, &believed, &asked);
}

static brace_status_t read(const void *bytes)
{
    brace_drift_reading_t asked;
    const brace_stiffness_t k = stiffness_of(&believed, 0);
    memcpy(&asked, bytes, sizeof asked);
    return brace_drift_step(&drift, &believed, &k, &asked);
}

static void expect_bounds(const bound_t *bounds, int count, const void *sound, size_t size,
                          brace_status_t (*asks)(const void *bytes))
{
    for (int i = 0; i < count; i++) {
        const float values[] = {
            bounds[i].least, bounds[i].most, nextafterf(bounds[i].least, -1e9f), nextafterf(bounds[i].most, 1e9f), NAN,
            INFINITY};
        for (int v = 0; v < 6; v++) {
            uint8_t bytes[64];
            memcpy(bytes, sound, size);
            memcpy(bytes + bounds[i].at, &values[v], sizeof values[v]);
            TEST_ASSERT_EQUAL_INT(v < 2 ? BRACE_OK : v < 4 ? BRACE_E_RANGE : BRACE_E_NOT_FINITE, asks(bytes));
        }
    }
}

static void test_each_number_of_a_setup_has_its_bounds(void)
{
    static const bound_t bounds[] = {{offsetof(brace_drift_setup_t, noise_n), 1e-45f, 1e6f},
                                     {offsetof(brace_drift_setup_t, model_error_ratio), 0.0f, 0.1f},
                                     {offsetof(brace_drift_setup_t, joint_compliance_per_degc), -0.1f, 0.1f},
                                     {offsetof(brace_drift_setup_t, joint_compliance_trust_ratio), 0.0f, 1.0f}};
    expect_bounds(bounds, 4, &setup, sizeof setup, learn);
}

static void test_each_number_of_a_reading_has_its_bounds(void)
{
    static const bound_t bounds[] = {
        {offsetof(brace_drift_reading_t, theta1_rad), -BRACE_ANGLE_LIMIT_RAD, BRACE_ANGLE_LIMIT_RAD},
        {offsetof(brace_drift_reading_t, theta2_rad), -BRACE_ANGLE_LIMIT_RAD, BRACE_ANGLE_LIMIT_RAD},
        {offsetof(brace_drift_reading_t, dx_mm), -1e4f, 1e4f},
        {offsetof(brace_drift_reading_t, dz_mm), -1e4f, 1e4f},
        {offsetof(brace_drift_reading_t, fx_n), -1e6f, 1e6f},
        {offsetof(brace_drift_reading_t, fz_n), -1e6f, 1e6f},
        {offsetof(brace_drift_reading_t, warmer_degc), -200.0f, 200.0f}};
    const brace_drift_reading_t sound = {postures[0][0], postures[0][1], 0.1f, 0.2f, 1.0f, 2.0f, 1.0f};
    expect_bounds(bounds, 7, &sound, sizeof sound, read);
}

/* K is taken as it is, also where its axes lie along x and z; what is no number is refused in it too. */
static void test_the_model_s_K_must_be_numbers(void)
{
    static const float xz[] = {0.0f, NAN, INFINITY, -INFINITY};
    const brace_drift_reading_t sound = {postures[0][0], postures[0][1], 0.1f, 0.2f, 1.0f, 2.0f, 1.0f};
    for (int i = 0; i < 4; i++) {
        brace_stiffness_t k = stiffness_of(&believed, 0);
        k.k_xz_n_per_mm = xz[i];
        TEST_ASSERT_EQUAL(i == 0 ? BRACE_OK : BRACE_E_NOT_FINITE, brace_drift_step(&drift, &believed, &k, &sound));
    }
}

/* Numbers far out of range are finite nevertheless, however many there are, and are refused as out of range. */
static void test_numbers_far_out_are_out_of_range(void)
{
    const float far = 1e30f;
    const brace_drift_reading_t reading = {far, far, far, far, far, far, far};
    brace_stiffness_t k = stiffness_of(&believed, 0);
    k.k_xz_n_per_mm = far;
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_drift_step(&drift, &believed, &k, &reading));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_learning_has_an_end);
    RUN_TEST(test_a_report_is_of_the_likeliest_cause);
    RUN_TEST(test_each_number_of_a_setup_has_its_bounds);
    RUN_TEST(test_each_number_of_a_reading_has_its_bounds);
    RUN_TEST(test_the_model_s_K_must_be_numbers);
    RUN_TEST(test_numbers_far_out_are_out_of_range);
    RUN_TEST(test_it_learns_and_watches_as_the_filter_does);
    RUN_TEST(test_what_is_known_wanders);
    return UNITY_END();
}
