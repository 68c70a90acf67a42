// Checks that every call makes on its inputs.
#pragma once

#include <cmath>
#include <cstddef>

extern "C" {
#include "api/brace_host.h"
}

namespace brace::api {

inline bool all_finite(const double *values, std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(values[i])) {
            return false;
        }
    }
    return true;
}

// A column that may be null.
inline bool all_finite_if_given(const double *values, std::size_t count)
{
    return values == nullptr || all_finite(values, count);
}

inline bool never_falls(const double *values, std::size_t count)
{
    for (std::size_t i = 1; i < count; ++i) {
        if (values[i] < values[i - 1]) {
            return false;
        }
    }
    return true;
}

brace_host_status_t check_loading_rows(const brace_loading_rows_t &rows);

} // namespace brace::api
