// What happens to a limb, and when: set-points, faults.
#pragma once

#include <array>
#include <vector>

extern "C" {
#include "api/brace_node.h"
}

namespace brace::node {

// Set-points that move from one posture to the next at the drives' rate.
class Setpoints {
public:
    void start(const std::array<double, 3> &theta_rad);
    void add(double at_s, const std::array<double, 3> &theta_rad); // NaN: that joint keeps its set-point
    void step(double t_s, double dt_s, const std::array<brace_node_drive_t, 3> &drive);
    const std::array<double, 3> &now_rad() const { return now_rad_; }
    bool is_moving() const { return now_rad_ != goal_rad_; }

private:
    struct Posture {
        double at_s;
        std::array<double, 3> theta_rad;
    };
    std::array<double, 3> now_rad_{}, goal_rad_{};
    std::vector<Posture> script_;
    std::size_t next_ = 0;
};

class Faults {
public:
    void add(int fault, int joint, double value, double at_s, double for_s);
    void step(double t_s);

    // The fault that is active now; null: none is active.
    const double *value(int fault, int joint = 0) const;
    bool is_on(int fault, int joint = 0) const { return value(fault, joint) != nullptr; }

private:
    struct Entry {
        int fault, joint;
        double value, at_s, end_s;
        bool on, is_past;
    };
    std::vector<Entry> entries_;
};

bool is_of_a_joint(int fault);

} // namespace brace::node
