// What every effect's file offers: its law, how to switch it off, and where it may sit in a limb.
#pragma once

extern "C" {
#include "api/brace_host.h"
}

namespace brace::effects {

using Model = brace_plant_model_t;
using Entry = brace_effect_t;

inline constexpr int kCoxa = 0;
inline constexpr int kFemur = 1;
inline constexpr int kTibia = 2;

} // namespace brace::effects
