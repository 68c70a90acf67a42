/* The port self-test and memory: each lie is named, and nothing else blamed before it. */
#include "selftest_door.h"

enum {
    NVM_SMALL = 1,
    NVM_ODD_UNIT,
    NVM_UNIT_TOO_SMALL,
    NVM_UNIT_TOO_LARGE,
    NVM_FORGETS,
    NVM_ALIASES,
    NVM_ERASES_TO_ZERO,
    NVM_ERASES_HALF,
    NVM_ERASES_BOTH,
    NVM_NO_BOUNDS,
    NVM_PROTECTED,
    NVM_OFF_GRID,
    LIES
};

static uint8_t *nvm_at(uint32_t slot, uint32_t offset)
{
    return &world.nvm[slot][world.lie == NVM_ALIASES ? offset % 1024u : offset];
}

static int32_t lying_nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    (void)context;
    if (outside(slot, offset, count)) {
        memset(bytes, 0, count <= UNIT ? count : 0u);
        return world.lie == NVM_NO_BOUNDS ? BRACE_HAL_OK : BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0u; i < count; i++) {
        bytes[i] = *nvm_at(slot, offset + i);
    }
    return BRACE_HAL_OK;
}

static int32_t lying_nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    (void)context;
    const bool off_grid = offset % UNIT != 0u || count % UNIT != 0u;
    if (world.lie == NVM_UNIT_TOO_SMALL || world.lie == NVM_UNIT_TOO_LARGE) {
        /* The device knows units of 4 only, whatever the shape says: it fills up what is not given. */
        for (uint32_t i = offset - offset % UNIT; i < offset - offset % UNIT + UNIT; i++) {
            *nvm_at(slot, i) = i >= offset && i < offset + count ? bytes[i - offset] : 0u;
        }
        return BRACE_HAL_OK;
    }
    if (outside(slot, offset, count) || (off_grid && world.lie != NVM_OFF_GRID)) {
        return BRACE_HAL_E_RANGE;
    }
    for (uint32_t i = 0u; i < count && !(world.lie == NVM_FORGETS && offset >= 2048u); i++) {
        *nvm_at(slot, offset + i) &= bytes[i];
    }
    return BRACE_HAL_OK;
}

static int32_t lying_nvm_erase(void *context, uint32_t slot)
{
    (void)context;
    if (world.lie == NVM_PROTECTED) {
        return BRACE_HAL_E_DEVICE;
    }
    memset(world.nvm[slot], world.lie == NVM_ERASES_TO_ZERO ? 0 : 0xff,
           world.lie == NVM_ERASES_HALF ? SLOT_BYTES / 2u : SLOT_BYTES);
    if (world.lie == NVM_ERASES_BOTH) {
        memset(world.nvm[1u - slot], 0xff, SLOT_BYTES);
    }
    return BRACE_HAL_OK;
}

static void open_lying(int lie)
{
    door.nvm_read = lying_nvm_read;
    door.nvm_write = lying_nvm_write;
    door.nvm_erase = lying_nvm_erase;
    switch (lie) {
    case NVM_SMALL: door.nvm_shape.slot_bytes = 2048u; break;
    case NVM_ODD_UNIT: door.nvm_shape.write_bytes = 3u; break;
    case NVM_UNIT_TOO_SMALL: door.nvm_shape.write_bytes = 2u; break;
    case NVM_UNIT_TOO_LARGE: door.nvm_shape.write_bytes = 8u; break;
    default: break;
    }
}

static void each_lie_is_named(void)
{
    static const named_t named[] = {
        {NVM_SMALL, "nvm_shape", "less than 4096"},
        {NVM_ODD_UNIT, "nvm_shape", "not 1, 2, 4 or 8"},
        {NVM_UNIT_TOO_SMALL, "nvm_shape", "unit's size lies"},
        {NVM_UNIT_TOO_LARGE, "nvm_shape", "unit's size lies"},
        {NVM_FORGETS, "nvm_write", "does not keep"},
        {NVM_ALIASES, "nvm_write", "offsets that alias"},
        {NVM_ERASES_TO_ZERO, "nvm_erase", "does not leave 0xff"},
        {NVM_ERASES_HALF, "nvm_erase", "does not leave 0xff"},
        {NVM_ERASES_BOTH, "nvm_erase", "the other slot changed"},
        {NVM_NO_BOUNDS, "nvm_read", "not refused with E_RANGE"},
        {NVM_PROTECTED, "nvm_erase", "write-protected"},
        {NVM_OFF_GRID, "nvm_write", "off the grid"},
    };
    TEST_ASSERT_EQUAL_UINT32(LIES - 1u, sizeof named / sizeof named[0]);
    expect_each_named(named, sizeof named / sizeof named[0], open_lying);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_lie_is_named);
    return UNITY_END();
}
