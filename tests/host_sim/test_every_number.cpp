// Every number of limb.toml, one after another, whatever effect it belongs to: it moves a reading of a loading record,
// and the record as it is played, which takes what it has found earlier for what it needs now, reads the same as a limb
// that finds every row anew. An effect that the plant's short cuts do not know of fails here.
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

extern "C" {
#include "api/brace_host.h"
#include "unity.h"
}
#include "plant/joint_law.h"
#include "plant/limb_state.h"
#include "plant/model_key_table.h"
#include "plant/model_keys.h"
#include "plant/sensor.h"

void setUp(void) {}
void tearDown(void) {}

namespace {

using brace::effects::Model;
using brace::plant::Displacements;
using brace::plant::kModelKeys;
using brace::plant::ModelKey;
using Eigen::Vector2d;

constexpr double kMatters_n = 0.02;
constexpr double kSame_n = 2e-6; // what the asides below and the promised 1e-9 N of a rest may move, many times over
// The asides by which no two rows of the limb that finds all anew are the same. They grow with the row.
constexpr double kAside_mm = 1e-10, kAside_rad = 1e-12;

// What a limb in its plane does not have. The sideways lean of its weights is no such number: it shortens them.
bool is_out_of_plane(const std::string &key)
{
    for (const char *part : {"coxa", "lateral", "torsion"}) {
        if (key.find(part) != std::string::npos) {
            return true;
        }
    }
    return false;
}

// Two postures, along both axes, three times: again with other temperatures, and again in another time. Within a run
// the temperature changes, so that the tip comes back to a place with other joints.
struct Record {
    std::vector<std::int32_t> run;
    std::vector<double> theta1, theta2, t, temp, dx, dz;

    Record()
    {
        double now_s = 0.0;
        std::int32_t runs = 0;
        for (int time = 0; time < 3; ++time) {
            for (const double bend : {0.8, 1.4}) {
                for (int axis = 0; axis < 2; ++axis, ++runs) {
                    for (const double at_mm : {0.0, 0.8, 1.6, 0.8, 0.0, -0.8, -1.6, -0.8, 0.0}) {
                        run.push_back(runs);
                        theta1.push_back(0.5);
                        theta2.push_back(bend);
                        t.push_back(now_s);
                        temp.push_back(22.0 + 3.0 * time + 0.1 * now_s);
                        dx.push_back(axis == 0 ? at_mm : 0.0);
                        dz.push_back(axis == 1 ? at_mm : 0.0);
                        now_s += time < 2 ? 1.0 : 2.0;
                    }
                }
            }
        }
    }

    std::size_t count() const { return run.size(); }

    brace_loading_rows_t rows(Displacements displacements, bool creep_runs_on) const
    {
        brace_loading_rows_t rows{};
        rows.count = count();
        rows.small_displacements = displacements == Displacements::small ? 1 : 0;
        rows.creep_runs_on = creep_runs_on ? 1 : 0;
        rows.run = run.data();
        rows.theta1_rad = theta1.data();
        rows.theta2_rad = theta2.data();
        rows.t_s = t.data();
        rows.temp_degc = temp.data();
        rows.dx_mm = dx.data();
        rows.dz_mm = dz.data();
        return rows;
    }
};

const Record kRecord;

using Forces = std::vector<double>; // x and z of each row; empty: some row has no rest

// No two rows have the same posture or place, so nothing that was found for one serves another.
Forces found_anew(const Model &model, Displacements displacements, bool creep_runs_on)
{
    brace::plant::LimbState<brace::plant::InPlane> limb(model, displacements);
    const brace::plant::Sensor sensor(model);
    Forces read;
    for (std::size_t i = 0; i < kRecord.count(); ++i) {
        const double aside = static_cast<double>(i + 1);
        if (!limb.move_to(kRecord.theta1[i] + kAside_rad * aside, kRecord.theta2[i], {kRecord.t[i], kRecord.temp[i]})) {
            return {};
        }
        if (i == 0 || kRecord.run[i] != kRecord.run[i - 1]) {
            limb.start_run(!creep_runs_on);
        }
        const auto rest = limb.hold_tip({kRecord.dx[i] + kAside_mm * aside, kRecord.dz[i] + kAside_mm * aside});
        if (!rest.solved) {
            return {};
        }
        const Vector2d reading_n = sensor.reading_n(rest.force_n, kRecord.t[i]);
        read.insert(read.end(), {reading_n.x(), reading_n.y()});
    }
    return read;
}

// The records of several limbs, played by one player.
std::vector<Forces> played(const std::vector<Model> &models, Displacements displacements, bool creep_runs_on)
{
    const brace_loading_rows_t rows = kRecord.rows(displacements, creep_runs_on);
    std::vector<double> fx(models.size() * rows.count), fz(fx.size());
    brace_loading_reading_t reading{};
    reading.fx_n = fx.data();
    reading.fz_n = fz.data();
    TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK,
                            brace_plant_loading_many(models.data(), models.size(), &rows, &reading, nullptr));
    std::vector<Forces> read(models.size());
    for (std::size_t m = 0; m < models.size(); ++m) {
        for (std::size_t i = 0; i < rows.count; ++i) {
            read[m].insert(read[m].end(), {fx[m * rows.count + i], fz[m * rows.count + i]});
        }
    }
    return read;
}

