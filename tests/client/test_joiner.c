/* A snapshot's frames put together: everything of one tick or nothing. */
#include "joiner.h"

#include <math.h>
#include <string.h>
#include <unity.h>

#include "brace/can_messages.h"

enum { NODE = 9, TICK_US = 250 };

void setUp(void) {}
void tearDown(void) {}

/* Every member of a snapshot encodes the tick it is of: 19 bits of it. */
static float mark(uint32_t tick)
{
    return (float)(tick & 0x7ffffu) * 0.002f; /* whole steps of 0.0005 N/mm, within every range used */
}

static uint32_t tick_of(float value)
{
    return (uint32_t)lroundf(value / 0.002f);
}

static brace_bus_frame_t frame_of(uint32_t kind, uint32_t tick, uint64_t now_us)
{
    static const uint32_t id[] = {BRACE_CAN_ID_STIFFNESS_A, BRACE_CAN_ID_STIFFNESS_B, BRACE_CAN_ID_EIGENVALUES,
                                  BRACE_CAN_ID_POSTURE};
    brace_bus_frame_t frame = {.id = id[kind] + NODE, .length = 8u, .received_us = now_us};
    const uint32_t sequence = tick & 0xffu;
    if (kind == 0u) {
        const brace_can_stiffness_a_t a = {
            .sequence = sequence, .k_xx_n_per_mm = mark(tick), .k_xz_n_per_mm = mark(tick), .age_ms = 0.5f};
        (void)brace_can_pack_stiffness_a(&a, frame.data);
    } else if (kind == 1u) {
        const brace_can_stiffness_b_t b = {.sequence = sequence, .k_zz_n_per_mm = mark(tick)};
        (void)brace_can_pack_stiffness_b(&b, frame.data);
    } else if (kind == 2u) {
        const brace_can_eigenvalues_t e = {.sequence = sequence,
                                           .lambda_max_n_per_mm = (float)(tick & 0x7ffffu) * 0.005f};
        (void)brace_can_pack_eigenvalues(&e, frame.data);
    } else {
        const brace_can_posture_t p = {.sequence = sequence, .theta1_rad = (float)(tick & 0x7ffffu) * 2e-5f};
        (void)brace_can_pack_posture(&p, frame.data);
    }
    return frame;
}

static void is_of_one_tick(const brace_client_snapshot_t *s)
{
    uint32_t tick = UINT32_MAX;
    if (s->parts & BRACE_PART_K) {
        tick = tick_of(s->k_xx_n_per_mm);
        TEST_ASSERT_EQUAL_UINT32(tick, tick_of(s->k_xz_n_per_mm));
        TEST_ASSERT_EQUAL_UINT32(tick, tick_of(s->k_zz_n_per_mm));
        TEST_ASSERT_EQUAL_UINT32(tick & 0xffu, s->sequence);
        TEST_ASSERT_TRUE(s->k_is_valid);
    }
    if (s->parts & BRACE_PART_EIGENVALUES) {
        const uint32_t of_eigenvalues = (uint32_t)lroundf(s->lambda_max_n_per_mm / 0.005f);
        TEST_ASSERT_EQUAL_UINT32(tick == UINT32_MAX ? of_eigenvalues : tick, of_eigenvalues);
        tick = of_eigenvalues;
    }
    if (s->parts & BRACE_PART_POSTURE) {
        const uint32_t of_posture = (uint32_t)lroundf(s->theta1_rad / 2e-5f);
        TEST_ASSERT_EQUAL_UINT32(tick == UINT32_MAX ? of_posture : tick, of_posture);
    }
}

static uint32_t state = 1u;

static uint32_t random_below(uint32_t limit)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state % limit;
}

/* 1.2 million snapshots, each frame of them lost with probability 1/8, whole stretches of random length lost too (the
 * receiver's queue was full: reported; the sender's: not reported, time passes). */
