// Repeatable noise: SplitMix64 for the bits, Box-Muller for the normal distribution. The standard library's
// distributions differ between implementations; these do not.
#pragma once

#include <cstdint>

namespace brace::rig {

class Noise {
public:
    explicit Noise(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits();
    double uniform();                         // (0, 1)
    double normal();                          // mean 0, sigma 1
    std::uint64_t below(std::uint64_t count); // [0, count)

private:
    std::uint64_t state_;
    double spare_ = 0.0;
    bool has_spare_ = false;
};

} // namespace brace::rig
