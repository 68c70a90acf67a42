// Every effect there is.
#pragma once

#include <cstddef>

#include "effects/effect.h"

namespace brace::effects {

std::size_t count();

// Null beyond the last.
const Entry *at(std::size_t index);

// A limb with none of them: rigid, and an honest sensor.
Model without_any();

} // namespace brace::effects
