// What the laws of all effects share: the limb's numbers, and the indices of joints and links.
#pragma once

extern "C" {
#include "api/brace_host.h"
}

namespace brace::effects {

using Model = brace_plant_model_t;

inline constexpr int kCoxa = 0;
inline constexpr int kFemur = 1;
inline constexpr int kTibia = 2;

} // namespace brace::effects