static void test_no_snapshot_is_of_two_ticks(void)
{
    brace_joiner_t joiner = {0};
    uint32_t tick = 0u, lost = 0u, whole = 0u, complete = 0u;
    for (uint32_t i = 0u; i < 1200000u; i++) {
        tick += 1u + random_below(20u);
        bool skipping = false;
        for (uint32_t kind = 0u; kind < 4u; kind++) {
            const uint32_t fate = random_below(4000u);
            if (fate < 500u) { /* lost without a word */
                continue;
            }
            if (fate == 500u) { /* a queue overflowed: reported with the frame after */
                lost += 1u + random_below(5u);
                tick += random_below(600u);
                skipping = true;
            } else if (fate == 501u) { /* the sender had no room for a while */
                tick += 160u + random_below(2000u);
                skipping = true;
            }
            const brace_bus_frame_t frame = frame_of(kind, tick, 1000u + (uint64_t)tick * TICK_US + kind * 130u);
            const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, lost);
            if (s != NULL) {
                is_of_one_tick(s);
                whole += (s->parts & BRACE_PART_K) != 0u && kind == 1u;
                complete += s->parts == BRACE_PART_ALL;
            }
        }
        tick += skipping ? 1u : 0u;
    }
    /* what no loss touched comes out: (7/8)^2 and (7/8)^4 of all */
    TEST_ASSERT_GREATER_THAN_UINT32(900000u, whole);
    TEST_ASSERT_GREATER_THAN_UINT32(690000u, complete);
}

static void test_halves_of_two_rounds_of_the_number_do_not_meet(void)
{
    brace_joiner_t joiner = {0};
    const brace_bus_frame_t a = frame_of(0u, 5u, 1000u);
    const brace_bus_frame_t b = frame_of(1u, 5u + 256u, 1000u + 256u * TICK_US);
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &a, 0u));
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &b, 0u));
}

static void test_a_loss_in_between_parts_the_halves(void)
{
    brace_joiner_t joiner = {0};
    const brace_bus_frame_t a = frame_of(0u, 5u, 1000u);
    const brace_bus_frame_t b = frame_of(1u, 5u, 1100u);
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &a, 0u));
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &b, 1u));
}

static void test_a_newer_k_may_overtake_an_older_posture(void)
{
    brace_joiner_t joiner = {0};
    const uint32_t kinds[] = {0u, 1u, 2u, 0u, 1u, 3u}, ticks[] = {5u, 5u, 5u, 10u, 10u, 5u};
    const brace_client_snapshot_t *s = NULL;
    for (uint32_t i = 0u; i < 6u; i++) {
        const brace_bus_frame_t frame = frame_of(kinds[i], ticks[i], 1000u + 200u * i);
        s = brace_joiner_add(&joiner, NODE, &frame, 0u);
    }
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_ALL, s->parts);
    TEST_ASSERT_EQUAL_UINT32(5u, s->sequence);
    is_of_one_tick(s);
}

static void test_others_and_short_frames_are_passed_over(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t a = frame_of(0u, 5u, 1000u), b = frame_of(1u, 5u, 1100u);
    a.id++;
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &a, 0u));
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &b, 0u));
    a.id--;
    a.length = 7u;
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &a, 0u));
}

static void test_an_unknown_k_is_not_valid_and_never_zero(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t a = frame_of(0u, 5u, 1000u), b = frame_of(1u, 5u, 1100u);
    const brace_can_stiffness_a_t unknown = {.sequence = 5u, .k_xx_n_per_mm = NAN, .k_xz_n_per_mm = NAN};
    (void)brace_can_pack_stiffness_a(&unknown, a.data);
    (void)brace_joiner_add(&joiner, NODE, &a, 0u);
    const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &b, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_FALSE(s->k_is_valid);
    TEST_ASSERT_TRUE(isnan(s->k_xx_n_per_mm));
    TEST_ASSERT_TRUE(isnan(s->lambda_min_n_per_mm));
    TEST_ASSERT_TRUE(isnan(s->theta1_rad));
}

static void test_a_frame_of_can_fd_is_a_whole_snapshot(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t frame = {
        .id = BRACE_CAN_ID_SNAPSHOT_FD + NODE, .length = 64u, .fd = true, .received_us = 1000000u};
    const brace_can_snapshot_fd_t sent = {.sequence = 0x12345607u,
                                          .parameter_tag = 0x1234u,
                                          .age_ms = 1.5f,
                                          .flags = 9u,
                                          .mode = 1u,
                                          .faults = 0x84u,
                                          .play_tibia = 3u,
                                          .k_xx_n_per_mm = 4.0f,
                                          .k_xz_n_per_mm = -0.5f,
                                          .k_zz_n_per_mm = 1.0f,
                                          .lambda_min_n_per_mm = 0.9f,
                                          .lambda_max_n_per_mm = 4.1f,
                                          .stiff_axis_rad = 0.2f,
                                          .theta1_rad = 0.25f,
                                          .theta2_rad = 1.25f};
    TEST_ASSERT_EQUAL(0, brace_can_pack_snapshot_fd(&sent, frame.data));
    const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL(BRACE_PART_ALL, s->parts);
    TEST_ASSERT_TRUE(s->k_is_valid);
    TEST_ASSERT_EQUAL(7, s->sequence);
    TEST_ASSERT_EQUAL_HEX16(0x1234, s->parameter_tag);
    TEST_ASSERT_EQUAL_FLOAT(4.0f, s->k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(-0.5f, s->k_xz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, s->k_zz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.9f, s->lambda_min_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(4.1f, s->lambda_max_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.2f, s->stiff_axis_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, s->theta1_rad);
    TEST_ASSERT_EQUAL_FLOAT(1.25f, s->theta2_rad);
    TEST_ASSERT_EQUAL_FLOAT(1.5f, s->age_ms);
    TEST_ASSERT_EQUAL(9, s->flags);
    TEST_ASSERT_EQUAL(0x84, s->faults);
    TEST_ASSERT_EQUAL(3, s->play_tibia);
    frame.length = 48u;
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &frame, 0u));
}

