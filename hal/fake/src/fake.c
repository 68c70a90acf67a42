#include "brace_hal_fake.h"

#include "fake_door.h"

int32_t fake_called(brace_fake_t *fake, brace_fake_entry_t entry)
{
    const uint32_t call = ++fake->calls[entry];
    for (uint32_t i = 0; i < fake->failure_count; i++) { /* at most BRACE_FAKE_FAILURES */
        const brace_fake_failure_t *failure = &fake->failure[i];
        if (failure->entry == entry && call >= failure->first && call <= failure->last) {
            return failure->answer;
        }
    }
    return BRACE_HAL_OK;
}

bool brace_fake_fail(brace_fake_t *fake, brace_fake_entry_t entry, uint32_t first, uint32_t last, int32_t answer)
{
    if (fake->failure_count >= BRACE_FAKE_FAILURES) {
        return false;
    }
    fake->failure[fake->failure_count++] = (brace_fake_failure_t){entry, first, last, answer};
    return true;
}

bool brace_fake_fail_next(brace_fake_t *fake, brace_fake_entry_t entry, uint32_t count, int32_t answer)
{
    const uint32_t next = fake->calls[entry] + 1u;
    return brace_fake_fail(fake, entry, next, next + count - 1u, answer);
}

void brace_fake_start(brace_fake_t *fake)
{
    *fake = (brace_fake_t){.can_room = BRACE_FAKE_FRAMES, .stack_unused_bytes = 1024};
    for (int i = 0; i < BRACE_FAKE_JOINTS; i++) {
        fake->joint[i].sample.link_rad = __builtin_nanf("");
        fake->joint[i].sample.temp_degc = __builtin_nanf("");
    }
    for (int slot = 0; slot < BRACE_NVM_SLOT_COUNT; slot++) {
        for (int i = 0; i < BRACE_FAKE_SLOT_BYTES; i++) {
            fake->nvm[slot][i] = 0xff;
        }
    }
    fake_door_fill(fake);
}

void brace_fake_reset(brace_fake_t *fake, brace_reset_cause_t cause)
{
    fake->reset_cause = cause;
    fake->now_us = 0;
    fake->can_sent = fake->can_received = (brace_fake_frames_t){.count = 0};
    fake->can_has_urgent = false;
    for (int port = 0; port < BRACE_SERIAL_PORT_COUNT; port++) {
        fake->serial_sent[port] = fake->serial_received[port] = (brace_fake_bytes_t){.count = 0};
    }
    for (int i = 0; i < BRACE_FAKE_JOINTS; i++) {
        fake->joint[i].command = (brace_hal_joint_command_t){0.0f, __builtin_inff()};
    }
}

void brace_fake_without_can(brace_fake_t *fake)
{
    fake->hal.can_setup = NULL;
    fake->hal.can_send = NULL;
    fake->hal.can_receive = NULL;
    fake->hal.can_health = NULL;
    fake->hal.can_recover = NULL;
}

void brace_fake_without_commands(brace_fake_t *fake)
{
    fake->hal.joint_command = NULL;
}

void brace_fake_without_force(brace_fake_t *fake)
{
    fake->hal.tip_force_read = NULL;
}
