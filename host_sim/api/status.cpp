#include "api/checks.h"

extern "C" const char *brace_host_status_text(int32_t status)
{
    switch (status) {
    case BRACE_HOST_OK: return "done";
    case BRACE_HOST_E_NULL: return "a pointer that must be given is null";
    case BRACE_HOST_E_NOT_FINITE: return "an input is not a finite number";
    case BRACE_HOST_E_RANGE: return "an input lies outside its range, or time runs backwards";
    case BRACE_HOST_E_UNREACHABLE: return "no posture of this limb puts the tip there";
    case BRACE_HOST_E_PARAMETER: return "a model that no limb can have";
    case BRACE_HOST_E_SINGULAR: return "nothing yields in some direction";
    case BRACE_HOST_E_NO_CONVERGENCE: return "the rest state of some row was not found to its tolerance";
    default: return "unknown status";
    }
}

extern "C" const char *brace_host_version(void)
{
    return "0.1.0";
}
