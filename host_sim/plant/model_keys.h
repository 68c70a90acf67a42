// The keys of limb.toml: where each lives in the model and what it may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "effects/effect.h"

namespace brace::plant {

// Byte offset of a key's double in the model; -1 for none.
std::int64_t key_offset(std::string_view key);

// Name of the first key whose value no limb can have; null when all are sound.
const char *first_fault(const effects::Model &model);

} // namespace brace::plant
