/* motion_probe BUS NODE KEY_FILE ACTION...: commands of the C client, one after the other, from one client. KEY_FILE
 * "-": none. After each action a line on stdout: its name, its status (positive), the motion's state and reason. When
 * something went wrong, the client's line for people on stderr.
 *   take_up:JOINT:FLANK:LIMIT_MS | let_go | load:AXIS:STEPS:STEP_MM:DWELL_MS | end_test: begins it
 *   wait: until it has ended | steps:MS: a control loop for so long | silent:MS: hangs for so long
 *   reads:MS: reads the load for so long, which over CAN does not come where controller.load_hz is 0
 *   read:MS: reads K with that time-out, its number in the place of the state
 *   stop | stop_all:ID | clear:FAULTS | gravity:DIRECTION:LEAN | entry:INDEX: its 32 bits in the place of the state */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "brace/client_motion.h"

enum { ANSWER_MS = 2000, LIMIT_MS = 20000, STEP_MS = 50, NUMBERS = 4 };

static brace_motion_t motion;

static void pause_ms(long ms)
{
    const struct timespec time = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000};
    nanosleep(&time, NULL);
}

/* Name and numbers of "name:number:number". returns how many numbers */
static int read_action(char *action, const char **name, float numbers[NUMBERS])
{
    int count = 0;
    *name = strtok(action, ":");
    for (char *part = strtok(NULL, ":"); part != NULL && count < NUMBERS; part = strtok(NULL, ":")) {
        numbers[count++] = strtof(part, NULL);
    }
    return count;
}

static brace_client_status_t step_for(brace_client_t *limb, int ms)
{
    brace_client_status_t status = BRACE_CLIENT_OK;
    for (int left_ms = ms; left_ms > 0 && status == BRACE_CLIENT_OK; left_ms -= 10) {
        status = brace_client_step(limb, STEP_MS, &motion);
        pause_ms(10);
    }
    return status;
}

static long now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Without a step. */
static brace_client_status_t read_for(brace_client_t *limb, int ms)
{
    const long end_ms = now_ms() + ms;
    brace_client_status_t status = BRACE_CLIENT_OK;
    while (now_ms() < end_ms) {
        brace_client_snapshot_t now;
        status = brace_client_read(limb, BRACE_PART_LOAD, ms, &now);
    }
    return status;
}

static brace_client_status_t act(brace_client_t *limb, const char *name, const float n[NUMBERS], uint32_t *value)
{
    if (strcmp(name, "take_up") == 0) {
        return brace_client_begin_take_up(limb, (uint32_t)n[0], (int)n[1], ANSWER_MS, n[2] > 0 ? (int)n[2] : LIMIT_MS);
    }
    if (strcmp(name, "let_go") == 0) {
        return brace_client_begin_let_go(limb, ANSWER_MS, LIMIT_MS);
    }
    if (strcmp(name, "load") == 0) {
        const brace_loading_plan_t plan = {(uint32_t)n[0], (uint32_t)n[1], n[2], (uint32_t)n[3]};
        return brace_client_begin_loading_test(limb, &plan, ANSWER_MS, LIMIT_MS);
    }
    if (strcmp(name, "end_test") == 0) {
        return brace_client_begin_end_test(limb, ANSWER_MS, LIMIT_MS);
    }
    if (strcmp(name, "wait") == 0) {
        return brace_client_wait(limb, &motion);
    }
    if (strcmp(name, "steps") == 0) {
        return step_for(limb, (int)n[0]);
    }
    if (strcmp(name, "reads") == 0) {
        return read_for(limb, (int)n[0]);
    }
    if (strcmp(name, "read") == 0) {
        brace_client_snapshot_t now = {.sequence = UINT32_MAX};
        const brace_client_status_t status = brace_client_read(limb, BRACE_PART_K, (int)n[0], &now);
        *value = now.sequence;
        return status;
    }
    if (strcmp(name, "silent") == 0) {
        pause_ms((long)n[0]);
        return BRACE_CLIENT_OK;
    }
    if (strcmp(name, "stop") == 0) {
        return brace_client_stop(limb, ANSWER_MS);
    }
    if (strcmp(name, "stop_all") == 0) {
        return brace_client_stop_all(limb, (uint32_t)n[0], ANSWER_MS);
    }
    if (strcmp(name, "clear") == 0) {
        return brace_client_clear(limb, (uint32_t)n[0], ANSWER_MS, value);
    }
    if (strcmp(name, "gravity") == 0) {
        return brace_client_set_gravity(limb, n[0], n[1], ANSWER_MS);
    }
    return strcmp(name, "entry") == 0 ? brace_client_entry_u32(limb, (uint32_t)n[0], ANSWER_MS, value)
                                      : BRACE_CLIENT_E_USAGE;
}

int main(int argc, char **argv)
{
    char why[BRACE_CLIENT_WHY_ROOM];
    brace_client_t *limb;
    if (argc < 5) {
        fprintf(stderr, "usage: motion_probe BUS NODE KEY_FILE ACTION...\n");
        return 64;
    }
    setvbuf(stdout, NULL, _IOLBF, 0u);
    brace_client_status_t status =
        brace_client_open(argv[1], (uint32_t)atoi(argv[2]), 0u, 10000, &limb, why, sizeof why);
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\n", why);
        return 65;
    }
    if (strcmp(argv[3], "-") != 0 && brace_client_load_key(limb, argv[3]) != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\n", brace_client_why(limb));
        brace_client_close(limb);
        return 66;
    }
    for (int i = 4; i < argc; i++) {
        float numbers[NUMBERS] = {0};
        const char *name;
        uint32_t value = UINT32_MAX;
        (void)read_action(argv[i], &name, numbers);
        status = act(limb, name, numbers, &value);
        const brace_motion_state_t before = motion.state;
        if (value == UINT32_MAX) {
            (void)brace_client_step(limb, STEP_MS, &motion);
            value = (uint32_t)motion.state;
        }
        printf("%s %d %u %d\n", name, -(int)status, (unsigned)value, (int)motion.reason);
        if (status != BRACE_CLIENT_OK || (motion.state > BRACE_MOTION_DONE && motion.state != before)) {
            fprintf(stderr, "%s: %s\n", name, brace_client_why(limb));
        }
    }
    brace_client_close(limb);
    return 0;
}
