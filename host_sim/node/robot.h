// The limbs of a node under one body: what moves them in a step of time, what happens to the body and when, and what is
// then true.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "node/body.h"
#include "node/limb_node.h"

extern "C" {
#include "api/brace_robot.h"
}

namespace brace::node {

class Robot {
public:
    using Limbs = std::vector<std::unique_ptr<LimbNode>>;

    // limbs: of the node that has this robot, too; each stands on its body (LimbNode::stand_on_body).
    Robot(const brace_robot_t &robot, const Limbs &limbs);
    Robot(const Robot &) = delete;
    Robot &operator=(const Robot &) = delete;

    void put_down(); // at the time 0
    void advance_to(std::uint64_t time_us); // body, motors and limbs; no controller

    void add_payload(double at_s, double factor, double ramp_s);
    void add_release(int limb, double at_s, double for_s);

    brace_robot_truth_t truth() const;
    int read_log(brace_robot_truth_t *rows, int most);

private:
    struct Payload {
        double at_s, factor, ramp_s;
    };
    struct Release {
        int limb;
        double at_s, end_s;
    };

    int count() const { return static_cast<int>(limbs_.size()); }
    void step(double t_s, double dt_s, double share);
    bool follow_payload(double t_s);
    bool follow_feet(double t_s);
    void watch(double dt_s, bool is_calm);
    void log();

    const Limbs &limbs_;
    Body body_;
    std::array<Pull, kMostFeet> pull_{};
    std::uint64_t now_us_ = 0, next_log_us_ = 0;

    std::vector<Payload> payload_; // by time
    std::size_t next_payload_ = 0;
    Payload current_{0.0, 0.0, 0.0};
    double factor_ = 0.0, from_factor_ = 0.0;
    std::vector<Release> release_;
    std::array<bool, kMostFeet> is_lost_{}, is_released_{};
    std::array<double, kMostFeet> unsolved_s_{};

    double calm_unbalanced_s_ = 0.0, last_unbalanced_ = 0.0; // how long it has not halved, and since which value
    double fallen_s_ = -1.0;
    std::array<Contact, kMostFeet> before_fall_{};
    std::vector<brace_robot_truth_t> log_; // a ring
    std::size_t log_begin_ = 0, log_count_ = 0;
};

} // namespace brace::node
