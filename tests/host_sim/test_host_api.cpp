// The C interface: every refusal leaves outputs alone; columns that nobody wants are not written.
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

extern "C" {
#include "api/brace_host.h"
#include "unity.h"
}

namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

brace_plant_model_t paper_limb()
{
    brace_plant_model_t model;
    brace_plant_model_default(&model);
    model.link[1].axial_mm_per_n = 0.001;
    model.link[1].bending_mm_per_n = 0.06;
    model.link[2].axial_mm_per_n = 0.002;
    model.link[2].bending_mm_per_n = 0.25;
    model.joint[1].compliance_rad_per_n_mm = 1.0e-5;
    model.joint[2].compliance_rad_per_n_mm = 1.6e-5;
    return model;
}

struct Rows {
    std::vector<int32_t> run{1, 1, 1};
    std::vector<double> theta1{1.0, 1.0, 1.0}, theta2{1.4, 1.4, 1.4}, t{0.0, 1.0, 2.0}, dx{0.0, 1.0, 2.0},
        dz{0.0, 0.0, 0.0};

    brace_loading_rows_t c() const
    {
        brace_loading_rows_t rows{};
        rows.small_displacements = 1;
        rows.count = run.size();
        rows.run = run.data();
        rows.theta1_rad = theta1.data();
        rows.theta2_rad = theta2.data();
        rows.t_s = t.data();
        rows.dx_mm = dx.data();
        rows.dz_mm = dz.data();
        return rows;
    }
};

int32_t played_untouched(const brace_plant_model_t &model, const brace_loading_rows_t &rows)
{
    double fx[3] = {7.0, 7.0, 7.0};
    brace_loading_reading_t reading{};
    reading.fx_n = fx;
    size_t unsolved = 77;
    const int32_t status = brace_plant_loading(&model, &rows, &reading, &unsolved);
    if (status != BRACE_HOST_OK) {
        for (const double each : fx) {
            TEST_ASSERT_EQUAL_DOUBLE(7.0, each);
        }
        TEST_ASSERT_EQUAL_size_t(77, unsolved);
    }
    return status;
}

} // namespace

void setUp(void) {}
void tearDown(void) {}

static void test_default_is_without_effect(void)
{
    brace_plant_model_t model;
    std::memset(&model, 0x5a, sizeof model);
    brace_plant_model_default(&model);
    TEST_ASSERT_NULL(brace_plant_model_fault(&model));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, model.sensor.gain);
    TEST_ASSERT_DOUBLE_IS_INF(model.sensor.saturation_n);
    TEST_ASSERT_DOUBLE_IS_INF(model.change.at_s);
    brace_plant_model_default(nullptr);
}

// The table of keys is generated with the struct; a static assertion there holds both to the same number of doubles.
static void test_keys_find_their_doubles(void)
{
    const brace_plant_model_t model = paper_limb();
    const struct {
        const char *key;
        const double *number;
    } some[] = {{"geometry.tibia_mm", &model.geometry.tibia_mm},
                {"link.femur.moment_transfer", &model.link[1].moment_transfer},
                {"joint.tibia.gap_rad", &model.joint[2].gap_rad},
                {"sensor.saturation_n", &model.sensor.saturation_n},
                {"change.link", &model.change.link_index},
                {"change.bending_factor", &model.change.bending_factor}};
    for (const auto &each : some) {
        const int64_t offset = brace_plant_key_offset(each.key);
        TEST_ASSERT_EQUAL_PTR(each.number, reinterpret_cast<const char *>(&model) + offset);
        // a value that nothing may have is a fault of that name
        brace_plant_model_t spoiled = model;
        std::memcpy(reinterpret_cast<char *>(&spoiled) + offset, &kNan, sizeof kNan);
        TEST_ASSERT_EQUAL_STRING(each.key, brace_plant_model_fault(&spoiled));
    }
    brace_plant_model_t no_link = model;
    no_link.change.link_index = 1.5;
    TEST_ASSERT_EQUAL_STRING("change.link", brace_plant_model_fault(&no_link));
    TEST_ASSERT_EQUAL_INT64(-1, brace_plant_key_offset("joint.femur.gap"));
    TEST_ASSERT_EQUAL_INT64(-1, brace_plant_key_offset("sensor.noise_n")); // a controller's, not the limb's
    TEST_ASSERT_EQUAL_INT64(-1, brace_plant_key_offset(nullptr));
}

