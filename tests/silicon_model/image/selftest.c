/* The port self-test on the layer: findings are left in a table. */
#include "brace_hal_selftest.h"
#include "brace_hal_stm32f405.h"

static const brace_hal_t *door;

/* A sound sample a millisecond. */
static int32_t read_joint(void *context, int32_t joint_index, brace_hal_joint_t *joint)
{
    static uint32_t taken_us[3];
    if (joint_index < 0 || joint_index > 2) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    const uint32_t now_us = door->now_us(door->context);
    const bool is_new = now_us - taken_us[joint_index] >= 1000u;
    if (is_new) {
        taken_us[joint_index] = now_us;
    }
    *joint = (brace_hal_joint_t){*(const float *)context, 10.0f, 0.5f, 22.0f, taken_us[joint_index]};
    return is_new ? BRACE_HAL_OK : BRACE_HAL_AGAIN;
}

static float angle_rad = 0.5f;
static const stm32f405_joints_t joints = {.context = &angle_rad, .read = read_joint};

static const stm32f405_board_t board = {
    .name = "register model",
    .hse_hz = 8000000,
    .serial = {[BRACE_SERIAL_CONSOLE] = {1, {'A', 9}, {'A', 10}, {0, 0}}},
    .can_rx = {'B', 8},
    .can_tx = {'B', 9},
    .nvm_sector = {10, 11},
    .watchdog = true,
    .joints = &joints,
};

typedef struct {
    uint32_t verdict;
    char entry[24], what[100];
    int32_t value;
} finding_t;

finding_t findings[64];
uint32_t finding_count;

static void copy(char *to, const char *from, uint32_t room)
{
    for (uint32_t i = 0; i + 1u < room && from[i] != 0; i++) {
        to[i] = from[i];
    }
}

static void note_down(void *context, const brace_selftest_finding_t *finding)
{
    (void)context;
    finding_t *place = &findings[finding_count % 64u];
    finding_count++;
    place->verdict = (uint32_t)finding->verdict;
    place->value = finding->value;
    copy(place->entry, finding->entry, sizeof place->entry);
    copy(place->what, finding->what, sizeof place->what);
}

int32_t run_selftest(void)
{
    const brace_selftest_setup_t setup = {.report = note_down, .scratch_slot = 1};
    door = brace_hal_stm32f405(&board);
    return brace_selftest_run(door, &setup, 0);
}
