/* What a call can return, and the flags that a result can carry.
 *
 * Every function of the core that can refuse returns a brace_status_t. BRACE_OK is 0. Every refusal is negative, and
 * its value never changes. A refused call leaves its outputs untouched.
 * brace/status_text.h has each status in words.
 */
#ifndef BRACE_STATUS_H
#define BRACE_STATUS_H

typedef enum {
    BRACE_OK = 0,
    BRACE_E_NULL = -1,        /* a pointer that must be given is null */
    BRACE_E_NOT_FINITE = -2,  /* an input is NaN or infinite */
    BRACE_E_RANGE = -3,       /* an input lies outside its stated range */
    BRACE_E_UNREACHABLE = -4, /* no posture of this limb puts the tip at that point */
    BRACE_E_PARAMETER = -5,   /* a limb parameter that no limb can have */
    BRACE_E_SINGULAR = -6,    /* the compliance has no inverse: nothing yields in some direction */
    BRACE_E_TOO_FEW = -7,     /* not enough samples for an answer */
    BRACE_E_UNSUPPORTED = -8, /* this limb needs the general path; see the function's header */
    /* -9 belongs to the host library */
    BRACE_E_MAGIC = -10,      /* not a parameter block at all */
    BRACE_E_FORMAT = -11,     /* a block of another format */
    BRACE_E_LENGTH = -12,     /* bytes are missing or too many */
    BRACE_E_CHECKSUM = -13,   /* the CRC does not fit: the block was damaged */
    BRACE_E_SCHEMA = -14,     /* the block is sound, but it was written for another list of parameters */
    BRACE_E_MODE = -15        /* the controller's present mode does not allow it */
} brace_status_t;

/* Quality of a result that was given nevertheless; bits that travel with the value. */
enum {
    BRACE_FLAG_UNCALIBRATED = 1u << 0,  /* parameters are defaults, not this limb's */
    BRACE_FLAG_NEAR_SINGULAR = 1u << 1, /* the stated accuracy is not promised for this limb or posture */
    BRACE_FLAG_SATURATED = 1u << 2,     /* a value was limited to its representable range */
    BRACE_FLAG_GAP_OPEN = 1u << 3,      /* a joint carries nothing: its backlash is open */
    BRACE_FLAG_STALE = 1u << 4, /* older than its stated age limit, or from a mode in which K is not computed */
    BRACE_FLAG_OUT_OF_RANGE = 1u << 5, /* outside the range in which the model was identified */
    BRACE_FLAG_LOAD_UNKNOWN = 1u << 6, /* the load is not counted: it is not known */
    BRACE_FLAG_SOFTENED = 1u << 7, /* the buckling factor is below 3, or no stable equilibrium is near */
    BRACE_FLAG_MOVED_FAR = 1u << 8, /* the load moves the tip further than the accuracy is promised for */
    BRACE_FLAG_PLAY_ASSUMED = 1u << 9 /* a joint counts as engaged because the load says so; nothing has proven it */
};

#endif
