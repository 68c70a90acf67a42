/* The self-test of a door (brace_hal.h). It checks every promise of that header which can be checked without
 * instruments, and says in words what is wrong. It is for people who port the firmware, and for a board that
 * misbehaves.
 *
 * It cannot find out whether an angle's sign and zero are right, whether a torque is true, whether memory keeps without
 * power, whether the watchdog bites (the crash-test image shows that), or whether a bus has wires.
 *
 * It commands no joint, but where `limb_is_free` says so. Do not run it during operation: it takes samples away from
 * the application, which does not command its joints meanwhile, sets CAN up anew and, if allowed, erases a slot.
 * Restart the board afterwards. No heap, no recursion.
 */
#ifndef BRACE_HAL_SELFTEST_H
#define BRACE_HAL_SELFTEST_H

#include "brace_hal.h"

typedef enum {
    BRACE_SELFTEST_PASS = 0,
    BRACE_SELFTEST_NOTE = 1, /* no fault: the board lacks it, or it cannot be checked here */
    BRACE_SELFTEST_FAIL = 2
} brace_selftest_verdict_t;

typedef struct {
    brace_selftest_verdict_t verdict;
    const char *entry; /* entry of the door: "now_us", "joint_read(1)", "nvm_write" */
    const char *what;  /* the finding in words; for FAIL also where to look; constant storage */
    bool has_value;
    int32_t value;     /* the number that was measured or returned */
    const char *unit;  /* unit of value: "us", "answer", ...; empty without one */
} brace_selftest_finding_t;

typedef struct {
    /* Called for each finding, as soon as it is found. Null: findings are only counted. */
    void (*report)(void *context, const brace_selftest_finding_t *finding);
    void *report_context;

    /* Slot that may be erased and written; it ends erased. BRACE_SELFTEST_KEEP_NVM: memory is only read. */
    int32_t scratch_slot;

    /* What the board's own drivers do between ticks (the bytes of a servo line); called again and again while a check
     * waits, so that joints behind such a line have new samples. Null: nothing. */
    void (*serve)(void);

    /* The limb hangs free, on a bench: joint_command is called, for no offset. Else no joint is commanded. */
    bool limb_is_free;

    /* Somebody moves the joints during the test. Then an angle that does not change is a failure, otherwise a note. */
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
 *   hal: the door; entries may be null, and the test reports that
 *   setup: how; null: report nothing, keep memory, no second clock
 *   result: counts; may be null
 * returns the number of failures; BRACE_HAL_E_RANGE: hal is null, or setup's scratch_slot or reference_bits is
 * impossible. Takes at most 1 s and the time of two erases, also when the clock stands. Feeds the watchdog. Stack below
 * 1 KiB.
 */
int32_t brace_selftest_run(const brace_hal_t *hal, const brace_selftest_setup_t *setup,
                           brace_selftest_result_t *result);

#endif
