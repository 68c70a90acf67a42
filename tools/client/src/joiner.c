#include "joiner.h"

#include <math.h>
#include <string.h>

#include "brace/can_messages.h"

/* A snapshot's frames, one bit each. Frames of one group follow one another from its first bit on. */
enum {
    A = 1u,
    B = 1u << 1,
    EIGENVALUES = 1u << 2,
    POSTURE = 1u << 3,
    SPACE_0 = 1u << 4,
    LOAD_0 = 1u << 11,
    ACROSS_0 = 1u << 17,
    SIGMA_0 = 1u << 19,
    SIGMA_SPACE_0 = 1u << 21,
    SPACE = 0x7fu * SPACE_0,
    LOAD = 0x3fu * LOAD_0,
    ACROSS = 3u * ACROSS_0,
    SIGMA = 3u * SIGMA_0,
    SIGMA_SPACE = 0xfu * SIGMA_SPACE_0
};

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
    s->sigma = (brace_client_sigma_t){NAN, NAN, NAN, NAN, NAN, NAN};
    s->space_sigma = (brace_client_space_sigma_t){NAN, NAN, NAN, NAN, NAN, NAN, {NAN, NAN, NAN}, NAN};
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
    TAKE(k_xx_n_per_mm), TAKE(k_xz_n_per_mm), TAKE(age_ms);
}

static void take_b(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(stiffness_b);
    TAKE(k_zz_n_per_mm), TAKE(flags), TAKE(play_femur), TAKE(play_tibia), TAKE(mode);
}

static void take_eigenvalues(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(eigenvalues);
    TAKE(lambda_min_n_per_mm), TAKE(lambda_max_n_per_mm), TAKE(stiff_axis_rad);
}

static void take_posture(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(posture);
    TAKE(theta1_rad), TAKE(theta2_rad), TAKE(parameter_tag);
}

static void take_whole(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(snapshot_fd);
    TAKE(flags), TAKE(k_xx_n_per_mm), TAKE(k_xz_n_per_mm), TAKE(k_zz_n_per_mm);
    TAKE(age_ms), TAKE(play_femur), TAKE(play_tibia);
    TAKE(lambda_min_n_per_mm), TAKE(lambda_max_n_per_mm), TAKE(stiff_axis_rad);
    TAKE(theta1_rad), TAKE(theta2_rad), TAKE(mode), TAKE(faults), TAKE(parameter_tag);
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
    s->space.play_coxa = got.play_coxa;
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
    TAKE_LOAD(unloaded_k_zz_n_per_mm);
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

static void take_load_5(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(load_5);
    TAKE_LOAD(gravity_lean_rad);
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

#define TAKE_SIGMA(member) s->sigma.member = got.member

static void take_sigma_0(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_0);
    TAKE_SIGMA(k_xx_n_per_mm), TAKE_SIGMA(k_xz_n_per_mm), TAKE_SIGMA(k_zz_n_per_mm);
}

static void take_sigma_1(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_1);
    TAKE_SIGMA(lambda_min_n_per_mm), TAKE_SIGMA(lambda_max_n_per_mm), TAKE_SIGMA(stiff_axis_rad);
}

#define TAKE_SPACE_SIGMA(member) s->space_sigma.member = got.member

static void take_sigma_space_0(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_space_0);
    TAKE_SPACE_SIGMA(k_xx_n_per_mm), TAKE_SPACE_SIGMA(k_xy_n_per_mm), TAKE_SPACE_SIGMA(k_xz_n_per_mm);
}

static void take_sigma_space_1(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_space_1);
    TAKE_SPACE_SIGMA(k_yy_n_per_mm), TAKE_SPACE_SIGMA(k_yz_n_per_mm), TAKE_SPACE_SIGMA(k_zz_n_per_mm);
}

static void take_sigma_space_2(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_space_2);
    s->space_sigma.lambda_n_per_mm[0] = got.lambda_1_n_per_mm;
    s->space_sigma.lambda_n_per_mm[1] = got.lambda_2_n_per_mm;
    s->space_sigma.lambda_n_per_mm[2] = got.lambda_3_n_per_mm;
}

