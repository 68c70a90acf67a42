// The keys of limb.toml: where each value lies in the model, its range, and its value without any effect.
#pragma once

#include <cstdint>
#include <string_view>

#include "effects/effect.h"

namespace brace::plant {

// Byte offset of a key's double in the model; -1 for an unknown key.
std::int64_t key_offset(std::string_view key);

// Name of the first key whose value no limb can have; null when all are sound.
const char *first_fault(const effects::Model &model);

// A rigid limb of the paper's lengths with none of the effects, and a sensor that reads the true force.
effects::Model without_effects();

} // namespace brace::plant
