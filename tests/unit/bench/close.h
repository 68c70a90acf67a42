/* Assertions in double, whatever float support Unity was built with. */
#ifndef BRACE_TEST_CLOSE_H
#define BRACE_TEST_CLOSE_H

#include <math.h>

#include "unity.h"

/* |actual - expected| <= tolerance; NaN fails. */
#define ASSERT_CLOSE(expected, actual, tolerance) \
    do { \
        const double close_expected_ = (double)(expected), close_actual_ = (double)(actual); \
        if (!(fabs(close_actual_ - close_expected_) <= (double)(tolerance))) { \
            UnityPrint("expected "); \
            UnityPrintFloat((UNITY_DOUBLE)close_expected_); \
            UnityPrint(" was "); \
            UnityPrintFloat((UNITY_DOUBLE)close_actual_); \
            UnityPrint(" "); \
            TEST_FAIL_MESSAGE("further apart than " #tolerance); \
        } \
    } while (0)

#endif
