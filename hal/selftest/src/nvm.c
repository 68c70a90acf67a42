/* Non-volatile memory: its shape, its bounds and, where a slot may be erased, whether it keeps what is written. */
#include "selftest.h"

enum { SLOT_BYTES_MIN = 4096, UNIT_MAX = 8, CHUNK = 64, ERASED = 0xff, ERASE_MAX_US = 2100000, WRITE_MAX_US = 1000 };

static bool shape(selftest_t *test)
{
    const brace_nvm_shape_t *const s = &test->hal->nvm_shape;
    const uint32_t unit = s->write_bytes;
    if (!selftest_expect(test, s->slot_bytes >= SLOT_BYTES_MIN, "nvm_shape", "slots are large enough",
                         "slots of less than 4096 bytes")) {
        return false;
    }
    return selftest_expect(test, (unit == 1u || unit == 2u || unit == 4u || unit == 8u) && s->slot_bytes % unit == 0u,
                           "nvm_shape", "the unit of writing is possible",
                           "write_bytes is not 1, 2, 4 or 8, or does not divide a slot");
}

static void bounds(selftest_t *test)
{
    const brace_hal_t *const hal = test->hal;
    uint8_t bytes[UNIT_MAX];
    const uint32_t end = hal->nvm_shape.slot_bytes;
    const bool refused = hal->nvm_read(hal->context, BRACE_NVM_SLOT_COUNT, 0u, bytes, 1u) == BRACE_HAL_E_RANGE &&
                         hal->nvm_read(hal->context, 0u, end, bytes, 1u) == BRACE_HAL_E_RANGE &&
                         hal->nvm_read(hal->context, 0u, UINT32_MAX, bytes, 2u) == BRACE_HAL_E_RANGE;
    selftest_expect(test, refused, "nvm_read", "what lies outside is refused",
                    "slot 2, or bytes behind a slot's end, are not refused with E_RANGE");
    selftest_expect(test,
                    hal->nvm_read(hal->context, 0u, end - 1u, bytes, 1u) == BRACE_HAL_OK &&
                        hal->nvm_read(hal->context, 1u, 0u, bytes, 1u) == BRACE_HAL_OK,
                    "nvm_read", "both slots are read to their ends",
                    "the first or last byte of a slot can not be read");
}

/* A checksum over a slot, to distinguish one content from another; false: the slot cannot be read. */
static bool fingerprint(const selftest_t *test, uint32_t slot, uint32_t *sum, bool *erased)
{
    const brace_hal_t *const hal = test->hal;
    uint8_t bytes[CHUNK];
    *sum = 2166136261u; /* FNV-1a */
    *erased = true;
    for (uint32_t at = 0u; at < hal->nvm_shape.slot_bytes; at += CHUNK) {
        const uint32_t left = hal->nvm_shape.slot_bytes - at, count = left < CHUNK ? left : CHUNK;
        if (hal->nvm_read(hal->context, slot, at, bytes, count) != BRACE_HAL_OK) {
            return false;
        }
        for (uint32_t i = 0u; i < count; i++) {
            *sum = (*sum ^ bytes[i]) * 16777619u;
            *erased = *erased && bytes[i] == ERASED;
        }
    }
    return true;
}

static bool erase(selftest_t *test, uint32_t slot)
{
    const brace_hal_t *const hal = test->hal;
    uint32_t sum;
    bool erased = false;
    hal->watchdog_feed(hal->context);
    const uint32_t began_us = hal->now_us(hal->context);
    const int32_t answer = hal->nvm_erase(hal->context, slot);
    const uint32_t took_us = hal->now_us(hal->context) - began_us;
    hal->watchdog_feed(hal->context);
    if (answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "nvm_erase", "refused: is the memory write-protected?", answer,
                              "answer");
        return false;
    }
    if (took_us > ERASE_MAX_US) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "nvm_erase", "takes longer than 2 s: the watchdog will bite",
                              (int32_t)took_us, "us");
    }
    return selftest_expect(
        test, fingerprint(test, slot, &sum, &erased) && erased, "nvm_erase", "leaves 0xff throughout",
        "does not leave 0xff throughout: wrong sector, or memory that erases to another value (invert it)");
}

static void pattern(uint8_t *bytes, uint32_t offset, uint32_t count)
{
    for (uint32_t i = 0u; i < count; i++) {
        const uint32_t mixed = (offset + i + 1u) * 2654435761u;
        bytes[i] = (uint8_t)((mixed >> 24) & 0x7fu); /* never 0xff */
    }
}

