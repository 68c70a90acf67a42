#include "wire/can/process.h"

#include "brace/can_frames.h"
#include "brace/can_snapshot.h"

#define CLASSIC_BYTES 8u
#define FD_BYTES 64u

/* A CAN FD frame of 64 bytes: identifier, acknowledgement and pause at the slower rate, with 4 stuff bits; 512 bits of
 * data, length, count, CRC of 21 bits and all stuff bits there could be at the faster. */
#define FD_BITS_SLOW 35.0f
#define FD_BITS_FAST 680.0f

#define PERIOD_MOST_US 100000000u
#define FRAMES_PER_S_LEAST 0.1f

/* ------------------------------------------------------------------------------------------ frames -- */

/* One frame of process data: what it is called on the bus, and who makes it from a snapshot. */
typedef struct {
    uint16_t id; /* of node 0 */
    bool is_fd;
    bool needs_coxa; /* only a limb whose coxa joint is fitted sends it */
    uint8_t rate;    /* process_rate_t */
    void (*make)(const brace_measured_t *of, float age_ms, uint8_t *data);
} process_frame_t;

/* Every message of measured values, in the order in which they are sent. A frame's place is its bit in
 * process_t.due. */
#define RATE_stiffness_hz PROCESS_STIFFNESS
#define RATE_posture_hz PROCESS_POSTURE
#define RATE_load_hz PROCESS_LOAD
#define RATE_sigma_hz PROCESS_SIGMA
#define CLASSIC(ID, name, rate, coxa) {ID, false, coxa != 0, RATE_##rate, brace_can_make_##name},
#define FD(ID, name, rate, coxa) {ID, true, coxa != 0, RATE_##rate, brace_can_make_##name},
static const process_frame_t frames[] = {BRACE_CAN_PROCESS(CLASSIC) BRACE_CAN_PROCESS_FD(FD)};
enum { FRAME_COUNT = sizeof frames / sizeof *frames };
_Static_assert(FRAME_COUNT <= 64, "a bit for each frame");

/* Does this limb send the frame on this bus? Frames of CAN FD take the place of the classic ones. */
static bool is_sent(const process_frame_t *frame, const process_bus_t *bus, const wire_tick_t *tick)
{
    return frame->is_fd == (bus->fd_bit_rate != 0u) &&
           (!frame->needs_coxa || brace_app_snapshot(tick->app)->space.is_fitted);
}

/* The frames that follow one of the rates. */
static process_share_t frames_of(uint32_t rate, const process_bus_t *bus, const wire_tick_t *tick)
{
    process_share_t share = {.frames = 0};
    for (uint32_t i = 0; i < (uint32_t)FRAME_COUNT; i++) {
        if (frames[i].rate == rate && is_sent(&frames[i], bus, tick)) {
            share.frames |= UINT64_C(1) << i;
            share.count++;
        }
    }
    return share;
}

/* ----------------------------------------------------------------------------------------- periods -- */

/* How many snapshots lie between two that are told, closest to the rate. */
static uint32_t every_of(uint32_t base_hz, uint32_t hz)
{
    return hz == 0u ? 0u : (base_hz + hz / 2u) / hz;
}

/* What goes out in a second, counted as classic frames of eight bytes. */
static float frames_per_s(const process_share_t *share, const process_bus_t *bus, float base_hz)
{
    const float per_s = share->every > 0u ? (float)share->count * base_hz / (float)share->every : 0.0f;
    if (bus->fd_bit_rate == 0u) {
        return per_s;
    }
    const float bits = FD_BITS_SLOW + FD_BITS_FAST * (float)bus->bit_rate / (float)bus->fd_bit_rate;
    return per_s * bits / (float)PROCESS_FRAME_BITS;
}