/* ------------------------------------------------------------------------------------------ K in space -- */

/* Parts 0 to 6 of K in space; every value encodes the tick, as in frame_of. */
static brace_bus_frame_t space_frame_of(uint32_t part, uint32_t tick, uint64_t now_us)
{
    const uint32_t sequence = tick & 0xffu;
    const float m = mark(tick);
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_DETAILS + NODE, .length = 8u, .received_us = now_us};
    const brace_can_space_0_t first = {.sequence = sequence, .k_xx_n_per_mm = m, .k_xy_n_per_mm = m};
    const brace_can_space_1_t second = {.sequence = sequence, .k_xz_n_per_mm = m, .k_yy_n_per_mm = m};
    const brace_can_space_2_t third = {.sequence = sequence, .k_yz_n_per_mm = m, .k_zz_n_per_mm = m};
    const brace_can_space_3_t lower = {.sequence = sequence, .lambda_1_n_per_mm = m, .lambda_2_n_per_mm = m};
    const brace_can_space_4_t largest = {.sequence = sequence, .lambda_3_n_per_mm = m, .flags = 8u};
    const brace_can_space_5_t axis = {
        .sequence = sequence, .stiff_axis_x = 0.0f, .stiff_axis_y = -0.5f, .stiff_axis_z = 1.0f};
    const brace_can_space_6_t coxa = {
        .sequence = sequence, .theta0_rad = 0.25f, .k_across_n_per_mm = m, .play_coxa = 2u};
    switch (part) {
    case 0u: (void)brace_can_pack_space_0(&first, frame.data); break;
    case 1u: (void)brace_can_pack_space_1(&second, frame.data); break;
    case 2u: (void)brace_can_pack_space_2(&third, frame.data); break;
    case 3u: (void)brace_can_pack_space_3(&lower, frame.data); break;
    case 4u: (void)brace_can_pack_space_4(&largest, frame.data); break;
    case 5u: (void)brace_can_pack_space_5(&axis, frame.data); break;
    default: (void)brace_can_pack_space_6(&coxa, frame.data); break;
    }
    return frame;
}

static void space_is_of_tick(const brace_client_space_t *space, uint32_t tick)
{
    const brace_client_space_k_t *k = &space->k;
    const float values[] = {k->k_xx_n_per_mm,        k->k_xy_n_per_mm,      k->k_xz_n_per_mm,
                            k->k_yy_n_per_mm,        k->k_yz_n_per_mm,      k->k_zz_n_per_mm,
                            k->lambda_n_per_mm[0],   k->lambda_n_per_mm[1], k->lambda_n_per_mm[2],
                            space->k_across_n_per_mm};
    for (uint32_t i = 0u; i < sizeof values / sizeof values[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32(tick & 0x7ffffu, tick_of(values[i]));
    }
}

static void test_k_in_space_is_a_part_of_its_snapshot(void)
{
    brace_joiner_t joiner = {0};
    const brace_client_snapshot_t *s = NULL;
    const brace_bus_frame_t a = frame_of(0u, 77u, 1000u), b = frame_of(1u, 77u, 1100u);
    (void)brace_joiner_add(&joiner, NODE, &a, 0u);
    for (uint32_t part = 0u; part < 7u; part++) { /* the lower identifier: before the second half of K in the plane */
        const brace_bus_frame_t frame = space_frame_of(part, 77u, 1010u + part);
        s = brace_joiner_add(&joiner, NODE, &frame, 0u);
        TEST_ASSERT_TRUE((s != NULL) == (part == 6u));
    }
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_SPACE, s->parts);
    s = brace_joiner_add(&joiner, NODE, &b, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_K | BRACE_PART_SPACE, s->parts);
    TEST_ASSERT_TRUE(s->k_is_valid && s->space.k_is_valid);
    space_is_of_tick(&s->space, 77u);
    TEST_ASSERT_EQUAL_UINT32(8u, s->space.k.flags);
    TEST_ASSERT_EQUAL_UINT32(2u, s->space.play_coxa);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, s->space.theta0_rad);
    TEST_ASSERT_EQUAL_FLOAT(-0.5f, s->space.stiff_axis[1]);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, s->space.stiff_axis[2]);
}

