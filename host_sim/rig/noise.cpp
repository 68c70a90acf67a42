#include "rig/noise.h"

#include <cmath>

namespace brace::rig {

std::uint64_t Noise::bits()
{
    // Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014.
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

double Noise::uniform()
{
    return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
}

double Noise::normal()
{
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 6.283185307179586 * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
}

std::uint64_t Noise::below(std::uint64_t count)
{
    // Counts here are thousands at most: the modulo's bias is below 1e-15.
    return bits() % count;
}

} // namespace brace::rig
