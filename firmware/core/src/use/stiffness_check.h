/* May a K be divided by? */
#ifndef BRACE_CORE_STIFFNESS_CHECK_H
#define BRACE_CORE_STIFFNESS_CHECK_H

#include "brace/status.h"
#include "brace/stiffness.h"

/* Checks that all numbers are within their limits, and that the eigenvalues are positive and in order.
 * returns BRACE_OK, BRACE_E_NOT_FINITE, BRACE_E_RANGE */
brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness);

#endif
