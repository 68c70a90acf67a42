#include "brace/status.h"

const char *brace_status_text(brace_status_t status)
{
    switch (status) {
    case BRACE_OK: return "done";
    case BRACE_E_NULL: return "a pointer that must be given is null";
    case BRACE_E_NOT_FINITE: return "an input is NaN or infinite";
    case BRACE_E_RANGE: return "an input lies outside its stated range";
    case BRACE_E_UNREACHABLE: return "no posture of this limb puts the tip there";
    case BRACE_E_PARAMETER: return "a parameter that no limb can have";
    case BRACE_E_SINGULAR: return "nothing yields in some direction, so K does not exist";
    case BRACE_E_TOO_FEW: return "not enough samples for an answer";
    case BRACE_E_UNSUPPORTED: return "this limb needs the general path";
    default: return "not a status of this library";
    }
}