static void test_k_in_space_is_never_of_two_ticks(void)
{
    brace_joiner_t joiner = {0};
    uint32_t tick = 0u, whole = 0u;
    for (uint32_t i = 0u; i < 200000u; i++) {
        tick += 1u + random_below(300u); /* the number comes round within a few */
        for (uint32_t part = 0u; part < 9u; part++) {
            if (random_below(20u) == 0u) {
                continue;
            }
            const uint64_t now_us = 1000u + (uint64_t)tick * TICK_US + part * 130u;
            const brace_bus_frame_t frame =
                part < 2u ? frame_of(part, tick, now_us) : space_frame_of(part - 2u, tick, now_us);
            const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, 0u);
            if (s != NULL && (s->parts & BRACE_PART_SPACE) != 0u) {
                space_is_of_tick(&s->space, tick);
                whole++;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(120000u, whole); /* (19/20)^7 of all */
}

static void test_an_unknown_k_in_space_is_not_valid(void)
{
    brace_joiner_t joiner = {0};
    const brace_client_snapshot_t *s = NULL;
    for (uint32_t part = 0u; part < 7u; part++) {
        brace_bus_frame_t frame = space_frame_of(part, 5u, 1000u + part);
        const brace_can_space_2_t unknown = {.sequence = 5u, .k_yz_n_per_mm = NAN, .k_zz_n_per_mm = 1.0f};
        if (part == 2u) {
            (void)brace_can_pack_space_2(&unknown, frame.data);
        }
        s = brace_joiner_add(&joiner, NODE, &frame, 0u);
    }
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_FALSE(s->space.k_is_valid);
    TEST_ASSERT_TRUE(isnan(s->space.k.k_yz_n_per_mm));
    TEST_ASSERT_TRUE(isnan(s->k_xx_n_per_mm));
}

static void test_over_can_fd_k_in_space_is_a_second_frame(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t whole = {.id = BRACE_CAN_ID_SNAPSHOT_FD + NODE, .length = 64u, .fd = true, .received_us = 1000u};
    brace_bus_frame_t space = {.id = BRACE_CAN_ID_DETAILS_FD + NODE, .length = 64u, .fd = true, .received_us = 1100u};
    const brace_can_snapshot_fd_t plane = {.sequence = 0x12345607u, .k_xx_n_per_mm = 4.0f};
    const brace_can_space_fd_t sent = {.sequence = 7u,
                                       .k_xx_n_per_mm = 3.5f,
                                       .lambda_3_n_per_mm = 4.5f,
                                       .theta0_rad = 0.5f,
                                       .play_coxa = 3u,
                                       .stiff_axis_y = 0.25f};
    (void)brace_can_pack_snapshot_fd(&plane, whole.data);
    (void)brace_can_pack_space_fd(&sent, space.data);
    (void)brace_joiner_add(&joiner, NODE, &whole, 0u);
    const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &space, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_ALL | BRACE_PART_SPACE, s->parts);
    TEST_ASSERT_TRUE(s->space.k_is_valid);
    TEST_ASSERT_EQUAL_FLOAT(3.5f, s->space.k.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(4.5f, s->space.k.lambda_n_per_mm[2]);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, s->space.theta0_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, s->space.stiff_axis[1]);
    TEST_ASSERT_EQUAL_UINT32(3u, s->space.play_coxa);
}

/* ---------------------------------------------------------------------------------------------- the load -- */

/* The six frames of the load; every value encodes the tick. */
static brace_bus_frame_t load_frame_of(uint32_t part, uint32_t tick, uint64_t now_us)
{
    const uint32_t sequence = tick & 0xffu;
    const float m = mark(tick);
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_DETAILS + NODE, .length = 8u, .received_us = now_us};
    const brace_can_load_0_t first = {.sequence = sequence, .unloaded_k_xx_n_per_mm = m, .unloaded_k_xz_n_per_mm = m};
    const brace_can_load_1_t second = {.sequence = sequence, .unloaded_k_zz_n_per_mm = m};
    const brace_can_load_2_t force = {.sequence = sequence, .counted_force_x_n = m, .counted_force_z_n = m};
    const brace_can_load_3_t moved = {.sequence = sequence, .moved_x_mm = m, .moved_z_mm = m};
    const brace_can_load_4_t factor = {.sequence = sequence, .buckling_factor = m, .gravity_direction_rad = -1.5f};
    const brace_can_load_5_t last = {.sequence = sequence, .gravity_lean_rad = 0.25f};
    switch (part) {
    case 0u: (void)brace_can_pack_load_0(&first, frame.data); break;
    case 1u: (void)brace_can_pack_load_1(&second, frame.data); break;
    case 2u: (void)brace_can_pack_load_2(&force, frame.data); break;
    case 3u: (void)brace_can_pack_load_3(&moved, frame.data); break;
    case 4u: (void)brace_can_pack_load_4(&factor, frame.data); break;
    default: (void)brace_can_pack_load_5(&last, frame.data); break;
    }
    return frame;
}

