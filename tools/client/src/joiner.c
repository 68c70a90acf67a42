#include "joiner.h"

#include <math.h>
#include <string.h>

#include "brace/can_messages.h"

enum {
    A = 1,
    B = 2,
    EIGENVALUES = 4,
    POSTURE = 8,
    SPACE_0 = 16,
    LOAD_0 = SPACE_0 << BRACE_CAN_SPACE_PARTS,
    ACROSS_0 = LOAD_0 << BRACE_CAN_LOAD_PARTS
};
/* further parts of these three take the bits after their first ones */
#define SPACE (((1u << BRACE_CAN_SPACE_PARTS) - 1u) * SPACE_0)
#define LOAD (((1u << BRACE_CAN_LOAD_PARTS) - 1u) * LOAD_0)
#define ACROSS (((1u << BRACE_CAN_LOAD_ACROSS_PARTS) - 1u) * ACROSS_0)

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
    brace_client_space_t *space = &s->space;
    brace_client_space_k_t *k = &space->k;
    k->k_xx_n_per_mm = k->k_xy_n_per_mm = k->k_xz_n_per_mm = NAN;
    k->k_yy_n_per_mm = k->k_yz_n_per_mm = k->k_zz_n_per_mm = NAN;
    for (int i = 0; i < 3; i++) {
        k->lambda_n_per_mm[i] = space->stiff_axis[i] = NAN;
    }
    space->theta0_rad = space->k_across_n_per_mm = NAN;
    k->flags = space->play_coxa = UINT32_MAX;
    s->load = (brace_client_load_t){false, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    s->flags = s->play_femur = s->play_tibia = s->parameter_tag = s->mode = s->faults = UINT32_MAX;
}

/* The slot of this number; if there is none, the older slot, begun anew. */
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

/* Copies a frame's members into those of the snapshot with the same names. */
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

#define TAKE_K(member) s->space.k.member = got.member

static void take_space_0(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_0);
    TAKE_K(k_xx_n_per_mm), TAKE_K(k_xy_n_per_mm);
}

static void take_space_1(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_1);
    TAKE_K(k_xz_n_per_mm), TAKE_K(k_yy_n_per_mm);
}

static void take_space_2(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_2);
    TAKE_K(k_yz_n_per_mm), TAKE_K(k_zz_n_per_mm);
}

static void take_space_3(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_3);
    s->space.k.lambda_n_per_mm[0] = got.lambda_1_n_per_mm;
    s->space.k.lambda_n_per_mm[1] = got.lambda_2_n_per_mm;
}

static void take_space_4(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_4);
    TAKE_K(flags);
    s->space.k.lambda_n_per_mm[2] = got.lambda_3_n_per_mm;
    s->space.play_coxa = got.play_coxa;
}

static void take_space_5(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_5);
    s->space.stiff_axis[0] = got.stiff_axis_x;
    s->space.stiff_axis[1] = got.stiff_axis_y;
    s->space.stiff_axis[2] = got.stiff_axis_z;
}

static void take_space_6(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_6);
    s->space.theta0_rad = got.theta0_rad;
    s->space.k_across_n_per_mm = got.k_across_n_per_mm;
}

static void take_whole_space(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(space_fd);
    TAKE_K(k_xx_n_per_mm), TAKE_K(k_xy_n_per_mm), TAKE_K(k_xz_n_per_mm);
    TAKE_K(k_yy_n_per_mm), TAKE_K(k_yz_n_per_mm), TAKE_K(k_zz_n_per_mm), TAKE_K(flags);
    s->space.k.lambda_n_per_mm[0] = got.lambda_1_n_per_mm;
    s->space.k.lambda_n_per_mm[1] = got.lambda_2_n_per_mm;
    s->space.k.lambda_n_per_mm[2] = got.lambda_3_n_per_mm;
    s->space.stiff_axis[0] = got.stiff_axis_x;
    s->space.stiff_axis[1] = got.stiff_axis_y;
    s->space.stiff_axis[2] = got.stiff_axis_z;
    s->space.theta0_rad = got.theta0_rad;
    s->space.k_across_n_per_mm = got.k_across_n_per_mm;
    s->space.play_coxa = got.play_coxa;
}