static void test_loading_refuses(void)
{
    const brace_plant_model_t model = paper_limb();
    const Rows good;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, played_untouched(model, good.c()));

    Rows rows = good;
    rows.dz[2] = kNan;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NOT_FINITE, played_untouched(model, rows.c()));
    rows = good;
    rows.t[2] = 0.5;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_RANGE, played_untouched(model, rows.c()));
    brace_loading_rows_t without = good.c();
    without.run = nullptr;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NULL, played_untouched(model, without));

    brace_plant_model_t bad = model;
    bad.joint[1].gap_rad = -1e-3;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_PARAMETER, played_untouched(bad, good.c()));
    TEST_ASSERT_EQUAL_STRING("joint.femur.gap_rad", brace_plant_model_fault(&bad));

    // good rows first, then a pose in which this limb cannot yield along itself
    brace_plant_model_t springs;
    brace_plant_model_default(&springs);
    springs.joint[1].compliance_rad_per_n_mm = springs.joint[2].compliance_rad_per_n_mm = 1e-5;
    rows = good;
    rows.theta2[2] = 0.0;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, played_untouched(springs, good.c()));
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_SINGULAR, played_untouched(springs, rows.c()));

    brace_loading_reading_t nothing{};
    const brace_loading_rows_t c = good.c();
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, brace_plant_loading(&model, &c, &nothing, nullptr));
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NULL, brace_plant_loading(nullptr, &c, &nothing, nullptr));
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NULL, brace_plant_loading(&model, nullptr, &nothing, nullptr));
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NULL, brace_plant_loading(&model, &c, nullptr, nullptr));
}

// docs/physics.md, check values under load: the displacement that 10 N upwards make at (0.3, 0.6). At small
// displacements the same one takes another force.
static void test_finite_displacements(void)
{
    brace_plant_model_t model = paper_limb();
    Rows rows;
    rows.theta1 = {0.3, 0.3, 0.3};
    rows.theta2 = {0.6, 0.6, 0.6};
    rows.dx = {0.0, 5.05100, 5.05100};
    rows.dz = {0.0, 40.91618, 40.91618};
    brace_loading_rows_t c = rows.c();
    double fx[3], fz[3];
    brace_loading_reading_t reading{};
    reading.fx_n = fx;
    reading.fz_n = fz;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, brace_plant_loading(&model, &c, &reading, nullptr));
    TEST_ASSERT_TRUE(std::fabs(fz[1] - 10.0) > 0.1);
    c.small_displacements = 0;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, brace_plant_loading(&model, &c, &reading, nullptr));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, std::hypot(fx[0], fz[0]));
    for (const int row : {1, 2}) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.0, fx[row]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 10.0, fz[row]);
    }

    // Out of reach of rigid links: the row is counted, and the others stand.
    for (brace_plant_link_t &link : model.link) {
        link.axial_mm_per_n = link.bending_mm_per_n = 0.0;
    }
    rows.dx = {0.0, 3000.0, 1.0};
    rows.dz = {0.0, 0.0, 1.0};
    c = rows.c();
    c.small_displacements = 0;
    size_t unsolved = 0;
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_NO_CONVERGENCE, brace_plant_loading(&model, &c, &reading, &unsolved));
    TEST_ASSERT_EQUAL_size_t(1, unsolved);
    TEST_ASSERT_TRUE(std::isfinite(fx[1]) && std::isfinite(fz[1]));
}

static void test_empty_record_is_played(void)
{
    const brace_plant_model_t model = paper_limb();
    Rows rows;
    brace_loading_rows_t c = rows.c();
    c.count = 0;
    brace_loading_reading_t reading{};
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, brace_plant_loading(&model, &c, &reading, nullptr));
}

