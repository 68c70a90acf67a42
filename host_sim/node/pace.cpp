#include "node/pace.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <pthread.h>

namespace brace::node {
namespace {

constexpr std::int64_t kGiveUp_us = 50000;
constexpr std::int64_t kLate_us = 1000;

std::int64_t wall_us()
{
    timespec now{};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1000000 + now.tv_nsec / 1000;
}

} // namespace

void Pace::start(std::uint64_t sim_us)
{
    zero_us_ = wall_us() - static_cast<std::int64_t>(sim_us);
}

void Pace::wait_for(std::uint64_t sim_us)
{
    const std::int64_t due_us = zero_us_ + static_cast<std::int64_t>(sim_us);
    if (due_us > wall_us()) {
        const timespec until{static_cast<time_t>(due_us / 1000000), static_cast<long>(due_us % 1000000) * 1000};
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
        }
    }
    const std::int64_t late_us = std::max<std::int64_t>(wall_us() - due_us, 0);
    late_wakes_ += late_us > kLate_us;
    worst_late_us_ = std::max(worst_late_us_, static_cast<std::uint64_t>(late_us));
    if (late_us > kGiveUp_us) {
        zero_us_ += late_us;
        slipped_us_ += static_cast<std::uint64_t>(late_us);
    }
}

SignalsBlocked::SignalsBlocked()
{
    static_assert(sizeof(sigset_t) <= sizeof before_);
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_BLOCK, &all, &before);
    std::memcpy(before_, &before, sizeof before);
}

SignalsBlocked::~SignalsBlocked()
{
    sigset_t before;
    std::memcpy(&before, before_, sizeof before);
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

} // namespace brace::node
