#include "can/cyclic.h"

#include "can/bus.h"

#define FRAMES_MOST 4u
#define FRAME_US 625u /* one frame for so much of a tick */

/* What a frame can say of a K; a larger one is limited and flagged. */
#define K_MOST_N_PER_MM 4194.3f
#define LAMBDA_MIN_MOST_N_PER_MM 524.28f
#define LAMBDA_MAX_MOST_N_PER_MM 5242.8f

/* A CAN FD frame of 64 bytes: identifier, acknowledgement and pause at the slower rate, with 4 stuff bits; 512 bits of
 * data, length, count, CRC of 21 bits and all stuff bits there could be at the faster. */
#define FD_BITS_SLOW 35.0f
#define FD_BITS_FAST 680.0f

enum { FRAME_A = 1, FRAME_B = 2, FRAME_EIGENVALUES = 4, FRAME_POSTURE = 8, FRAME_FD = 16 };

static uint32_t every(uint32_t base_hz, uint32_t hz)
{
    return hz == 0u ? 0u : (base_hz + hz / 2u) / hz;
}

/* What goes out in a second, in classic frames of eight bytes. */
static float frames_per_s(const brace_app_t *app, float base_hz)
{
    const brace_app_cyclic_t *cyclic = &app->cyclic;
    if (cyclic->fd) {
        const float bits = FD_BITS_SLOW + FD_BITS_FAST * (float)app->bus.bit_rate / (float)app->bus.fd_bit_rate;
        return base_hz * bits / (float)CYCLIC_FRAME_BITS;
    }
    return 2.0f * (cyclic->stiffness_every > 0u ? base_hz / (float)cyclic->stiffness_every : 0.0f) +
           2.0f * (cyclic->posture_every > 0u ? base_hz / (float)cyclic->posture_every : 0.0f);
}

void cyclic_configure(brace_app_t *app)
{
    const brace_controller_t *wanted = &app->parameters.controller;
    brace_app_cyclic_t *cyclic = &app->cyclic;
    cyclic->fd = bus_takes_fd(app);
    const uint32_t posture_hz = cyclic->fd ? 0u : wanted->posture_hz;
    const uint32_t base_hz = wanted->stiffness_hz > posture_hz ? wanted->stiffness_hz : posture_hz;
    cyclic->parameter_crc = app->parameter_crc;
    cyclic->period_us = 0;
    cyclic->due = 0;
    if (base_hz == 0u) {
        return;
    }
    cyclic->stiffness_every = every(base_hz, wanted->stiffness_hz);
    cyclic->posture_every = every(base_hz, posture_hz);
    const float base = (float)base_hz, wanted_per_s = frames_per_s(app, base);
    /* heartbeats come first: they are never thinned */
    const float share_per_s = wanted->bus_load_ratio * (float)app->bus.bit_rate / (float)CYCLIC_FRAME_BITS -
                              (float)wanted->heartbeat_hz;
    const float allowed_per_s = share_per_s > 0.1f ? share_per_s : 0.1f;
    const float thinned = allowed_per_s >= wanted_per_s ? 1.0f : wanted_per_s / allowed_per_s;
    const float period_us = 1e6f * thinned / base;
    cyclic->period_us = period_us < 1e8f ? (uint32_t)(period_us + 0.5f) : 100000000u;
    cyclic->stiffness_in = cyclic->posture_in = 0;
    const uint32_t offset_us = (uint32_t)app->bus.node_id * (uint32_t)CYCLIC_STAGGER_US % cyclic->period_us;
    cyclic->next_us = app->last_us + offset_us;
    const uint32_t frames = app->parameters.controller.tick_us / FRAME_US;
    cyclic->frames_per_tick = frames < 1u ? 1u : frames > FRAMES_MOST ? FRAMES_MOST : frames;
}

bool cyclic_is_stale(const brace_app_t *app)
{
    return app->cyclic.parameter_crc != app->parameter_crc || app->cyclic.fd != bus_takes_fd(app);
}

static bool beyond(float value, float most)
{
    return value > most || value < -most;
}

