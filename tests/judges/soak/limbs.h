// The four limbs of the soak: what each controller believes, and the limb that is there.
#pragma once

#include <array>
#include <cstdint>
#include <random>

extern "C" {
#include "api/brace_node.h"
#include "brace/parameters.h"
}

namespace soak {

constexpr int kLimbs = 4;
constexpr int kFemur = 1, kTibia = 2;
constexpr double kTheta1_rad = 1.0, kTheta2_rad = 1.4; // where each limb stands when nobody moves it

using Chance = std::mt19937_64;

inline double real(Chance &chance, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(chance);
}

inline int whole(Chance &chance, int sides) // 0 to sides - 1
{
    return std::uniform_int_distribution<int>(0, sides - 1)(chance);
}

struct Limb {
    const char *name;
    brace_parameters_t believed;
    brace_node_limb_t there;
};

// [0] the paper's limb; [1] play in both joints; [2] beams for links, and weights; [3] in space. Each limb that is
// there differs from the believed one by as much as its controller's parameters say that they may be off: every length,
// zero and compliance by up to the square root of three of its sigma either way, so that its variance is that sigma's.
std::array<Limb, kLimbs> four_limbs(Chance &chance);

} // namespace soak
