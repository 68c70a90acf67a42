#include "plant/joint_test.h"

#include <algorithm>

#include "effects/coulomb_friction.h"
#include "effects/creep.h"
#include "effects/joint_zero_offset.h"
#include "effects/limb_now.h"
#include "plant/joint_law.h"

namespace brace::plant {
namespace {

using effects::Model;

struct JointState {
    double instant_rad = 0.0; // deflection without creep
    double delayed_rad = 0.0; // creep
    double friction_share = 0.0; // share of the largest torque that friction holds, [-1, 1]
};

double torque_at(const JointLaw &law, double deflection_rad, double reversal_rad, JointState &state)
{
    const double before = state.instant_rad;
    state.instant_rad = deflection_rad - state.delayed_rad;
    state.friction_share =
        effects::coulomb_friction::turned_share(state.friction_share, state.instant_rad - before, reversal_rad);
    const double spring = spring_torque_n_mm(law, state.instant_rad);
    return spring + state.friction_share * effects::coulomb_friction::most_n_mm(law, spring);
}

// How far friction is strained where a test starts at this torque: friction carries what the spring does not carry.
double start_share(const JointLaw &law, double deflection_rad, double torque_n_mm)
{
    const double most = friction_n_mm(law, deflection_rad);
    const double held = torque_n_mm - spring_torque_n_mm(law, deflection_rad);
    return most > 0.0 ? std::clamp(held / most, -1.0, 1.0) : 0.0;
}

// The smallest and the largest deflection, backlash included, at which the spring carries this torque.
double least_deflection(const JointLaw &law, double torque_n_mm)
{
    return effects::backlash::least_rad(law, elastic_under_torque_rad(law, torque_n_mm), torque_n_mm);
}

double most_deflection(const JointLaw &law, double torque_n_mm)
{
    return effects::backlash::most_rad(law, elastic_under_torque_rad(law, torque_n_mm), torque_n_mm);
}

// Friction lets the deflection stay anywhere between those that the torque minus friction and the torque plus friction
// would cause.
double deflection_under(const JointLaw &law, double torque_n_mm, JointState &state)
{
    const auto spring_n_mm = [&](double sense) {
        return effects::coulomb_friction::spring_while_moving_n_mm(law, torque_n_mm, sense);
    };
    state.instant_rad =
        std::clamp(state.instant_rad, least_deflection(law, spring_n_mm(1.0)), most_deflection(law, spring_n_mm(-1.0)));
    return state.instant_rad + state.delayed_rad;
}

} // namespace

void play_joint(const Model &model, const brace_joint_rows_t &rows, const JointReading &reading, double *out)
{
    const double offset = effects::joint_zero_offset::true_angle_rad(model, rows.joint_index, 0.0);
    const bool creeps = effects::creep::acts(model); // or the delayed part stays 0
    const bool changes = effects::Changes::act(model);
    JointState state;
    JointLaw law{};
    for (std::size_t i = 0; i < rows.count; ++i) {
        const bool starts = i == 0 || (rows.test != nullptr && rows.test[i] != rows.test[i - 1]);
        if (starts) {
            state = {};
        } else if (creeps) {
            const double approach = effects::creep::approach(model, rows.t_s[i] - rows.t_s[i - 1]);
            state.delayed_rad =
                effects::creep::delayed_rad(model, state.delayed_rad, elastic_rad(law, state.instant_rad), approach);
        }
        if (i == 0 || changes) {
            const double temp_degc = rows.temp_degc != nullptr ? rows.temp_degc[i] : model.thermal.reference_degc;
            law = effects::joint_now(model, {rows.t_s[i], temp_degc}, rows.joint_index);
        }
        if (rows.torque_imposed != 0) {
            out[i] = deflection_under(law, rows.input[i], state) - offset;
        } else {
            if (starts) {
                state.instant_rad = rows.input[i] + offset;
                state.friction_share =
                    rows.start_torque_n_mm == nullptr
                        ? 0.0 // relaxed
                        : start_share(law, state.instant_rad, rows.start_torque_n_mm[i] - reading.torque_offset_n_mm);
            }
            out[i] = torque_at(law, rows.input[i] + offset, reading.reversal_rad, state) + reading.torque_offset_n_mm;
        }
    }
}

} // namespace brace::plant