/* Works the periods out. */
static void configure(process_t *process, const process_bus_t *bus, const wire_tick_t *tick)
{
    const brace_controller_t *wanted = &brace_app_parameters(tick->app)->controller;
    process->is_configured = true;
    process->parameter_crc = brace_app_snapshot(tick->app)->parameter_crc;
    process->period_us = 0;
    process->due = 0;
    uint32_t rate_hz[PROCESS_RATES] = {wanted->stiffness_hz, wanted->posture_hz, wanted->load_hz, wanted->sigma_hz};
    uint32_t base_hz = 0;
    for (uint32_t i = 0; i < (uint32_t)PROCESS_RATES; i++) {
        process->share[i] = frames_of(i, bus, tick);
        rate_hz[i] = process->share[i].count > 0u ? rate_hz[i] : 0u;
        base_hz = rate_hz[i] > base_hz ? rate_hz[i] : base_hz;
    }
    if (base_hz == 0u) {
        return;
    }
    const float base = (float)base_hz;
    float wanted_per_s = 0.0f;
    for (uint32_t i = 0; i < (uint32_t)PROCESS_RATES; i++) {
        process->share[i].every = every_of(base_hz, rate_hz[i]);
        wanted_per_s += frames_per_s(&process->share[i], bus, base);
    }
    /* K's uncertainty leaves with other snapshots than the posture does, where K leaves with each. */
    const bool k_is_in_each = process->share[PROCESS_STIFFNESS].every == 1u;
    process->share[PROCESS_SIGMA].left = k_is_in_each ? process->share[PROCESS_SIGMA].every / 4u : 0u;
    /* Heartbeats and the frame behind each are never thinned, so their part of the bus is taken off first. */
    const float share_per_s =
        wanted->bus_load_ratio * (float)bus->bit_rate / (float)PROCESS_FRAME_BITS - 2.0f * (float)wanted->heartbeat_hz;
    const float allowed_per_s = share_per_s > FRAMES_PER_S_LEAST ? share_per_s : FRAMES_PER_S_LEAST;
    const float thinned = allowed_per_s >= wanted_per_s ? 1.0f : wanted_per_s / allowed_per_s;
    const float period_us = 1e6f * thinned / base;
    process->period_us = period_us < (float)PERIOD_MOST_US ? (uint32_t)(period_us + 0.5f) : PERIOD_MOST_US;
    process->next_us = tick->now_us + bus->node_id * (uint32_t)PROCESS_STAGGER_US % process->period_us;
}

/* The frames of a share that this snapshot has to tell. */
static uint64_t come_round(process_share_t *share)
{
    if (share->every == 0u) {
        return 0;
    }
    const bool now = share->left == 0u;
    share->left = (now ? share->every : share->left) - 1u;
    return now ? share->frames : 0u;
}

/* --------------------------------------------------------------------------------------------- tick -- */

static bool is_time(const process_t *process, uint32_t now_us)
{
    const int32_t over_us = (int32_t)(now_us - process->next_us);
    return over_us >= 0 || (uint32_t)-over_us > process->period_us; /* else the clock has gone round meanwhile */
}

/* The next snapshot is due a period later, so that the rate is kept in the mean. What a bus has missed is not caught up
 * with. */
static void take(process_t *process, const wire_tick_t *tick)
{
    const uint32_t over_us = tick->now_us - process->next_us;
    process->next_us = (over_us < process->period_us ? process->next_us : tick->now_us) + process->period_us;
    process->due = 0;
    for (uint32_t i = 0; i < (uint32_t)PROCESS_RATES; i++) {
        process->due |= come_round(&process->share[i]);
    }
    process->taken_us = tick->now_us;
    process->snapshot = *tick->measured;
}

uint32_t process_tick(process_t *process, const process_bus_t *bus, const wire_tick_t *tick)
{
    if (!process->is_configured || process->parameter_crc != brace_app_snapshot(tick->app)->parameter_crc) {
        configure(process, bus, tick);
        return WIRE_DATA_ARE_SET_UP;
    }
    if (process->period_us != 0u && process->due == 0u && is_time(process, tick->now_us)) {
        take(process, tick);
        return WIRE_DATA_ARE_TAKEN;
    }
    return WIRE_NOTHING;
}

bool process_next(const process_t *process, const wire_tick_t *tick, brace_can_frame_t *frame)
{
    if (process->due == 0u) {
        return false;
    }
    const uint32_t first = (uint32_t)__builtin_ctzll(process->due); /* the lowest bit that is set */
    const uint32_t age_us = process->snapshot.age_us + (tick->now_us - process->taken_us);
    frame->id = frames[first].id;
    frame->length = frames[first].is_fd ? FD_BYTES : CLASSIC_BYTES;
    frame->fd = frames[first].is_fd;
    frames[first].make(&process->snapshot, 1e-3f * (float)age_us, frame->data);
    return true;
}

void process_sent(process_t *process)
{
    process->due &= process->due - 1u; /* without its lowest bit */
}

void process_skip(process_t *process)
{
    process->due = 0;
}