static void load_is_of_tick(const brace_client_load_t *load, uint32_t tick)
{
    const float values[] = {load->unloaded_k_xx_n_per_mm,
                            load->unloaded_k_xz_n_per_mm,
                            load->unloaded_k_zz_n_per_mm,
                            load->force_x_n,
                            load->force_z_n,
                            load->moved_x_mm,
                            load->moved_z_mm,
                            load->buckling_factor};
    for (uint32_t i = 0u; i < sizeof values / sizeof values[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32(tick & 0x7ffffu, tick_of(values[i]));
    }
    TEST_ASSERT_TRUE(load->is_counted);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, load->gravity_lean_rad);
    TEST_ASSERT_EQUAL_FLOAT(-1.5f, load->gravity_direction_rad);
}

/* The load's identifier is the lowest, so its frames come before K. Some are lost, and the number comes round. */
static void test_a_load_is_of_its_k_s_tick(void)
{
    brace_joiner_t joiner = {0};
    uint32_t tick = 0u, whole = 0u;
    for (uint32_t i = 0u; i < 200000u; i++) {
        tick += 1u + random_below(300u);
        for (uint32_t part = 0u; part < 8u; part++) {
            if (random_below(20u) == 0u) {
                continue;
            }
            const uint64_t now_us = 1000u + (uint64_t)tick * TICK_US + part * 130u;
            const brace_bus_frame_t frame =
                part < 6u ? load_frame_of(part, tick, now_us) : frame_of(part - 6u, tick, now_us);
            const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, 0u);
            if (s != NULL && (s->parts & BRACE_PART_LOAD) != 0u) {
                load_is_of_tick(&s->load, tick);
            }
            if (s != NULL && s->parts == (BRACE_PART_K | BRACE_PART_LOAD)) {
                is_of_one_tick(s);
                whole++;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(125000u, whole); /* (19/20)^8 of all */
}

/* What is across the plane comes in frames of its own with a higher identifier: before the load or behind it. */
static void test_a_load_across_the_plane(void)
{
    for (uint32_t behind = 0u; behind < 2u; behind++) {
        brace_joiner_t joiner = {0};
        const brace_client_snapshot_t *s = NULL;
        for (uint32_t i = 0u; i < 8u; i++) {
            const uint32_t part = behind != 0u ? i : (i + 6u) % 8u;
            brace_bus_frame_t frame = load_frame_of(part % 6u, 5u, 1000u + i);
            if (part >= 6u) {
                const brace_can_load_across_0_t force = {
                    .sequence = 5u, .counted_force_y_n = -2.5f, .moved_y_mm = -7.0f};
                const brace_can_load_across_1_t k = {.sequence = 5u, .unloaded_k_across_n_per_mm = 0.5f};
                (void)(part == 6u ? brace_can_pack_load_across_0(&force, frame.data)
                                  : brace_can_pack_load_across_1(&k, frame.data));
            }
            s = brace_joiner_add(&joiner, NODE, &frame, 0u);
        }
        TEST_ASSERT_NOT_NULL(s);
        TEST_ASSERT_EQUAL_UINT32(BRACE_PART_LOAD | BRACE_PART_LOAD_ACROSS, s->parts);
        load_is_of_tick(&s->load, 5u);
        TEST_ASSERT_EQUAL_FLOAT(-2.5f, s->load.force_y_n);
        TEST_ASSERT_EQUAL_FLOAT(-7.0f, s->load.moved_y_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.5f, s->load.unloaded_k_across_n_per_mm);
    }
}

static void test_a_load_that_is_not_counted(void)
{
    brace_joiner_t joiner = {0};
    const brace_client_snapshot_t *s = NULL;
    for (uint32_t part = 0u; part < 6u; part++) {
        brace_bus_frame_t frame = load_frame_of(part, 5u, 1000u + part);
        const brace_can_load_2_t unknown = {.sequence = 5u, .counted_force_x_n = NAN, .counted_force_z_n = NAN};
        if (part == 2u) {
            (void)brace_can_pack_load_2(&unknown, frame.data);
        }
        s = brace_joiner_add(&joiner, NODE, &frame, 0u);
    }
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_LOAD, s->parts);
    TEST_ASSERT_FALSE(s->load.is_counted);
    TEST_ASSERT_TRUE(isnan(s->load.force_x_n));
    TEST_ASSERT_TRUE(isnan(s->k_xx_n_per_mm));
}

static void test_over_can_fd_a_load_is_a_frame_of_its_own(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t whole = {.id = BRACE_CAN_ID_SNAPSHOT_FD + NODE, .length = 64u, .fd = true, .received_us = 1000u};
    brace_bus_frame_t load = {.id = BRACE_CAN_ID_DETAILS_FD + NODE, .length = 64u, .fd = true, .received_us = 1100u};
    const brace_can_snapshot_fd_t plane = {.sequence = 0x12345607u, .k_xx_n_per_mm = 4.0f};
    const brace_can_load_fd_t sent = {.sequence = 7u,
                                      .unloaded_k_xx_n_per_mm = 1.0f,
                                      .unloaded_k_xz_n_per_mm = 2.0f,
                                      .unloaded_k_zz_n_per_mm = 3.0f,
                                      .counted_force_x_n = 4.0f,
                                      .counted_force_z_n = 5.0f,
                                      .moved_x_mm = 6.0f,
                                      .moved_z_mm = 7.0f,
                                      .buckling_factor = INFINITY,
                                      .gravity_direction_rad = -1.5f,
                                      .gravity_lean_rad = 0.5f,
                                      .counted_force_y_n = 8.0f,
                                      .moved_y_mm = 9.0f,
                                      .unloaded_k_across_n_per_mm = 10.0f};
    (void)brace_can_pack_snapshot_fd(&plane, whole.data);
    (void)brace_can_pack_load_fd(&sent, load.data);
    (void)brace_joiner_add(&joiner, NODE, &whole, 0u);
    const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &load, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_ALL | BRACE_PART_LOAD | BRACE_PART_LOAD_ACROSS, s->parts);
    const float found[] = {s->load.unloaded_k_xx_n_per_mm,
                           s->load.unloaded_k_xz_n_per_mm,
                           s->load.unloaded_k_zz_n_per_mm,
                           s->load.force_x_n,
                           s->load.force_z_n,
                           s->load.moved_x_mm,
                           s->load.moved_z_mm,
                           s->load.force_y_n,
                           s->load.moved_y_mm,
                           s->load.unloaded_k_across_n_per_mm};
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_FLOAT((float)(i + 1), found[i]);
    }
    TEST_ASSERT_TRUE(s->load.is_counted && isinf(s->load.buckling_factor));
    TEST_ASSERT_EQUAL_FLOAT(-1.5f, s->load.gravity_direction_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, s->load.gravity_lean_rad);
}