static void take_sigma_space_3(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_space_3);
    TAKE_SPACE_SIGMA(k_across_n_per_mm);
}

static void take_whole_sigma(brace_client_snapshot_t *s, const uint8_t *data)
{
    UNPACKED(sigma_fd);
    TAKE_SIGMA(k_xx_n_per_mm), TAKE_SIGMA(k_xz_n_per_mm), TAKE_SIGMA(k_zz_n_per_mm);
    TAKE_SIGMA(lambda_min_n_per_mm), TAKE_SIGMA(lambda_max_n_per_mm), TAKE_SIGMA(stiff_axis_rad);
    s->space_sigma = (brace_client_space_sigma_t){
        .k_xx_n_per_mm = got.space_k_xx_n_per_mm,
        .k_xy_n_per_mm = got.space_k_xy_n_per_mm,
        .k_xz_n_per_mm = got.space_k_xz_n_per_mm,
        .k_yy_n_per_mm = got.space_k_yy_n_per_mm,
        .k_yz_n_per_mm = got.space_k_yz_n_per_mm,
        .k_zz_n_per_mm = got.space_k_zz_n_per_mm,
        .lambda_n_per_mm = {got.space_lambda_1_n_per_mm, got.space_lambda_2_n_per_mm, got.space_lambda_3_n_per_mm},
        .k_across_n_per_mm = got.k_across_n_per_mm,
    };
}

typedef struct {
    uint32_t id;   /* of node 0 */
    uint32_t part; /* for frames with one identifier and several parts */
    uint32_t bits, length;
    void (*take)(brace_client_snapshot_t *, const uint8_t *);
} kind_t;

static const kind_t kinds[] = {
    {BRACE_CAN_ID_STIFFNESS_A, 0u, A, 8u, take_a},
    {BRACE_CAN_ID_STIFFNESS_B, 0u, B, 8u, take_b},
    {BRACE_CAN_ID_EIGENVALUES, 0u, EIGENVALUES, 8u, take_eigenvalues},
    {BRACE_CAN_ID_POSTURE, 0u, POSTURE, 8u, take_posture},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_0, SPACE_0, 8u, take_space_0},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_1, SPACE_0 << 1, 8u, take_space_1},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_2, SPACE_0 << 2, 8u, take_space_2},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_3, SPACE_0 << 3, 8u, take_space_3},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_4, SPACE_0 << 4, 8u, take_space_4},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_5, SPACE_0 << 5, 8u, take_space_5},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SPACE_6, SPACE_0 << 6, 8u, take_space_6},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_0, LOAD_0, 8u, take_load_0},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_1, LOAD_0 << 1, 8u, take_load_1},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_2, LOAD_0 << 2, 8u, take_load_2},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_3, LOAD_0 << 3, 8u, take_load_3},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_4, LOAD_0 << 4, 8u, take_load_4},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_5, LOAD_0 << 5, 8u, take_load_5},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_ACROSS_0, ACROSS_0, 8u, take_across_0},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_LOAD_ACROSS_1, ACROSS_0 << 1, 8u, take_across_1},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_0, SIGMA_0, 8u, take_sigma_0},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_1, SIGMA_0 << 1, 8u, take_sigma_1},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_SPACE_0, SIGMA_SPACE_0, 8u, take_sigma_space_0},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_SPACE_1, SIGMA_SPACE_0 << 1, 8u, take_sigma_space_1},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_SPACE_2, SIGMA_SPACE_0 << 2, 8u, take_sigma_space_2},
    {BRACE_CAN_ID_DETAILS, BRACE_CAN_PART_SIGMA_SPACE_3, SIGMA_SPACE_0 << 3, 8u, take_sigma_space_3},
    {BRACE_CAN_ID_SNAPSHOT_FD, 0u, A | B | EIGENVALUES | POSTURE, 64u, take_whole},
    {BRACE_CAN_ID_DETAILS_FD, BRACE_CAN_PART_SPACE_FD, SPACE, 64u, take_whole_space},
    {BRACE_CAN_ID_DETAILS_FD, BRACE_CAN_PART_LOAD_FD, LOAD | ACROSS, 64u, take_whole_load},
    {BRACE_CAN_ID_DETAILS_FD, BRACE_CAN_PART_SIGMA_FD, SIGMA | SIGMA_SPACE, 64u, take_whole_sigma},
};

