#include "node/script.h"

#include <algorithm>
#include <cmath>

namespace brace::node {

void Setpoints::start(const std::array<double, 3> &theta_rad)
{
    now_rad_ = goal_rad_ = theta_rad;
}

void Setpoints::add(double at_s, const std::array<double, 3> &theta_rad)
{
    if (!script_.empty()) {
        at_s = std::max(at_s, script_.back().at_s);
    }
    if (next_ == script_.size()) { // every entry is in the past: else the list grows for ever
        script_.clear();
        next_ = 0;
    }
    script_.push_back({at_s, theta_rad});
}

void Setpoints::step(double t_s, double dt_s, const std::array<brace_node_drive_t, 3> &drive)
{
    for (; next_ < script_.size() && script_[next_].at_s <= t_s; ++next_) {
        for (std::size_t i = 0; i < goal_rad_.size(); ++i) {
            const double goal = script_[next_].theta_rad[i];
            goal_rad_[i] = std::isnan(goal) ? goal_rad_[i] : goal;
        }
    }
    for (std::size_t i = 0; i < now_rad_.size(); ++i) {
        const double most = dt_s * drive[i].rate_rad_per_s, left = goal_rad_[i] - now_rad_[i];
        now_rad_[i] = std::fabs(left) <= most ? goal_rad_[i] : now_rad_[i] + std::copysign(most, left);
    }
}

bool is_of_a_joint(int fault)
{
    return (fault >= BRACE_NODE_FAULT_ENCODER_STUCK && fault <= BRACE_NODE_FAULT_CURRENT_OFFSET)
           || fault == BRACE_NODE_FAULT_JOINT_SOFT;
}

void Faults::add(int fault, int joint, double value, double at_s, double for_s)
{
    entries_.erase(std::remove_if(entries_.begin(), entries_.end(), [](const Entry &past) { return past.is_past; }),
                   entries_.end());
    entries_.push_back({fault, is_of_a_joint(fault) ? joint : 0, value, at_s, at_s + for_s, false, false});
}

void Faults::step(double t_s)
{
    for (Entry &entry : entries_) {
        entry.on = t_s >= entry.at_s && t_s < entry.end_s;
        entry.is_past = t_s >= entry.end_s;
    }
}

const double *Faults::value(int fault, int joint) const
{
    for (const Entry &entry : entries_) {
        if (entry.on && entry.fault == fault && entry.joint == joint) {
            return &entry.value;
        }
    }
    return nullptr;
}

} // namespace brace::node

extern "C" const char *brace_node_fault_name(int32_t fault)
{
    static const char *const name[BRACE_NODE_FAULT_COUNT] = {
        "encoder_stuck", "sensor_dead", "sensor_nan", "current_offset", "force_dead", "force_offset", "nvm_fails",
        "nvm_forgets",   "bus_off",     "tick_late",  "tip_lost",       "crash",      "joint_soft",
    };
    return fault >= 0 && fault < BRACE_NODE_FAULT_COUNT ? name[fault] : nullptr;
}