/* ------------------------------------------------------------------------------- how sure K is, and faults -- */

static brace_bus_frame_t sigma_frame_of(uint32_t part, uint32_t tick, uint64_t now_us)
{
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_DETAILS + NODE, .length = 8u, .received_us = now_us};
    const float m = 0.004f * (float)(tick & 0x1fffu); /* whole steps of each */
    const brace_can_sigma_0_t entries = {
        .sequence = tick & 0xffu, .k_xx_n_per_mm = m, .k_xz_n_per_mm = m, .k_zz_n_per_mm = m};
    const brace_can_sigma_1_t others = {
        .sequence = tick & 0xffu, .lambda_min_n_per_mm = m, .lambda_max_n_per_mm = m, .stiff_axis_rad = 0.25f};
    (void)(part == 0u ? brace_can_pack_sigma_0(&entries, frame.data) : brace_can_pack_sigma_1(&others, frame.data));
    return frame;
}

static void test_an_uncertainty_is_of_its_k_s_tick(void)
{
    brace_joiner_t joiner = {0};
    uint32_t tick = 0u, whole = 0u;
    for (uint32_t i = 0u; i < 100000u; i++) {
        tick += 1u + random_below(300u);
        for (uint32_t part = 0u; part < 4u; part++) {
            if (random_below(20u) == 0u) {
                continue;
            }
            const uint64_t now_us = 1000u + (uint64_t)tick * TICK_US + part * 130u;
            const brace_bus_frame_t frame =
                part < 2u ? frame_of(part, tick, now_us) : sigma_frame_of(part - 2u, tick, now_us);
            const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, 0u);
            if (s == NULL || s->parts != (BRACE_PART_K | BRACE_PART_SIGMA)) {
                continue;
            }
            is_of_one_tick(s);
            const float values[] = {s->sigma.k_xx_n_per_mm, s->sigma.k_xz_n_per_mm, s->sigma.k_zz_n_per_mm,
                                    s->sigma.lambda_min_n_per_mm, s->sigma.lambda_max_n_per_mm};
            for (uint32_t at = 0u; at < 5u; at++) {
                TEST_ASSERT_EQUAL_UINT32(tick & 0x1fffu, (uint32_t)lroundf(values[at] / 0.004f));
            }
            TEST_ASSERT_EQUAL_FLOAT(0.25f, s->sigma.stiff_axis_rad);
            whole++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(75000u, whole); /* (19/20)^4 of all */
}

static void test_over_can_fd_an_uncertainty_is_a_frame_of_its_own(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_DETAILS_FD + NODE, .length = 64u, .fd = true, .received_us = 1000u};
    const brace_can_sigma_fd_t sent = {.sequence = 7u,
                                       .k_xx_n_per_mm = 1.0f,
                                       .k_xz_n_per_mm = 2.0f,
                                       .k_zz_n_per_mm = 3.0f,
                                       .lambda_min_n_per_mm = 4.0f,
                                       .lambda_max_n_per_mm = NAN,
                                       .stiff_axis_rad = 0.5f,
                                       .space_k_yy_n_per_mm = 6.0f,
                                       .space_lambda_3_n_per_mm = 7.0f,
                                       .k_across_n_per_mm = 8.0f};
    (void)brace_can_pack_sigma_fd(&sent, frame.data);
    const brace_client_snapshot_t *s = brace_joiner_add(&joiner, NODE, &frame, 0u);
    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_SIGMA | BRACE_PART_SIGMA_SPACE, s->parts);
    TEST_ASSERT_EQUAL_FLOAT(6.0f, s->space_sigma.k_yy_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, s->space_sigma.lambda_n_per_mm[2]);
    TEST_ASSERT_EQUAL_FLOAT(8.0f, s->space_sigma.k_across_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, s->sigma.k_xx_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(3.0f, s->sigma.k_zz_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(4.0f, s->sigma.lambda_min_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.5f, s->sigma.stiff_axis_rad);
    TEST_ASSERT_TRUE(isnan(s->sigma.lambda_max_n_per_mm));
}

static void test_an_uncertainty_in_space_is_four_frames(void)
{
    brace_joiner_t joiner = {0};
    const brace_can_sigma_space_0_t x = {
        .sequence = 5u, .k_xx_n_per_mm = 1.0f, .k_xy_n_per_mm = 2.0f, .k_xz_n_per_mm = 3.0f};
    const brace_can_sigma_space_1_t yz = {
        .sequence = 5u, .k_yy_n_per_mm = 4.0f, .k_yz_n_per_mm = 5.0f, .k_zz_n_per_mm = 6.0f};
    const brace_can_sigma_space_2_t lambda = {
        .sequence = 5u, .lambda_1_n_per_mm = 7.0f, .lambda_2_n_per_mm = 8.0f, .lambda_3_n_per_mm = 9.0f};
    const brace_can_sigma_space_3_t across = {.sequence = 5u, .k_across_n_per_mm = 10.0f};
    brace_bus_frame_t frames[4];
    for (uint32_t i = 0u; i < 4u; i++) {
        frames[i] = (brace_bus_frame_t){.id = BRACE_CAN_ID_DETAILS + NODE, .length = 8u, .received_us = 1000u + i};
    }
    (void)brace_can_pack_sigma_space_0(&x, frames[0].data);
    (void)brace_can_pack_sigma_space_1(&yz, frames[1].data);
    (void)brace_can_pack_sigma_space_2(&lambda, frames[2].data);
    (void)brace_can_pack_sigma_space_3(&across, frames[3].data);
    const brace_client_snapshot_t *s = NULL;
    for (uint32_t i = 0u; i < 4u; i++) {
        s = brace_joiner_add(&joiner, NODE, &frames[i], 0u);
        TEST_ASSERT_EQUAL(i == 3u, s != NULL);
    }
    TEST_ASSERT_EQUAL_UINT32(BRACE_PART_SIGMA_SPACE, s->parts);
    const brace_client_space_sigma_t *got = &s->space_sigma;
    const float found[] = {got->k_xx_n_per_mm,      got->k_xy_n_per_mm,      got->k_xz_n_per_mm,
                           got->k_yy_n_per_mm,      got->k_yz_n_per_mm,      got->k_zz_n_per_mm,
                           got->lambda_n_per_mm[0], got->lambda_n_per_mm[1], got->lambda_n_per_mm[2],
                           got->k_across_n_per_mm};
    for (uint32_t i = 0u; i < 10u; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, (float)(i + 1u), found[i]);
    }
    TEST_ASSERT_TRUE(isnan(s->sigma.k_xx_n_per_mm));
}

