/* Sends each drive its command: the sum of the take-up's command and the loading test's offset. */
#ifndef BRACE_COMMAND_DRIVES_H
#define BRACE_COMMAND_DRIVES_H

#include <stdbool.h>
#include <stdint.h>

#include "brace_hal.h"
#include "flank/flank.h"

typedef struct {
    bool are_commanded;  /* the drives hold a command of ours */
    bool is_going_back;  /* nothing is asked for any more, and a drive is still behind: the limb moves */
    bool is_behind[BRACE_LINK_COUNT]; /* stood or refused, and now follows slowly to what is asked for */
    uint32_t refused_us; /* how long a drive has refused every command */
    float commanded_offset_rad[BRACE_LINK_COUNT];   /* what each drive is commanded to add to its set-point */
    float limit_n_mm[BRACE_LINK_COUNT]; /* within which torque; INFINITY: within its own */
} drives_t;

/* What a loading test adds to each joint's set-point, and within which torque. */
typedef struct {
    bool runs;
    float offset_rad[BRACE_LINK_COUNT];
    float torque_limit_n_mm[BRACE_LINK_COUNT];
} drives_test_t;

/* Nothing has been commanded. */
void drives_start(drives_t *drives);

/* Commands the drives in every tick in which something moves the limb, and afterwards until the command is taken back:
 * mostly once more; but where the board's ceiling or a fault has left a drive behind, until it is back, too.
 * What a drive is behind because it stood or refused is made up for at 0.1 rad/s at most, so that nothing jumps.
 *   takes_up: backlash is taken up, held or let go
 *   stands: every set-point stays where it is, also one that is behind what is asked for
 *   commands_failed: of brace_app_counters_t */
void drives_command(drives_t *drives, const brace_hal_t *hal, const joints_t *joints, const flank_t *flank,
                    bool takes_up, const drives_test_t *test, bool stands, uint32_t tick_us, uint32_t *commands_failed);

/* Has a drive refused its commands for 50 ms? */
bool drives_refuse(const drives_t *drives);

#endif