#define TAKE_LOAD(member) s->load.member = got.member

static void take_load_0(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_0);
    TAKE_LOAD(unloaded_k_xx_n_per_mm), TAKE_LOAD(unloaded_k_xz_n_per_mm);
}

static void take_load_1(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_1);
    TAKE_LOAD(unloaded_k_zz_n_per_mm), TAKE_LOAD(gravity_lean_rad);
}

static void take_counted_force(brace_client_load_t *load, float force_x_n, float force_z_n)
{
    load->force_x_n = force_x_n;
    load->force_z_n = force_z_n;
    load->is_counted = isfinite(force_x_n) && isfinite(force_z_n);
}

static void take_load_2(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_2);
    take_counted_force(&s->load, got.counted_force_x_n, got.counted_force_z_n);
}

static void take_load_3(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_3);
    TAKE_LOAD(moved_x_mm), TAKE_LOAD(moved_z_mm);
}

static void take_load_4(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_4);
    TAKE_LOAD(buckling_factor), TAKE_LOAD(gravity_direction_rad);
}

static void take_across(brace_client_load_t *load, float force_y_n, float moved_y_mm)
{
    load->force_y_n = force_y_n;
    load->moved_y_mm = moved_y_mm;
}

static void take_across_0(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_across_0);
    take_across(&s->load, got.counted_force_y_n, got.moved_y_mm);
}

static void take_across_1(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_across_1);
    TAKE_LOAD(unloaded_k_across_n_per_mm);
}

static void take_whole_load(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_fd);
    TAKE_LOAD(unloaded_k_xx_n_per_mm), TAKE_LOAD(unloaded_k_xz_n_per_mm), TAKE_LOAD(unloaded_k_zz_n_per_mm);
    take_counted_force(&s->load, got.counted_force_x_n, got.counted_force_z_n);
    TAKE_LOAD(moved_x_mm), TAKE_LOAD(moved_z_mm), TAKE_LOAD(buckling_factor);
    TAKE_LOAD(gravity_direction_rad), TAKE_LOAD(gravity_lean_rad);
    take_across(&s->load, got.counted_force_y_n, got.moved_y_mm);
    TAKE_LOAD(unloaded_k_across_n_per_mm);
}

typedef struct {
    uint32_t id;   /* of node 0 */
    uint32_t part; /* for frames with one identifier and several parts */
    uint32_t bits, length;
    void (*take)(brace_client_snapshot_t *, const uint8_t *);
} kind_t;

static const kind_t kinds[] = {{BRACE_CAN_ID_STIFFNESS_A, 0u, A, 8u, take_a},
                               {BRACE_CAN_ID_STIFFNESS_B, 0u, B, 8u, take_b},
                               {BRACE_CAN_ID_EIGENVALUES, 0u, EIGENVALUES, 8u, take_eigenvalues},
                               {BRACE_CAN_ID_POSTURE, 0u, POSTURE, 8u, take_posture},
                               {BRACE_CAN_ID_SPACE, 0u, SPACE_0, 8u, take_space_0},
                               {BRACE_CAN_ID_SPACE, 1u, SPACE_0 << 1, 8u, take_space_1},
                               {BRACE_CAN_ID_SPACE, 2u, SPACE_0 << 2, 8u, take_space_2},
                               {BRACE_CAN_ID_SPACE, 3u, SPACE_0 << 3, 8u, take_space_3},
                               {BRACE_CAN_ID_SPACE, 4u, SPACE_0 << 4, 8u, take_space_4},
                               {BRACE_CAN_ID_SPACE, 5u, SPACE_0 << 5, 8u, take_space_5},
                               {BRACE_CAN_ID_SPACE, 6u, SPACE_0 << 6, 8u, take_space_6},
                               {BRACE_CAN_ID_LOAD, 0u, LOAD_0, 8u, take_load_0},
                               {BRACE_CAN_ID_LOAD, 1u, LOAD_0 << 1, 8u, take_load_1},
                               {BRACE_CAN_ID_LOAD, 2u, LOAD_0 << 2, 8u, take_load_2},
                               {BRACE_CAN_ID_LOAD, 3u, LOAD_0 << 3, 8u, take_load_3},
                               {BRACE_CAN_ID_LOAD, 4u, LOAD_0 << 4, 8u, take_load_4},
                               {BRACE_CAN_ID_LOAD_ACROSS, 0u, ACROSS_0, 8u, take_across_0},
                               {BRACE_CAN_ID_LOAD_ACROSS, 1u, ACROSS_0 << 1, 8u, take_across_1},
                               {BRACE_CAN_ID_SNAPSHOT_FD, 0u, A | B | EIGENVALUES | POSTURE, 64u, take_whole},
                               {BRACE_CAN_ID_SPACE_FD, 0u, SPACE, 64u, take_whole_space},
                               {BRACE_CAN_ID_LOAD_FD, 0u, LOAD | ACROSS, 64u, take_whole_load}};

