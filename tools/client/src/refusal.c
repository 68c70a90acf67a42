/* A refusal in words. */
#include "refusal.h"

#include <stddef.h>

#include "brace/can_messages.h"
#include "brace/client.h"
#include "brace/refusals.h"
#include "brace/status_text.h"

bool brace_client_is_about_force(uint32_t code)
{
    return code == BRACE_REQUEST_TIP_FORCE || code == BRACE_REQUEST_TIP_FORCE_IN_SPACE ||
           code == BRACE_REQUEST_K_IN_SPACE_AT_POSTURE || code == BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE ||
           code == BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP || code == BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN;
}

/* What a status means for one request only; null: what it means for all. */
static const char *reason_of_request(uint32_t code, int32_t status, uint32_t detail)
{
    const bool is_of_now = code == BRACE_REQUEST_CONTACT_FORCE || code == BRACE_REQUEST_SAG_FOR_LOAD;
    const bool is_open = (detail & BRACE_CLIENT_FLAG_GAP_OPEN) != 0u; /* detail: K's flags */
    if (is_of_now && is_open && status == BRACE_E_RANGE) {
        return "a joint's play is open, so nothing carries the tip in some direction; take it up first";
    }
    if (is_of_now && status == BRACE_E_MODE) {
        return "K of now is not valid; its mode and faults say why";
    }
    if (code == BRACE_REQUEST_K_IN_SPACE_AT_POSTURE && status == BRACE_E_UNSUPPORTED) {
        return BRACE_CLIENT_NO_COXA;
    }
    if (code == BRACE_REQUEST_FRICTION_MARGIN && status == BRACE_E_NOT_FINITE) {
        return "the force on the tip is not known now";
    }
    if (brace_client_is_about_force(code) && status == BRACE_E_SINGULAR) {
        return BRACE_CLIENT_FOLDS;
    }
    if (code == BRACE_REQUEST_TAKE_UP && status == BRACE_E_UNSUPPORTED) {
        return "the joint has no backlash to take up, or nothing that moves it";
    }
    if (code == BRACE_REQUEST_TAKE_UP && status == BRACE_E_RANGE) {
        return "there is no such joint, or its backlash is being taken up already";
    }
    if (code == BRACE_REQUEST_LET_GO && status == BRACE_E_MODE) {
        return "nothing is taken up, and no loading test runs";
    }
    if (code == BRACE_REQUEST_LOADING_TEST_START && status == BRACE_E_SINGULAR) {
        return "K is not valid, or the joints cannot move the tip along that axis";
    }
    return NULL;
}

const char *brace_client_reason(uint32_t code, int32_t status, uint32_t detail)
{
    const char *special = reason_of_request(code, status, detail);
    if (special != NULL) {
        return special;
    }
    switch (status) {
    case BRACE_REFUSED_UNKNOWN: return "it knows no such question; flash the firmware of this library's version";
    case BRACE_REFUSED_BUSY: return "it is storing a set or judging a loading test; ask again";
    case BRACE_REFUSED_STRANGER: return "it is guarded, and the key is another one (brace_client_load_key)";
    case BRACE_REFUSED_REPLAY:
        return "the command came twice, or another program's session is open; ask again in a second";
    case BRACE_REFUSED_OWNED: return "somebody else moves the limb or writes to it; wait until that is done";
    case BRACE_REFUSED_CROWDED: return "so many questions of this program wait there already; ask again";
    case BRACE_REFUSED_LATE:
        return "the sign of life carries an old number of the controller's: the link is slow (docs/security.md)";
    case BRACE_REFUSED_NO_KEY: return "it is guarded and has no key yet; docs/security.md says how it gets one";
    default: return brace_status_text((brace_status_t)status);
    }
}
