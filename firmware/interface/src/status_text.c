#include "brace/status_text.h"

#include <stdint.h>

/* In the order of the statuses, counting down. The host library's -9 has the text for a number that is no status. */
enum { UNKNOWN = 9, LAST = -BRACE_E_MODE };

static const char texts[] = "done\0"
                            "a pointer that must be given is null\0"
                            "an input is NaN or infinite\0"
                            "an input lies outside its stated range\0"
                            "no posture of this limb puts the tip there\0"
                            "a parameter that no limb can have\0"
                            "nothing yields in some direction, so K does not exist\0"
                            "not enough samples for an answer\0"
                            "this limb needs the general path\0"
                            "not a status of this library\0"
                            "not a parameter block\0"
                            "a parameter block of another format\0"
                            "bytes are missing or too many\0"
                            "the checksum does not fit: damaged on its way\0"
                            "written for another list of parameters\0"
                            "not in the mode that the controller is in";

const char *brace_status_text(brace_status_t status)
{
    const int32_t number = -(int32_t)status;
    int32_t before = number < 0 || number > LAST ? UNKNOWN : number;
    uint32_t at = 0;
    for (; at < sizeof texts && before > 0; at++) {
        before -= texts[at] == '\0';
    }
    return &texts[at];
}
