// What happens to a limb, at random: postures, contacts, faults, what the program around its controller asks for, power
// cuts. Twenty seconds of each minute are calm.
#pragma once

#include <cstdint>

#include "limbs.h"

namespace soak {

constexpr double kRound_s = 60.0, kCalm_s = 20.0;
constexpr double kSettle_s = 10.0; // of the calm, until the controller has to be in MONITOR again

class Trouble {
public:
    // One tick of a limb, before it. t_s: the simulation's time
    void step(brace_node_t *node, int limb, double t_s, Chance &chance);

    bool is_calm(double t_s) const; // nothing new happens
    bool is_settled(double t_s) const; // and nothing has for kSettle_s
    bool lies(double t_s) const { return t_s < lies_until_s_; } // a sensor reports what is not so, or did just now
    bool is_near(double t_s) const { return t_s < near_until_s_; } // something has just happened
    std::uint64_t events = 0, faults[BRACE_NODE_FAULT_COUNT] = {};

private:
    void happens(brace_node_t *node, int limb, double t_s, Chance &chance);
    void ask(brace_app_t *app, Chance &chance);
    void fault(brace_node_t *node, int limb, double t_s, Chance &chance);
    void calm_down(brace_node_t *node, int limb, double t_s);

    double lies_until_s_ = 0.0, near_until_s_ = 0.0, asks_at_s_ = 0.0;
    bool was_calm_ = false;
};

} // namespace soak