/* Is there a value that no frame can say? It goes out limited. */
static bool is_limited(const brace_stiffness_t *k)
{
    return beyond(k->k_xx_n_per_mm, K_MOST_N_PER_MM) || beyond(k->k_xz_n_per_mm, K_MOST_N_PER_MM) ||
           beyond(k->k_zz_n_per_mm, K_MOST_N_PER_MM) ||
           beyond(k->lambda_min_n_per_mm, LAMBDA_MIN_MOST_N_PER_MM) ||
           beyond(k->lambda_max_n_per_mm, LAMBDA_MAX_MOST_N_PER_MM);
}

static void take_whole(brace_app_t *app)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(app);
    const brace_stiffness_t *k = &snapshot->stiffness.now;
    const bool valid = snapshot->k_is_valid;
    const float unknown = __builtin_nanf("");
    app->cyclic.whole = (brace_can_snapshot_fd_t){
        .sequence = snapshot->sequence,
        .parameter_crc = snapshot->parameter_crc,
        .flags = k->flags,
        .mode = snapshot->mode,
        .play_femur = snapshot->play[BRACE_FEMUR].state,
        .play_tibia = snapshot->play[BRACE_TIBIA].state,
        .faults = snapshot->faults,
        .k_xx_n_per_mm = valid ? k->k_xx_n_per_mm : unknown,
        .k_xz_n_per_mm = valid ? k->k_xz_n_per_mm : unknown,
        .k_zz_n_per_mm = valid ? k->k_zz_n_per_mm : unknown,
        .lambda_min_n_per_mm = valid ? k->lambda_min_n_per_mm : unknown,
        .lambda_max_n_per_mm = valid ? k->lambda_max_n_per_mm : unknown,
        .stiff_axis_rad = valid ? k->stiff_axis_rad : unknown,
        .theta1_rad = snapshot->theta_rad[BRACE_FEMUR],
        .theta2_rad = snapshot->theta_rad[BRACE_TIBIA],
        .tip_x_mm = snapshot->tip_mm.x_mm,
        .tip_z_mm = snapshot->tip_mm.z_mm,
        .force_x_n = snapshot->force_x_n,
        .force_z_n = snapshot->force_z_n};
}

/* Copies what goes out of a snapshot. */
static void take(brace_app_t *app)
{
    const brace_snapshot_t *snapshot = brace_app_snapshot(app);
    const brace_stiffness_t *k = &snapshot->stiffness.now;
    const bool valid = snapshot->k_is_valid;
    const float unknown = __builtin_nanf("");
    brace_app_cyclic_t *cyclic = &app->cyclic;
    const uint32_t sequence = snapshot->sequence & 0xffu;
    const uint32_t limited = valid && is_limited(k) ? (uint32_t)BRACE_FLAG_SATURATED : 0u;
    cyclic->taken_us = snapshot->taken_us;
    if (cyclic->due == FRAME_FD) {
        take_whole(app);
        return;
    }
    if ((cyclic->due & (FRAME_A | FRAME_B)) != 0u) {
        cyclic->stiffness_a = (brace_can_stiffness_a_t){
            sequence, k->flags | limited, valid ? k->k_xx_n_per_mm : unknown,
            valid ? k->k_xz_n_per_mm : unknown};
        cyclic->stiffness_b = (brace_can_stiffness_b_t){
            sequence, valid ? k->k_zz_n_per_mm : unknown, unknown, snapshot->play[BRACE_FEMUR].state,
            snapshot->play[BRACE_TIBIA].state, snapshot->parameter_crc & 0xffffu};
    }
    if ((cyclic->due & (FRAME_EIGENVALUES | FRAME_POSTURE)) != 0u) {
        cyclic->eigenvalues = (brace_can_eigenvalues_t){sequence, valid ? k->lambda_min_n_per_mm : unknown,
                                                        valid ? k->lambda_max_n_per_mm : unknown,
                                                        valid ? k->stiff_axis_rad : unknown};
        cyclic->posture = (brace_can_posture_t){sequence, snapshot->theta_rad[BRACE_FEMUR],
                                                snapshot->theta_rad[BRACE_TIBIA], snapshot->mode,
                                                snapshot->faults & 0xfffu};
    }
}

static bool comes_round(uint32_t *left, uint32_t every_so_many)
{
    if (every_so_many == 0u) {
        return false;
    }
    const bool now = *left == 0u;
    *left = (now ? every_so_many : *left) - 1u;
    return now;
}

