#include "trouble.h"

#include <algorithm>
#include <cmath>

namespace soak {
namespace {

constexpr double kMeanPause_s = 1.5;  // between two events of a limb
constexpr double kLongestFault_s = 2.0;
constexpr double kLieLasts_s = 0.5;   // filters forget it, and what was reported wrong is seen
constexpr double kNear_s = 0.05;

bool is_lie(int fault)
{
    return fault == BRACE_NODE_FAULT_ENCODER_STUCK || fault == BRACE_NODE_FAULT_CURRENT_OFFSET ||
           fault == BRACE_NODE_FAULT_FORCE_OFFSET;
}

bool is_of_a_joint(int fault)
{
    return fault <= BRACE_NODE_FAULT_CURRENT_OFFSET;
}

// A set is stored again: as docs/errors.md says, only that ends a fault STORE.
void store_again(brace_app_t *app)
{
    if (brace_app_configuration_enter(app) == BRACE_OK) {
        const brace_parameters_t same = *brace_app_parameters(app);
        (void)brace_app_parameters_commit(app, &same);
    }
}

} // namespace

bool Trouble::is_calm(double t_s) const
{
    return std::fmod(t_s, kRound_s) >= kRound_s - kCalm_s;
}

bool Trouble::is_settled(double t_s) const
{
    return std::fmod(t_s, kRound_s) >= kRound_s - kCalm_s + kSettle_s;
}

void Trouble::step(brace_node_t *node, int limb, double t_s, Chance &chance)
{
    const bool is_calm_now = is_calm(t_s);
    if (is_calm_now) {
        if (!was_calm_ || t_s >= asks_at_s_) {
            calm_down(node, limb, t_s);
            asks_at_s_ = t_s + 0.5;
        }
    } else if (real(chance, 0.0, 1.0) < 1e-3 / kMeanPause_s) {
        happens(node, limb, t_s, chance);
        near_until_s_ = t_s + kNear_s;
        ++events;
    }
    was_calm_ = is_calm_now;
}

// All is taken back that somebody has asked for; what ends by hand is ended.
void Trouble::calm_down(brace_node_t *node, int limb, double t_s)
{
    brace_app_t *app = brace_node_app(node, limb);
    if (!was_calm_) {
        const brace_node_press_t press = {0.5, 0.0, 1.0};
        (void)brace_node_contact(node, limb, 20.0, &press);
        (void)brace_node_posture(node, limb, t_s, kTheta1_rad, kTheta2_rad);
    }
    if (std::fmod(t_s, kRound_s) < kRound_s - kCalm_s + kSettle_s - 3.0) {
        (void)brace_app_let_go(app);
        const std::uint32_t there = brace_app_faults(app);
        if ((there & BRACE_FAULT_STORE) != 0u) {
            store_again(app);
        } else {
            (void)brace_app_configuration_leave(app);
        }
        const std::uint32_t by_hand = BRACE_FAULT_CRASHED | BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_ENCODER_STUCK |
                                      BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR | BRACE_FAULT_JUMP_TIBIA;
        (void)brace_app_clear(app, there & by_hand);
    }
}

void Trouble::happens(brace_node_t *node, int limb, double t_s, Chance &chance)
{
    switch (whole(chance, 10)) {
    case 0:
    case 1:
        (void)brace_node_posture(node, limb, t_s, kTheta1_rad + real(chance, -0.04, 0.04),
                                 kTheta2_rad + real(chance, -0.04, 0.04));
        break;
    case 2:
    case 3: {
        constexpr double kHolds_n_per_mm[] = {INFINITY, 20.0, 5.0, 0.0};
        const brace_node_press_t press = {real(chance, -4.0, 4.0), real(chance, -4.0, 4.0), real(chance, -4.0, 4.0)};
        (void)brace_node_contact(node, limb, kHolds_n_per_mm[whole(chance, 4)], &press);
        break;
    }
    case 4:
    case 5:
    case 6: fault(node, limb, t_s, chance); break;
    case 7:
        if (whole(chance, 5) == 0) {
            (void)brace_node_restart(node, limb);
        }
        break;
    default: ask(brace_node_app(node, limb), chance); break;
    }
}

void Trouble::fault(brace_node_t *node, int limb, double t_s, Chance &chance)
{
    const int kind = whole(chance, BRACE_NODE_FAULT_COUNT);
    const double lasts_s = real(chance, 0.02, kLongestFault_s);
    const double sign = whole(chance, 2) == 0 ? 1.0 : -1.0;
    double value = 0.0;
    switch (kind) {
    case BRACE_NODE_FAULT_CURRENT_OFFSET: value = sign * real(chance, 50.0, 2000.0); break;
    case BRACE_NODE_FAULT_FORCE_OFFSET: value = sign * real(chance, 0.5, 20.0); break;
    case BRACE_NODE_FAULT_TICK_LATE: value = real(chance, 2.0, 30.0); break;
    default: break;
    }
    const int joint = is_of_a_joint(kind) ? kFemur + whole(chance, 2) : 0;
    if (brace_node_fault(node, limb, kind, joint, value, t_s, lasts_s) != 0) {
        return;
    }
    ++faults[kind];
    if (is_lie(kind)) {
        lies_until_s_ = std::max(lies_until_s_, t_s + lasts_s + kLieLasts_s);
    }
}

void Trouble::ask(brace_app_t *app, Chance &chance)
{
    brace_loading_setup_t setup{};
    switch (whole(chance, 9)) {
    case 0:
    case 1: (void)brace_app_take_up(app, kFemur + whole(chance, 2), whole(chance, 2) == 0 ? 1 : -1); break;
    case 2:
    case 3:
        setup.axis = whole(chance, 2) == 0 ? BRACE_AXIS_X : BRACE_AXIS_Z;
        setup.steps_per_side = 2;
        setup.step_mm = static_cast<float>(real(chance, 0.1, 1.0));
        setup.dwell_us = 100000;
        setup.rate_mm_per_s = 20.0f;
        setup.force_max_n = 50.0f;
        setup.torque_max_n_mm = 8000.0f;
        setup.source = whole(chance, 2) == 0 ? BRACE_LOADING_ENCODED : BRACE_LOADING_COMMANDED;
        (void)brace_app_loading_start(app, &setup);
        break;
    case 4: (void)brace_app_loading_stop(app); break;
    case 5: (void)brace_app_let_go(app); break;
    case 6: (void)brace_app_stop(app); break;
    case 7:
        if (brace_app_configuration_enter(app) == BRACE_OK && whole(chance, 2) == 0) {
            store_again(app);
        }
        break;
    default: (void)brace_app_configuration_leave(app); break;
    }
}

} // namespace soak