// Each model of a batch reads as if played alone; a refused one leaves NaN and the others stand.
static void test_many_models(void)
{
    brace_plant_model_t models[3] = {paper_limb(), paper_limb(), paper_limb()};
    models[1].sensor.gain = kNan;
    models[2].joint[2].gap_rad = 0.001;
    const Rows rows;
    const brace_loading_rows_t c = rows.c();
    double fx[9], fz[9];
    brace_loading_reading_t whole{};
    whole.fx_n = fx;
    whole.fz_n = fz;
    int32_t status[3];
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_PARAMETER, brace_plant_loading_many(models, 3, &c, &whole, status));
    for (int m = 0; m < 3; ++m) {
        double alone[3];
        brace_loading_reading_t reading{};
        reading.fz_n = alone;
        TEST_ASSERT_EQUAL_INT32(status[m], brace_plant_loading(&models[m], &c, &reading, nullptr));
        for (int i = 0; i < 3; ++i) {
            if (m == 1) {
                TEST_ASSERT_DOUBLE_IS_NAN(fx[3 + i]);
                TEST_ASSERT_DOUBLE_IS_NAN(fz[3 + i]);
            } else {
                TEST_ASSERT_EQUAL_MEMORY(&alone[i], &fz[3 * m + i], sizeof(double));
            }
        }
    }
}

static void test_many_models_of_the_reference(void)
{
    brace_plant_model_t models[3] = {paper_limb(), paper_limb(), paper_limb()};
    models[1].geometry.femur_mm = kNan;
    models[2].link[2].bending_mm_per_n *= 2.0;
    const double theta1_rad[3][2] = {{1.0, 0.3}, {1.0, 0.3}, {0.9, -0.2}};
    const double theta2_rad[3][2] = {{1.4, 0.6}, {1.4, 0.6}, {1.5, 0.7}};
    double all[3][2][9], alone[2][9];
    int32_t status[3];
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_PARAMETER, brace_reference_planar_many(models, 3, 2, theta1_rad[0],
                                                                                theta2_rad[0], &all[0][0][0], status));
    for (int m = 0; m < 3; ++m) {
        TEST_ASSERT_EQUAL_INT32(status[m],
                                brace_reference_planar(&models[m], 2, theta1_rad[m], theta2_rad[m], &alone[0][0]));
        if (m == 1) {
            TEST_ASSERT_DOUBLE_IS_NAN(all[m][0][0]);
            TEST_ASSERT_DOUBLE_IS_NAN(all[m][1][8]);
        } else {
            TEST_ASSERT_EQUAL_MEMORY(alone, all[m], sizeof alone);
        }
    }
}

static void test_many_models_of_a_joint(void)
{
    brace_plant_model_t models[3] = {paper_limb(), paper_limb(), paper_limb()};
    models[1].joint[2].gap_rad = kNan;
    models[2].joint[2].gap_rad = 0.001;
    const double t_s[3] = {0.0, 0.1, 0.2}, angle_rad[3] = {0.0, 0.004, -0.002}, offset_n_mm[3] = {0.0, 0.0, 5.0};
    const double reversal_rad[3] = {0.0, 0.0, 0.0};
    brace_joint_rows_t rows{};
    rows.count = 3;
    rows.t_s = t_s;
    rows.input = angle_rad;
    rows.joint_index = 2;
    double all[3][3], alone[3];
    int32_t status[3];
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_E_PARAMETER,
                            brace_plant_joint_many(models, 3, &rows, reversal_rad, offset_n_mm, &all[0][0], status));
    for (int m = 0; m < 3; ++m) {
        TEST_ASSERT_EQUAL_INT32(status[m], brace_plant_joint(&models[m], &rows, alone));
        for (int i = 0; i < 3; ++i) {
            if (m == 1) {
                TEST_ASSERT_DOUBLE_IS_NAN(all[m][i]);
            } else {
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, alone[i] + offset_n_mm[m], all[m][i]);
            }
        }
    }
}

static void test_every_status_has_words(void)
{
    const char *const unknown = brace_host_status_text(-99);
    for (const int32_t status : {0, -1, -2, -3, -4, -5, -6, -9}) {
        TEST_ASSERT_TRUE(std::strcmp(unknown, brace_host_status_text(status)) != 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_default_is_without_effect);
    RUN_TEST(test_keys_find_their_doubles);
    RUN_TEST(test_loading_refuses);
    RUN_TEST(test_empty_record_is_played);
    RUN_TEST(test_finite_displacements);
    RUN_TEST(test_many_models);
    RUN_TEST(test_many_models_of_the_reference);
    RUN_TEST(test_many_models_of_a_joint);
    RUN_TEST(test_every_status_has_words);
    return UNITY_END();
}