/* Of the samples; they may have come a little after the tick's own time. */
static float age_ms(const brace_app_t *app)
{
    const int32_t age_us = (int32_t)(app->last_us - app->cyclic.taken_us);
    return age_us > 0 ? 1e-3f * (float)age_us : 0.0f;
}

static bool send_whole(brace_app_t *app)
{
    brace_app_cyclic_t *cyclic = &app->cyclic;
    uint8_t data[64];
    cyclic->whole.age_ms = age_ms(app);
    (void)brace_can_pack_snapshot_fd(&cyclic->whole, data);
    if (!bus_send_fd(app, BRACE_CAN_ID_SNAPSHOT_FD, data)) {
        return false;
    }
    cyclic->due = 0;
    return true;
}

/* The first frame of those due; packed when it is sent, so that the age is that of this moment. */
static bool send_first(brace_app_t *app)
{
    brace_app_cyclic_t *cyclic = &app->cyclic;
    if (cyclic->due == FRAME_FD) {
        return send_whole(app);
    }
    uint8_t data[8];
    uint32_t function, frame;
    if ((cyclic->due & FRAME_A) != 0u) {
        frame = FRAME_A, function = BRACE_CAN_ID_STIFFNESS_A;
        (void)brace_can_pack_stiffness_a(&cyclic->stiffness_a, data);
    } else if ((cyclic->due & FRAME_B) != 0u) {
        frame = FRAME_B, function = BRACE_CAN_ID_STIFFNESS_B;
        cyclic->stiffness_b.age_ms = age_ms(app);
        (void)brace_can_pack_stiffness_b(&cyclic->stiffness_b, data);
    } else if ((cyclic->due & FRAME_EIGENVALUES) != 0u) {
        frame = FRAME_EIGENVALUES, function = BRACE_CAN_ID_EIGENVALUES;
        (void)brace_can_pack_eigenvalues(&cyclic->eigenvalues, data);
    } else {
        frame = FRAME_POSTURE, function = BRACE_CAN_ID_POSTURE;
        (void)brace_can_pack_posture(&cyclic->posture, data);
    }
    if (!bus_send(app, function, data)) {
        return false;
    }
    cyclic->due &= (uint8_t)~frame;
    return true;
}

static bool is_due(const brace_app_cyclic_t *cyclic, uint32_t now_us)
{
    const int32_t over_us = (int32_t)(now_us - cyclic->next_us);
    return over_us >= 0 || (uint32_t)-over_us > cyclic->period_us; /* else the clock has gone round */
}

bool cyclic_wants(const brace_app_t *app)
{
    const brace_app_cyclic_t *cyclic = &app->cyclic;
    return cyclic->period_us != 0u && bus_speaks(app) && (cyclic->due != 0u || is_due(cyclic, app->last_us));
}

/* The next is due a period later, so that the rate is kept in the mean; what a bus has missed is not caught
 * up with. */
static void begin(brace_app_t *app)
{
    brace_app_cyclic_t *cyclic = &app->cyclic;
    const uint32_t over_us = app->last_us - cyclic->next_us;
    cyclic->next_us = (over_us < cyclic->period_us ? cyclic->next_us : app->last_us) + cyclic->period_us;
    const bool stiffness = comes_round(&cyclic->stiffness_in, cyclic->stiffness_every);
    const bool posture = comes_round(&cyclic->posture_in, cyclic->posture_every);
    cyclic->due = cyclic->fd ? FRAME_FD :
        (uint8_t)((stiffness ? FRAME_A | FRAME_B : 0) | (posture ? FRAME_EIGENVALUES | FRAME_POSTURE : 0));
    take(app);
}

void cyclic_send(brace_app_t *app, uint32_t most)
{
    brace_app_cyclic_t *cyclic = &app->cyclic;
    if (cyclic->period_us == 0u) {
        return;
    }
    if (cyclic->due == 0u && is_due(cyclic, app->last_us)) {
        begin(app);
    }
    for (uint32_t i = 0; i < most && cyclic->due != 0u; i++) {
        if (!send_first(app)) {
            return;
        }
    }
}
