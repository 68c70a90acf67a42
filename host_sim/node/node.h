// A node: its limbs, the body that they may carry, their bus, and their common time.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "node/limb_node.h"
#include "node/pace.h"
#include "node/robot.h"

struct brace_node {
    std::unique_ptr<brace_posix_bus_t> bus; // outlives the limbs on it
    std::vector<std::unique_ptr<brace::node::LimbNode>> limbs;
    std::unique_ptr<brace::node::Robot> robot; // the body that the limbs carry; null: each limb stands alone
    std::uint64_t now_us = 0;
    brace::node::Pace pace;
    std::mutex lock; // held while a tick is under way
    std::atomic<bool> stop{false};

    ~brace_node()
    {
        limbs.clear();
        if (bus) {
            brace_posix_bus_close(bus.get());
        }
    }

    brace::node::LimbNode *limb(std::int32_t index) const
    {
        return index >= 0 && index < static_cast<std::int32_t>(limbs.size())
                   ? limbs[static_cast<std::size_t>(index)].get()
                   : nullptr;
    }

    std::uint64_t next_us() const
    {
        std::uint64_t next = UINT64_MAX;
        for (const auto &limb : limbs) {
            next = std::min(next, limb->due_us());
        }
        return next;
    }

    void poll()
    {
        if (bus) {
            brace_posix_bus_poll(bus.get(), static_cast<std::uint32_t>(now_us));
        }
        for (const auto &limb : limbs) {
            limb->poll();
        }
    }

    // Runs all limbs that are due, and serves the outside before and after them. So an answer leaves with the tick that
    // made it.
    void advance_to(std::uint64_t time_us)
    {
        const std::lock_guard<std::mutex> held(lock);
        now_us = time_us;
        poll();
        if (robot) {
            robot->advance_to(time_us);
        }
        for (const auto &limb : limbs) {
            if (limb->due_us() <= time_us) {
                limb->tick(time_us);
            }
        }
        poll();
    }
};

namespace brace::node {

// Makes the node of brace_node_create and brace_robot_create; body: null, where each limb stands alone.
brace_node *make_node(const brace_node_limb_t *limbs, std::int32_t count, const brace_robot_t *body, const char *can,
                      std::uint64_t seed, brace_node_failure_t *failure);

bool in_range(double value, double low, double high);

} // namespace brace::node