/* Which of the frames with this identifier it is. */
static uint32_t part_of(uint32_t id, const brace_bus_frame_t *frame)
{
    return id == BRACE_CAN_ID_SPACE         ? brace_can_space_part(frame->data)
           : id == BRACE_CAN_ID_LOAD        ? brace_can_load_part(frame->data)
           : id == BRACE_CAN_ID_LOAD_ACROSS ? brace_can_load_across_part(frame->data)
                                            : 0u;
}

static const kind_t *kind_of(const brace_bus_frame_t *frame, uint32_t node)
{
    for (size_t i = 0u; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (frame->id == kinds[i].id + node && frame->length == kinds[i].length &&
            part_of(kinds[i].id, frame) == kinds[i].part) {
            return &kinds[i];
        }
    }
    return NULL;
}

static bool is_space_k_known(const brace_client_space_k_t *k)
{
    return isfinite(k->k_xx_n_per_mm) && isfinite(k->k_xy_n_per_mm) && isfinite(k->k_xz_n_per_mm) &&
           isfinite(k->k_yy_n_per_mm) && isfinite(k->k_yz_n_per_mm) && isfinite(k->k_zz_n_per_mm);
}

const brace_client_snapshot_t *brace_joiner_add(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame,
                                                uint32_t lost)
{
    const kind_t *kind = kind_of(frame, node);
    if (kind == NULL) {
        return NULL;
    }
    if (lost != joiner->lost) { /* a snapshot that has begun may have lost its other half */
        memset(joiner, 0, sizeof *joiner);
        joiner->lost = lost;
    }
    brace_joiner_slot_t *slot = slot_of(joiner, frame->data[0], frame->received_us);
    if (slot->frames & kind->bits) { /* the same frame again: the number wrapped, or an adapter repeats */
        begin(slot, frame->data[0], frame->received_us);
    }
    brace_client_snapshot_t *s = &slot->snapshot;
    kind->take(s, frame->data);
    slot->frames |= kind->bits;
    s->parts = ((slot->frames & (A | B)) == (A | B) ? BRACE_PART_K : 0u) |
               (slot->frames & EIGENVALUES ? BRACE_PART_EIGENVALUES : 0u) |
               (slot->frames & POSTURE ? BRACE_PART_POSTURE : 0u) |
               ((slot->frames & SPACE) == SPACE ? BRACE_PART_SPACE : 0u) |
               ((slot->frames & LOAD) == LOAD ? BRACE_PART_LOAD : 0u) |
               ((slot->frames & ACROSS) == ACROSS ? BRACE_PART_LOAD_ACROSS : 0u);
    s->k_is_valid = s->parts & BRACE_PART_K && isfinite(s->k_xx_n_per_mm) && isfinite(s->k_xz_n_per_mm) &&
                    isfinite(s->k_zz_n_per_mm);
    s->space.k_is_valid = s->parts & BRACE_PART_SPACE && is_space_k_known(&s->space.k);
    return s->parts != 0u ? s : NULL;
}
