#include "joiner.h"

#include <math.h>
#include <string.h>

#include "brace/can_messages.h"

enum { A = 1, B = 2, EIGENVALUES = 4, POSTURE = 8 };

static void begin(brace_joiner_slot_t *slot, uint32_t sequence, uint64_t received_us)
{
    memset(slot, 0, sizeof *slot);
    slot->used = true;
    brace_client_snapshot_t *s = &slot->snapshot;
    s->sequence = sequence;
    s->received_us = received_us;
    s->age_ms = s->k_xx_n_per_mm = s->k_xz_n_per_mm = s->k_zz_n_per_mm = NAN;
    s->lambda_min_n_per_mm = s->lambda_max_n_per_mm = s->stiff_axis_rad = NAN;
    s->theta1_rad = s->theta2_rad = NAN;
    s->flags = s->play_femur = s->play_tibia = s->parameter_tag = s->mode = s->faults = UINT32_MAX;
}

/* The slot of this number, or the older one begun anew. */
static brace_joiner_slot_t *slot_of(brace_joiner_t *joiner, uint32_t sequence, uint64_t received_us)
{
    brace_joiner_slot_t *older = &joiner->slots[0];
    for (int i = 0; i < BRACE_JOINER_SLOTS; i++) {
        brace_joiner_slot_t *slot = &joiner->slots[i];
        const int64_t since_us = (int64_t)(received_us - slot->snapshot.received_us);
        if (since_us > BRACE_JOINER_SPAN_US || since_us < -BRACE_JOINER_SPAN_US) {
            slot->used = false;
        }
        if (slot->used && slot->snapshot.sequence == sequence) {
            return slot;
        }
        if (!slot->used || (older->used && slot->snapshot.received_us < older->snapshot.received_us)) {
            older = slot;
        }
    }
    begin(older, sequence, received_us);
    return older;
}

/* Members of a frame into those of the snapshot that have the same names. */
#define UNPACKED(kind) \
    brace_can_##kind##_t got; \
    brace_can_unpack_##kind(data, &got)
#define TAKE(member) s->member = got.member

static void take_a(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(stiffness_a);
    TAKE(flags), TAKE(k_xx_n_per_mm), TAKE(k_xz_n_per_mm);
}

static void take_b(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(stiffness_b);
    TAKE(k_zz_n_per_mm), TAKE(age_ms), TAKE(play_femur), TAKE(play_tibia), TAKE(parameter_tag);
}

static void take_eigenvalues(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(eigenvalues);
    TAKE(lambda_min_n_per_mm), TAKE(lambda_max_n_per_mm), TAKE(stiff_axis_rad);
}

static void take_posture(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(posture);
    TAKE(theta1_rad), TAKE(theta2_rad), TAKE(mode), TAKE(faults);
}

static void take_whole(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(snapshot_fd);
    TAKE(flags), TAKE(k_xx_n_per_mm), TAKE(k_xz_n_per_mm), TAKE(k_zz_n_per_mm);
    TAKE(age_ms), TAKE(play_femur), TAKE(play_tibia);
    TAKE(lambda_min_n_per_mm), TAKE(lambda_max_n_per_mm), TAKE(stiff_axis_rad);
    TAKE(theta1_rad), TAKE(theta2_rad), TAKE(mode), TAKE(faults);
    s->parameter_tag = got.parameter_crc & 0xffffu;
}

static const struct {
    uint32_t id, bits, length;
    void (*take)(brace_client_snapshot_t *, const uint8_t *);
} kinds[] = {{BRACE_CAN_ID_STIFFNESS_A, A, 8u, take_a},
             {BRACE_CAN_ID_STIFFNESS_B, B, 8u, take_b},
             {BRACE_CAN_ID_EIGENVALUES, EIGENVALUES, 8u, take_eigenvalues},
             {BRACE_CAN_ID_POSTURE, POSTURE, 8u, take_posture},
             {BRACE_CAN_ID_SNAPSHOT_FD, A | B | EIGENVALUES | POSTURE, 64u, take_whole}};

const brace_client_snapshot_t *brace_joiner_add(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame,
                                                uint32_t lost)
{
    size_t kind = 0u;
    while (kind < sizeof kinds / sizeof kinds[0] && frame->id != kinds[kind].id + node) {
        kind++;
    }
    if (kind == sizeof kinds / sizeof kinds[0] || frame->length != kinds[kind].length) {
        return NULL;
    }
    if (lost != joiner->lost) { /* whatever is begun may have lost its other half */
        memset(joiner, 0, sizeof *joiner);
        joiner->lost = lost;
    }
    brace_joiner_slot_t *slot = slot_of(joiner, frame->data[0], frame->received_us);
    if (slot->frames & kinds[kind].bits) { /* the same frame again: the number has come round, or an adapter repeats */
        begin(slot, frame->data[0], frame->received_us);
    }
    brace_client_snapshot_t *s = &slot->snapshot;
    kinds[kind].take(s, frame->data);
    slot->frames |= kinds[kind].bits;
    s->parts = ((slot->frames & (A | B)) == (A | B) ? BRACE_PART_K : 0u) |
               (slot->frames & EIGENVALUES ? BRACE_PART_EIGENVALUES : 0u) |
               (slot->frames & POSTURE ? BRACE_PART_POSTURE : 0u);
    s->k_is_valid = s->parts & BRACE_PART_K && isfinite(s->k_xx_n_per_mm) && isfinite(s->k_xz_n_per_mm) &&
                    isfinite(s->k_zz_n_per_mm);
    return s->parts != 0u ? s : NULL;
}