/* Which of the frames with this identifier it is. */
static uint32_t part_of(uint32_t id, const brace_bus_frame_t *frame)
{
    return id == BRACE_CAN_ID_DETAILS      ? brace_can_details_part(frame->data)
           : id == BRACE_CAN_ID_DETAILS_FD ? brace_can_details_fd_part(frame->data)
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

void brace_joiner_hear_faults(brace_joiner_t *joiner, uint32_t faults, uint32_t lost)
{
    joiner->lost = lost;
    joiner->faults = faults;
    joiner->faults_are_known = true;
}

/* Faults come when they change and with each heartbeat; in a snapshot over CAN FD alone they are its own. */
static bool take_faults(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame)
{
    if (frame->length != 8u) {
        return false;
    }
    if (frame->id == BRACE_CAN_ID_EMERGENCY + node) {
        brace_can_emergency_t emergency;
        brace_can_unpack_emergency(frame->data, &emergency);
        joiner->faults = emergency.faults;
    } else if (frame->id == BRACE_CAN_ID_DETAILS + node &&
               brace_can_details_part(frame->data) == BRACE_CAN_PART_CONDITION) {
        brace_can_condition_t condition;
        brace_can_unpack_condition(frame->data, &condition);
        joiner->faults = condition.faults;
    } else {
        return false;
    }
    joiner->faults_are_known = true;
    return true;
}

static bool is_space_k_known(const brace_client_space_k_t *k)
{
    return isfinite(k->k_xx_n_per_mm) && isfinite(k->k_xy_n_per_mm) && isfinite(k->k_xz_n_per_mm) &&
           isfinite(k->k_yy_n_per_mm) && isfinite(k->k_yz_n_per_mm) && isfinite(k->k_zz_n_per_mm);
}

const brace_client_snapshot_t *brace_joiner_add(brace_joiner_t *joiner, uint32_t node, const brace_bus_frame_t *frame,
                                                uint32_t lost)
{
    if (lost != joiner->lost) { /* a snapshot that has begun may have lost its other half, and a fault its news */
        memset(joiner, 0, sizeof *joiner);
        joiner->lost = lost;
    }
    const kind_t *kind = take_faults(joiner, node, frame) ? NULL : kind_of(frame, node);
    if (kind == NULL) {
        return NULL;
    }
    brace_joiner_slot_t *slot = slot_of(joiner, frame->data[0], frame->received_us);
    if (slot->frames & kind->bits) { /* the same frame again: the number wrapped, or an adapter repeats */
        begin(slot, frame->data[0], frame->received_us);
    }
    brace_client_snapshot_t *s = &slot->snapshot;
    s->faults = joiner->faults_are_known ? joiner->faults : UINT32_MAX;
    kind->take(s, frame->data);
    slot->frames |= kind->bits;
    s->parts = ((slot->frames & (A | B)) == (A | B) ? BRACE_PART_K : 0u) |
               (slot->frames & EIGENVALUES ? BRACE_PART_EIGENVALUES : 0u) |
               (slot->frames & POSTURE ? BRACE_PART_POSTURE : 0u) |
               ((slot->frames & SPACE) == SPACE ? BRACE_PART_SPACE : 0u) |
               ((slot->frames & LOAD) == LOAD ? BRACE_PART_LOAD : 0u) |
               ((slot->frames & ACROSS) == ACROSS ? BRACE_PART_LOAD_ACROSS : 0u) |
               ((slot->frames & SIGMA) == SIGMA ? BRACE_PART_SIGMA : 0u) |
               ((slot->frames & SIGMA_SPACE) == SIGMA_SPACE ? BRACE_PART_SIGMA_SPACE : 0u);
    s->k_is_valid = s->parts & BRACE_PART_K && isfinite(s->k_xx_n_per_mm) && isfinite(s->k_xz_n_per_mm) &&
                    isfinite(s->k_zz_n_per_mm);
    s->space.k_is_valid = s->parts & BRACE_PART_SPACE && is_space_k_known(&s->space.k);
    return s->parts != 0u ? s : NULL;
}
