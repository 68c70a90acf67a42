#include "wire/can/announce.h"

#include "brace/can_messages.h"
#include "brace/codes.h"
#include "wire/measured.h"

#define SECOND_US 1000000u
#define SILENCE_MOST_US 100000000u /* keeps since_us * heartbeat_hz within 32 bits */

/* CANopen's emergency codes, by the fault's bit. */
#define EMERGENCY_CODE(fault, code) code,
static const uint16_t codes[] = {BRACE_FAULTS(EMERGENCY_CODE)};
#undef EMERGENCY_CODE

/* The code of the lowest new fault; 0x1000: faults are there, and none of them is new; 0: every fault is over. */
static uint16_t emergency_code(uint32_t fresh, uint32_t faults)
{
    for (uint32_t bit = 0; bit < (uint32_t)BRACE_FAULT_COUNT; bit++) {
        if ((fresh & (1u << bit)) != 0u) {
            return codes[bit];
        }
    }
    return faults != 0u ? 0x1000 : 0;
}

/* The state as CANopen numbers them. */
static uint32_t state_of(brace_mode_t mode)
{
    switch (mode) {
    case BRACE_MODE_START: return 0x00;         /* boot-up */
    case BRACE_MODE_CONFIGURATION: return 0x7f; /* pre-operational */
    case BRACE_MODE_FAULT: return 0x04;         /* stopped */
    default: return 0x05;                       /* operational */
    }
}

/* The period is 1e6 / rate; this compares without the division. */
static bool heart_beats(const announce_t *announce, const wire_tick_t *tick)
{
    const uint32_t since_us = tick->now_us - announce->beat_us;
    const uint32_t rate_hz = brace_app_parameters(tick->app)->controller.heartbeat_hz;
    return since_us >= SILENCE_MOST_US || since_us * rate_hz >= SECOND_US;
}

/* The likeliest cause of the drift while the fault is there. */
static uint32_t drift_cause(const wire_tick_t *tick, uint32_t faults)
{
    const bool has_drifted = (faults & (uint32_t)BRACE_FAULT_MODEL_DRIFT) != 0u;
    return has_drifted ? measured_drift_cause(brace_app_drift_report(tick->app)) : (uint32_t)BRACE_DRIFT_CAUSE_NONE;
}

bool announce_next(const announce_t *announce, const wire_tick_t *tick, brace_can_frame_t *frame)
{
    const brace_mode_t mode = brace_app_mode(tick->app);
    const uint32_t faults = brace_app_faults(tick->app);
    frame->length = 8;
    frame->fd = false;
    const uint32_t cause = drift_cause(tick, faults);
    if (faults != announce->faults_told || cause != announce->cause_told) {
        const uint32_t drift = faults & (cause != announce->cause_told ? (uint32_t)BRACE_FAULT_MODEL_DRIFT : 0u);
        const uint32_t code = emergency_code((faults & ~announce->faults_told) | drift, faults);
        frame->id = BRACE_CAN_ID_EMERGENCY;
        (void)brace_can_pack_emergency(&(brace_can_emergency_t){.error_code = code,
                                                                .error_register = faults != 0u,
                                                                .drift_cause = cause,
                                                                .mode = mode,
                                                                .faults = faults},
                                       frame->data);
        return true;
    }
    if (announce->owes_condition) {
        frame->id = BRACE_CAN_ID_DETAILS;
        const uint32_t sequence = brace_app_snapshot(tick->app)->sequence & 0xffu;
        (void)brace_can_pack_condition(
            &(brace_can_condition_t){
                .sequence = sequence, .faults = faults, .mode = mode, .setting = brace_app_setting(tick->app)},
            frame->data);
        return true;
    }
    if (mode != announce->mode_told || heart_beats(announce, tick)) {
        frame->id = BRACE_CAN_ID_HEARTBEAT;
        (void)brace_can_pack_heartbeat(&(brace_can_heartbeat_t){.state = state_of(mode),
                                                                .mode = mode,
                                                                .setting = brace_app_setting(tick->app),
                                                                .protocol = BRACE_PROTOCOL,
                                                                .dictionary_hash = BRACE_DICTIONARY_HASH},
                                       frame->data);
        return true;
    }
    return false;
}

void announce_sent(announce_t *announce, const wire_tick_t *tick, uint32_t function)
{
    if (function == (uint32_t)BRACE_CAN_ID_EMERGENCY) {
        announce->faults_told = brace_app_faults(tick->app);
        announce->cause_told = drift_cause(tick, announce->faults_told);
    } else if (function == (uint32_t)BRACE_CAN_ID_DETAILS) {
        announce->owes_condition = false;
    } else {
        announce->mode_told = brace_app_mode(tick->app);
        announce->beat_us = tick->now_us;
        announce->owes_condition = true;
    }
}

void announce_skip(announce_t *announce, const wire_tick_t *tick)
{
    announce->faults_told = brace_app_faults(tick->app);
    announce->cause_told = drift_cause(tick, announce->faults_told);
    announce->mode_told = brace_app_mode(tick->app);
}
