// Keeps pace with the wall clock: sleeps until a time, and gives up time that cannot be caught up.
#pragma once

#include <cstdint>

namespace brace::node {

class Pace {
public:
    void start(std::uint64_t sim_us);

    // Returns when the wall clock has reached this time of the simulation, or at once when that time is past.
    void wait_for(std::uint64_t sim_us);

    std::uint32_t late_wakes() const { return late_wakes_; }
    std::uint64_t worst_late_us() const { return worst_late_us_; }
    std::uint64_t slipped_us() const { return slipped_us_; }

private:
    std::int64_t zero_us_ = 0; // wall clock at the simulation's 0
    std::uint32_t late_wakes_ = 0;
    std::uint64_t worst_late_us_ = 0, slipped_us_ = 0;
};

// Blocks all signals in this thread while it lives, because another thread waits for them.
class SignalsBlocked {
public:
    SignalsBlocked();
    ~SignalsBlocked();

private:
    unsigned char before_[128]; // sigset_t
};

} // namespace brace::node
