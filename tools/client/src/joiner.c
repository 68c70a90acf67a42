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

static void take_a(brace_client_snapshot_t *s, const uint8_t data[8])
{
    brace_can_stiffness_a_t a;
    brace_can_unpack_stiffness_a(data, &a);
    s->flags = a.flags;
    s->k_xx_n_per_mm = a.k_xx_n_per_mm;
    s->k_xz_n_per_mm = a.k_xz_n_per_mm;
}

static void take_b(brace_client_snapshot_t *s, const uint8_t data[8])
{
    brace_can_stiffness_b_t b;
    brace_can_unpack_stiffness_b(data, &b);
    s->k_zz_n_per_mm = b.k_zz_n_per_mm;
    s->age_ms = b.age_ms;
    s->play_femur = b.play_femur;
    s->play_tibia = b.play_tibia;
    s->parameter_tag = b.parameter_tag;
}

static void take_eigenvalues(brace_client_snapshot_t *s, const uint8_t data[8])
{
    brace_can_eigenvalues_t e;
    brace_can_unpack_eigenvalues(data, &e);
    s->lambda_min_n_per_mm = e.lambda_min_n_per_mm;
    s->lambda_max_n_per_mm = e.lambda_max_n_per_mm;
    s->stiff_axis_rad = e.stiff_axis_rad;
}

static void take_posture(brace_client_snapshot_t *s, const uint8_t data[8])
{
    brace_can_posture_t p;
    brace_can_unpack_posture(data, &p);
    s->theta1_rad = p.theta1_rad;
    s->theta2_rad = p.theta2_rad;
    s->mode = p.mode;
    s->faults = p.faults;
}

static const struct {
    uint32_t id, bit;
    void (*take)(brace_client_snapshot_t *, const uint8_t[8]);
} kinds[] = {{BRACE_CAN_ID_STIFFNESS_A, A, take_a},
             {BRACE_CAN_ID_STIFFNESS_B, B, take_b},
             {BRACE_CAN_ID_EIGENVALUES, EIGENVALUES, take_eigenvalues},
             {BRACE_CAN_ID_POSTURE, POSTURE, take_posture}};

const brace_client_snapshot_t *brace_joiner_add(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame,
                                                uint32_t lost)
{
    size_t kind = 0u;
    while (kind < sizeof kinds / sizeof kinds[0] && frame->id != kinds[kind].id + node) {
        kind++;
    }
    if (kind == sizeof kinds / sizeof kinds[0] || frame->length != 8u) {
        return NULL;
    }
    if (lost != joiner->lost) { /* whatever is begun may have lost its other half */
        memset(joiner, 0, sizeof *joiner);
        joiner->lost = lost;
    }
    brace_joiner_slot_t *slot = slot_of(joiner, frame->data[0], frame->received_us);
    if (slot->frames & kinds[kind].bit) { /* the same frame again: the number has come round, or an adapter repeats */
        begin(slot, frame->data[0], frame->received_us);
    }
    brace_client_snapshot_t *s = &slot->snapshot;
    kinds[kind].take(s, frame->data);
    slot->frames |= kinds[kind].bit;
    s->parts = ((slot->frames & (A | B)) == (A | B) ? BRACE_PART_K : 0u) |
               (slot->frames & EIGENVALUES ? BRACE_PART_EIGENVALUES : 0u) |
               (slot->frames & POSTURE ? BRACE_PART_POSTURE : 0u);
    s->k_is_valid = s->parts & BRACE_PART_K && isfinite(s->k_xx_n_per_mm) && isfinite(s->k_xz_n_per_mm) &&
                    isfinite(s->k_zz_n_per_mm);
    return s->parts != 0u ? s : NULL;
}
