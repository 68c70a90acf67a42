/* Asks a door (brace_hal.h) everything that its header promises and that can be found out without instruments, and says
 * in words what is wrong. For porters, and for a board that misbehaves.
 *
 * What it can not find out: whether an angle's sign and zero are right, whether a torque is true, whether memory keeps
 * without power, whether the watchdog bites (the crash-test image tells), whether a bus has wires.
 *
 * Not during operation: it reads samples away from the application, sets CAN up anew and, if allowed, erases a slot.
 * Start the board anew afterwards. No heap, no recursion.
 */
#ifndef BRACE_HAL_SELFTEST_H
#define BRACE_HAL_SELFTEST_H

#include "brace_hal.h"

typedef enum {
    BRACE_SELFTEST_PASS = 0,
    BRACE_SELFTEST_NOTE = 1, /* not wrong, but not there, or not to be found out */
    BRACE_SELFTEST_FAIL = 2
} brace_selftest_verdict_t;

typedef struct {
    brace_selftest_verdict_t verdict;
    const char *entry; /* of the door: "now_us", "joint_read(1)", "nvm_write" */
    const char *what;  /* what was found, in words; for FAIL also where to look; constant storage */
    bool has_value;
    int32_t value;     /* what was measured or answered */
    const char *unit;  /* of value: "us", "answer", ...; empty without one */
} brace_selftest_finding_t;

typedef struct {
    /* Called once for each finding, as it is found. Null: only count. */
    void (*report)(void *context, const brace_selftest_finding_t *finding);
    void *report_context;

    /* Slot that may be erased and written; it is left erased. BRACE_SELFTEST_KEEP_NVM: memory is only read. */
    int32_t scratch_slot;

    /* Somebody moves the joints during the test: an angle that does not change is then a failure, else a note. */
    bool joints_are_moved;

    /* A second clock to judge now_us by: a count that rises (or falls) at reference_hz, of reference_bits bits, read
     * with a null context. Null: the rate is not judged. */
    uint32_t (*reference_count)(void *context);
    uint32_t reference_hz;
    uint32_t reference_bits; /* [8, 32] */
    bool reference_falls;
} brace_selftest_setup_t;

enum { BRACE_SELFTEST_KEEP_NVM = -1 };

typedef struct {
    uint16_t passed, noted, failed;
} brace_selftest_result_t;

/* Runs every check.
 *   hal: the door; entries may be null, which is told
 *   setup: how; null: report nothing, keep memory, no second clock
 *   result: counts; may be null
 * returns the number of failures; BRACE_HAL_E_RANGE: hal is null, or setup's scratch_slot or reference_bits can not be.
 * Worst case 1 s, and what two erases take; bounded also when the clock stands. Feeds the watchdog. Stack below 1 KiB.
 */
int32_t brace_selftest_run(const brace_hal_t *hal, const brace_selftest_setup_t *setup,
    brace_selftest_result_t *result);

#endif
