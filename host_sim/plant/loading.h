// A loading record played on the limb, row by row.
#pragma once

#include <cstddef>

#include "effects/effect.h"

namespace brace::plant {

// Inputs must be sound (see api/loading.cpp). Writes every row it has room for.
// returns OK, E_SINGULAR (nothing written), E_NO_CONVERGENCE
brace_host_status_t play_loading(const effects::Model &model, const brace_loading_rows_t &rows,
                                 const brace_loading_reading_t &reading, std::size_t &unsolved_rows);

} // namespace brace::plant
