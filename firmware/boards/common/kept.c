#include "kept.h"

#include "cortex_m.h"

enum { MAGIC = 0x4B455054, NOTHING_ANNOUNCED = 0xff };

typedef struct {
    uint32_t magic;
    uint32_t announced; /* brace_reset_cause_t of the reset to come, or NOTHING_ANNOUNCED */
    uint32_t crash_count;
    uint32_t crash_is_kept;
    brace_crash_record_t crash;
    uint32_t checksum; /* CRC-32 of all members before it */
} kept_t;

__attribute__((section(".kept.record"))) static kept_t kept;
static bool cold;
static brace_reset_cause_t cause;

/* CRC-32 (IEEE 802.3) bit by bit: the smallest way, and it runs only a few times between start and reset. */
static uint32_t checksum(void)
{
    const uint8_t *const bytes = (const uint8_t *)&kept;
    uint32_t crc = 0xffffffffu;
    for (uint32_t i = 0u; i < sizeof kept - sizeof kept.checksum; i++) {
        crc ^= bytes[i];
        for (uint32_t bit = 0u; bit < 8u; bit++) {
            crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
        }
    }
    return ~crc;
}

static void seal(void)
{
    kept.checksum = checksum();
}

void kept_start(void)
{
    cold = kept.magic != (uint32_t)MAGIC || kept.checksum != checksum();
    if (cold) {
        kept = (kept_t){.magic = MAGIC, .announced = NOTHING_ANNOUNCED};
        cause = BRACE_RESET_POWER;
    } else {
        cause = kept.announced <= BRACE_RESET_PIN ? (brace_reset_cause_t)kept.announced : BRACE_RESET_PIN;
        kept.announced = NOTHING_ANNOUNCED;
    }
    seal();
}

bool kept_is_cold(void)
{
    return cold;
}

brace_reset_cause_t kept_reset_cause(void *context)
{
    (void)context;
    return cause;
}

void kept_announce(brace_reset_cause_t announced)
{
    kept.announced = announced;
    seal();
}

void kept_crash_store(const brace_crash_record_t *record)
{
    kept.crash_count++;
    kept.crash = *record;
    kept.crash.count = kept.crash_count;
    kept.crash_is_kept = 1u;
    seal();
}

int32_t kept_crash_read(void *context, brace_crash_record_t *record)
{
    (void)context;
    if (kept.crash_is_kept == 0u) {
        return 0;
    }
    *record = kept.crash;
    return 1;
}

void kept_crash_clear(void *context)
{
    (void)context;
    kept.crash_is_kept = 0u;
    seal();
}

void kept_restart(void *context)
{
    (void)context;
    kept_announce(BRACE_RESET_REQUESTED);
    cortex_m_reset();
}