/* Faults of a K in the plane; a new tick for each call. */
static uint32_t faults_now(brace_joiner_t *joiner, uint32_t lost)
{
    static uint32_t tick = 1000u;
    const brace_client_snapshot_t *s = NULL;
    tick++;
    for (uint32_t kind = 0u; kind < 2u; kind++) {
        const brace_bus_frame_t frame = frame_of(kind, tick, 1000u + (uint64_t)tick * TICK_US);
        s = brace_joiner_add(joiner, NODE, &frame, lost);
    }
    TEST_ASSERT_NOT_NULL(s);
    return s->faults;
}

static void test_faults_are_those_last_heard(void)
{
    brace_joiner_t joiner = {0};
    brace_bus_frame_t frame = {.id = BRACE_CAN_ID_DETAILS + NODE, .length = 8u};
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, faults_now(&joiner, 0u)); /* not heard yet */
    (void)brace_can_pack_condition(&(brace_can_condition_t){.faults = 0x80000001u}, frame.data);
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &frame, 0u));
    TEST_ASSERT_EQUAL_HEX32(0x80000001u, faults_now(&joiner, 0u));
    frame.id = BRACE_CAN_ID_EMERGENCY + NODE;
    (void)brace_can_pack_emergency(&(brace_can_emergency_t){.faults = 4u}, frame.data);
    TEST_ASSERT_NULL(brace_joiner_add(&joiner, NODE, &frame, 0u));
    TEST_ASSERT_EQUAL_HEX32(4u, faults_now(&joiner, 0u));
    /* the frame that was lost may have reported another */
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, faults_now(&joiner, 1u));
    frame.id = BRACE_CAN_ID_EMERGENCY + NODE + 1;
    (void)brace_joiner_add(&joiner, NODE, &frame, 1u);
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, faults_now(&joiner, 1u)); /* a neighbour's */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_snapshot_is_of_two_ticks);
    RUN_TEST(test_halves_of_two_rounds_of_the_number_do_not_meet);
    RUN_TEST(test_a_loss_in_between_parts_the_halves);
    RUN_TEST(test_a_newer_k_may_overtake_an_older_posture);
    RUN_TEST(test_others_and_short_frames_are_passed_over);
    RUN_TEST(test_an_unknown_k_is_not_valid_and_never_zero);
    RUN_TEST(test_a_frame_of_can_fd_is_a_whole_snapshot);
    RUN_TEST(test_k_in_space_is_a_part_of_its_snapshot);
    RUN_TEST(test_k_in_space_is_never_of_two_ticks);
    RUN_TEST(test_an_unknown_k_in_space_is_not_valid);
    RUN_TEST(test_over_can_fd_k_in_space_is_a_second_frame);
    RUN_TEST(test_a_load_is_of_its_k_s_tick);
    RUN_TEST(test_a_load_across_the_plane);
    RUN_TEST(test_a_load_that_is_not_counted);
    RUN_TEST(test_over_can_fd_a_load_is_a_frame_of_its_own);
    RUN_TEST(test_an_uncertainty_is_of_its_k_s_tick);
    RUN_TEST(test_over_can_fd_an_uncertainty_is_a_frame_of_its_own);
    RUN_TEST(test_an_uncertainty_in_space_is_four_frames);
    RUN_TEST(test_faults_are_those_last_heard);
    return UNITY_END();
}