double apart_n(const Forces &a, const Forces &b)
{
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::fmax(most, std::fabs(a[i] - b[i]));
    }
    return most;
}

Model with(Model model, const ModelKey &key, double value)
{
    std::memcpy(reinterpret_cast<char *>(&model) + key.offset, &value, sizeof value);
    return model;
}

double value_in(const Model &model, const ModelKey &key)
{
    double value;
    std::memcpy(&value, reinterpret_cast<const char *>(&model) + key.offset, sizeof value);
    return value;
}

Model paper_limb()
{
    Model model = brace::plant::without_effects();
    model.link[1].axial_mm_per_n = 0.001;
    model.link[1].bending_mm_per_n = 0.06;
    model.link[2].axial_mm_per_n = 0.002;
    model.link[2].bending_mm_per_n = 0.25;
    model.joint[1].compliance_rad_per_n_mm = 1.0e-5;
    model.joint[2].compliance_rad_per_n_mm = 1.6e-5;
    return model;
}

// Numbers that say something of an effect only where the effect is there.
Model with_all_that_others_need()
{
    Model model = paper_limb();
    for (const int joint : {1, 2}) {
        model.joint[joint].coulomb_n_mm = 20.0;
        model.joint[joint].coulomb_per_load_ratio = 0.2;
    }
    model.gravity.femur_n = model.gravity.tibia_n = 2.0;
    model.creep.ratio = 0.2;
    model.creep.time_constant_s = 5.0;
    model.thermal.joint_compliance_per_degc = 0.02;
    model.change.at_s = 20.0;
    model.change.link_index = 2.0;
    model.change.bending_factor = 1.3;
    return model;
}

// Values of a number, ever further from the one that the model has.
std::vector<double> values_of(const ModelKey &key, double from)
{
    std::vector<double> values;
    const auto add = [&](double value) {
        if (value >= key.least && value <= key.most && value != from) {
            values.push_back(value);
        }
    };
    if (key.whole) {
        for (double value = key.least; value <= key.most; value += 1.0) {
            add(value);
        }
    } else if (from == std::numeric_limits<double>::infinity()) {
        for (double value = 1e9; value > 1e-9; value /= 3.0) {
            add(value);
        }
    } else {
        for (double away = 1e-9; away < 1e15; away *= 3.0) {
            add(from + away);
            add(from - away);
        }
    }
    return values;
}

// The limb with the first value of a number that moves a reading; false: none does.
bool find_value_that_matters(const ModelKey &key, Model &model)
{
    for (const Model &limb : {paper_limb(), with_all_that_others_need()}) {
        const Forces without = found_anew(limb, Displacements::finite, false);
        for (const double value : values_of(key, value_in(limb, key))) {
            const Forces read = found_anew(with(limb, key, value), Displacements::finite, false);
            if (!read.empty() && apart_n(read, without) > kMatters_n) {
                model = with(limb, key, value);
                return true;
            }
        }
    }
    return false;
}

