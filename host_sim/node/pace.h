// The wall clock's pace: sleeping until a time, and giving up what cannot be caught up with.
#pragma once

#include <cstdint>

namespace brace::node
{

class Pace
{
public:
    void start(std::uint64_t sim_us);

    // Returns when the wall clock has come to this time of the simulation, at once when it is past.
    void wait_for(std::uint64_t sim_us);

    std::uint32_t late_wakes() const { return late_wakes_; }
    std::uint64_t worst_late_us() const { return worst_late_us_; }
    std::uint64_t slipped_us() const { return slipped_us_; }

private:
    std::int64_t zero_us_ = 0; // wall clock at the simulation's 0
    std::uint32_t late_wakes_ = 0;
    std::uint64_t worst_late_us_ = 0, slipped_us_ = 0;
};

// No signal is delivered to this thread while it lives: they are for whoever waits for it.
class SignalsBlocked
{
public:
    SignalsBlocked();
    ~SignalsBlocked();

private:
    unsigned char before_[128]; // sigset_t
};

} // namespace brace::node
