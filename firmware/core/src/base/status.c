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
    case BRACE_E_MODE: return "not in the mode that the controller is in";
    case BRACE_E_MAGIC: return "not a parameter block";
    case BRACE_E_FORMAT: return "a parameter block of another format";
    case BRACE_E_LENGTH: return "bytes are missing or too many";
    case BRACE_E_CHECKSUM: return "the checksum does not fit: damaged on its way";
    case BRACE_E_SCHEMA: return "written for another list of parameters";
    default: return "not a status of this library";
    }
}