/* Writes and checks one unit; false: something is wrong, and has been reported. */
static bool write_unit(selftest_t *test, uint32_t slot, uint32_t offset)
{
    const brace_hal_t *const hal = test->hal;
    uint8_t bytes[UNIT_MAX];
    pattern(bytes, offset, hal->nvm_shape.write_bytes);
    const uint32_t began_us = hal->now_us(hal->context);
    const int32_t answer = hal->nvm_write(hal->context, slot, offset, bytes, hal->nvm_shape.write_bytes);
    const uint32_t took_us = hal->now_us(hal->context) - began_us;
    if (answer != BRACE_HAL_OK) {
        selftest_report_value(test, BRACE_SELFTEST_FAIL, "nvm_write",
                              "a unit of write_bytes is refused: is the unit's size right?", answer, "answer");
        return false;
    }
    if (test->clock_runs && took_us > WRITE_MAX_US) {
        selftest_report_value(test, BRACE_SELFTEST_NOTE, "nvm_write", "a unit took longer than 1 ms", (int32_t)took_us,
                              "us");
    }
    return true;
}

static bool holds(const selftest_t *test, uint32_t slot, uint32_t offset, bool written)
{
    const brace_hal_t *const hal = test->hal;
    const uint32_t unit = hal->nvm_shape.write_bytes;
    uint8_t expected[UNIT_MAX], found[UNIT_MAX];
    pattern(expected, offset, unit);
    if (hal->nvm_read(hal->context, slot, offset, found, unit) != BRACE_HAL_OK) {
        return false;
    }
    bool same = true;
    for (uint32_t i = 0u; i < unit; i++) {
        same = same && found[i] == (written ? expected[i] : (uint8_t)ERASED);
    }
    return same;
}

/* Offsets 0, u, 2u, 4u, ... and the last unit: rising, and each address line is set once. */
static uint32_t next_offset(const brace_nvm_shape_t *s, uint32_t offset)
{
    const uint32_t next = offset == 0u ? s->write_bytes : 2u * offset;
    const uint32_t last = s->slot_bytes - s->write_bytes;
    return offset == last ? s->slot_bytes : (next < last ? next : last);
}

static void keeps(selftest_t *test, uint32_t slot)
{
    const brace_hal_t *const hal = test->hal;
    const brace_nvm_shape_t *const s = &hal->nvm_shape;
    const uint32_t lonely = 8u * s->write_bytes; /* its neighbour 9 u is not written */
    bool right = true;
    for (uint32_t at = 0u; at < s->slot_bytes; at = next_offset(s, at)) { /* at most 24: doubled */
        if (!write_unit(test, slot, at)) {
            return;
        }
        if (at == lonely && !(holds(test, slot, at, true) && holds(test, slot, at + s->write_bytes, false))) {
            selftest_report(test, BRACE_SELFTEST_FAIL, "nvm_shape",
                            "the unit's size lies: writing one unit changed its neighbour, or not all of itself");
            return;
        }
    }
    for (uint32_t at = 0u; at < s->slot_bytes; at = next_offset(s, at)) { /* at most 24: doubled */
        right = right && holds(test, slot, at, true);
    }
    selftest_expect(test, right, "nvm_write", "what is written reads back, at every address line",
                    "does not keep what is written: wrong address, cache not flushed, or offsets that alias");
    if (s->write_bytes > 1u) {
        const uint8_t bytes[UNIT_MAX] = {0};
        const uint32_t blank = 3u * s->write_bytes;
        const int32_t off_grid = hal->nvm_write(hal->context, slot, blank + 1u, bytes, s->write_bytes);
        const int32_t part = hal->nvm_write(hal->context, slot, blank, bytes, s->write_bytes - 1u);
        selftest_expect(
            test, off_grid == BRACE_HAL_E_RANGE && part == BRACE_HAL_E_RANGE, "nvm_write",
            "only whole units on their grid are taken",
            "a write off the grid or of part of a unit is not refused with E_RANGE: is the unit's size right?");
    }
}

void selftest_nvm(selftest_t *test)
{
    if (!shape(test)) {
        return;
    }
    bounds(test);
    if (test->setup->scratch_slot == BRACE_SELFTEST_KEEP_NVM) {
        selftest_report(test, BRACE_SELFTEST_NOTE, "nvm_write", "not tried: the slots were to be kept");
        return;
    }
    const uint32_t slot = (uint32_t)test->setup->scratch_slot, other = 1u - slot;
    uint32_t before = 0u, after = 0u;
    bool erased;
    const bool readable = fingerprint(test, other, &before, &erased);
    if (!erase(test, slot)) {
        return;
    }
    keeps(test, slot);
    if (erase(test, slot)) {
        selftest_expect(test, readable && fingerprint(test, other, &after, &erased) && before == after, "nvm_erase",
                        "the other slot stays as it is", "the other slot changed: the slots are not apart");
    }
}