void check_playing(const ModelKey &key, const Model &model, Displacements displacements, bool creep_runs_on)
{
    // The player comes from another limb, goes to this one, and to one that has the number in another place.
    const Model half = with(model, key, 0.5 * (value_in(model, key) + value_in(paper_limb(), key)));
    std::vector<Model> models{paper_limb(), model};
    if (brace::plant::first_fault(half) == nullptr) {
        models.push_back(half);
    }
    const std::vector<Forces> read = played(models, displacements, creep_runs_on);
    for (std::size_t m = 0; m < models.size(); ++m) {
        const Forces anew = found_anew(models[m], displacements, creep_runs_on);
        const std::string where = std::string(key.name) + ", limb " + std::to_string(m);
        TEST_ASSERT_FALSE_MESSAGE(anew.empty(), where.c_str());
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(kSame_n, 0.0, apart_n(read[m], anew), where.c_str());
    }
}

// A joint whose law calls itself linear is a spring, and an imposed torque leads to where the spring carries it.
void check_joint(const ModelKey &key, const Model &model)
{
    for (const int joint : {1, 2}) {
        const brace::plant::JointLaw law = brace::effects::joint_now(model, {30.0, 25.0}, joint);
        if (brace::plant::is_linear(law)) {
            for (const double deflection_rad : {-0.01, -1e-3, 1e-3, 0.01}) {
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
                    1e-12 * std::fabs(deflection_rad), deflection_rad,
                    law.compliance_rad_per_n_mm * brace::plant::spring_torque_n_mm(law, deflection_rad), key.name);
            }
        }
        for (const double deflection_rad : {-0.05, -0.02, 0.02, 0.05}) {
            const double step_rad = 1e-5;
            const double slope = (brace::plant::spring_torque_n_mm(law, deflection_rad + step_rad) -
                                  brace::plant::spring_torque_n_mm(law, deflection_rad - step_rad)) /
                                 (2.0 * step_rad);
            const double stiffness = brace::plant::spring_stiffness_n_mm_per_rad(law, deflection_rad);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4 * slope, slope, stiffness, key.name);
        }
        const double t_s = 30.0, temp_degc = 25.0;
        for (const double torque_n_mm : {-800.0, -50.0, 50.0, 800.0}) {
            brace_joint_rows_t rows{};
            rows.count = 1;
            rows.joint_index = joint;
            rows.torque_imposed = 1;
            rows.t_s = &t_s;
            rows.temp_degc = &temp_degc;
            rows.input = &torque_n_mm;
            double angle_rad = 0.0;
            TEST_ASSERT_EQUAL_INT32(BRACE_HOST_OK, brace_plant_joint(&model, &rows, &angle_rad));
            const double deflection_rad = angle_rad + model.joint[joint].zero_offset_rad;
            const double held_n_mm = brace::plant::friction_n_mm(law, deflection_rad);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(held_n_mm + 1e-9 * std::fabs(torque_n_mm), torque_n_mm,
                                              brace::plant::spring_torque_n_mm(law, deflection_rad), key.name);
        }
    }
}

} // namespace

static void test_every_number_acts_and_is_played_as_it_is_found_anew(void)
{
    for (const ModelKey &key : kModelKeys) {
        Model model;
        const bool matters = find_value_that_matters(key, model);
        if (is_out_of_plane(key.name)) {
            TEST_ASSERT_FALSE_MESSAGE(matters, key.name);
            continue;
        }
        TEST_ASSERT_TRUE_MESSAGE(matters, key.name);
        for (const Displacements displacements : {Displacements::finite, Displacements::small}) {
            check_playing(key, model, displacements, false);
        }
        check_playing(key, model, Displacements::finite, true);
        check_joint(key, model);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_number_acts_and_is_played_as_it_is_found_anew);
    return UNITY_END();
}
