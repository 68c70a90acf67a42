/* K in space of a limb whose coxa joint is fitted: what it is, what the coxa joint's play and sensor make of it, and
 * that every wire reports it whole. Where a joint is moved, the board is that of test_app_takeup.c. */
#include "can_bench.h"
#include "modbus_master.h"
#include "reference_spatial.h"

#define PROMISED 1e-5 /* of lambda_max: brace/spatial.h */
#define GAP_RAD 0.01f
#define SERVO_N_MM_PER_RAD 50000.0f
#define SPRING_N_MM_PER_RAD 80000.0f

enum {
    DETAILS_ID = 0x200 + NODE,
    FIRST_PART = 16,
    PARTS = 7,
    KEPT = 256,
    ASKED_SPACE_FORCE = 16440,
    ASKED_SPACE_K = 4152
};

static bool link_is_free[BRACE_LINK_COUNT];
static float middle_rad[BRACE_LINK_COUNT];

/* The paper's limb: every link yields aside and twists, the coxa joint has a spring. */
static brace_parameters_t space_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    p.limb.link[BRACE_TIBIA].torsion_rad_per_n_mm = 3e-6f;
    p.limb.link[BRACE_FEMUR].moment_transfer = 0.5f;
    p.controller.modbus_address = UNIT;
    p.controller.stiffness_hz = 50;
    p.controller.bus_load_ratio = 1.0f;
    return p;
}

static void start_with(const brace_parameters_t *p)
{
    bench_start(p);
    brace_fake_without_force(&fake);
    fake.joint[BRACE_COXA].absent = false;
    fake.joint[BRACE_COXA].sample.motor_rad = 0.3f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        middle_rad[i] = fake.joint[i].sample.motor_rad;
        fake.joint[i].command = (brace_hal_joint_command_t){0.0f, INFINITY};
        link_is_free[i] = false;
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal)); /* again: now the joint is there */
    ticks(50);
    drain();
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

void setUp(void)
{
    const brace_parameters_t p = space_parameters();
    start_with(&p);
}

void tearDown(void) {}

/* ---------------------------------------------------------------------------------------- what it is -- */

static void assert_is_reference(const brace_stiffness_spatial_t *k, const reference_spatial_t *r)
{
    const double most = (double)k->lambda_n_per_mm[2];
    ASSERT_CLOSE(r->k[0][0], k->k_xx_n_per_mm, PROMISED * most);
    ASSERT_CLOSE(r->k[0][1], k->k_xy_n_per_mm, PROMISED * most);
    ASSERT_CLOSE(r->k[0][2], k->k_xz_n_per_mm, PROMISED * most);
    ASSERT_CLOSE(r->k[1][1], k->k_yy_n_per_mm, PROMISED * most);
    ASSERT_CLOSE(r->k[1][2], k->k_yz_n_per_mm, PROMISED * most);
    ASSERT_CLOSE(r->k[2][2], k->k_zz_n_per_mm, PROMISED * most);
    const double sum = (double)(k->lambda_n_per_mm[0] + k->lambda_n_per_mm[1] + k->lambda_n_per_mm[2]);
    ASSERT_CLOSE(r->k[0][0] + r->k[1][1] + r->k[2][2], sum, 3.0 * PROMISED * most);
}

static void test_K_in_space_is_the_reference_at_every_posture(void)
{
    static const float posture[][3] = {
        {0.0f, 1.0f, 1.4f}, {0.3f, 0.7f, 1.8f}, {-0.9f, 1.3f, 1.0f}, {1.6f, 0.5f, 1.2f}, {-1.9f, -0.4f, 0.9f}};
    const brace_limb_t *limb = &brace_app_parameters(&app)->limb;
    for (uint32_t i = 0; i < sizeof posture / sizeof *posture; i++) {
        for (int joint = 0; joint < BRACE_LINK_COUNT; joint++) {
            fake.joint[joint].sample.motor_rad = posture[i][joint];
        }
        bench_believe();
        ticks(2);
        const float *theta_rad = now()->theta_rad;
        const reference_spatial_t in_space = reference_spatial(
            limb, (double)theta_rad[BRACE_COXA], (double)theta_rad[BRACE_FEMUR], (double)theta_rad[BRACE_TIBIA]);
        const reference_spatial_t in_plane =
            reference_spatial(limb, 0.0, (double)theta_rad[BRACE_FEMUR], (double)theta_rad[BRACE_TIBIA]);
        TEST_ASSERT_TRUE(now()->space.is_valid);
        TEST_ASSERT_EQUAL_HEX32(0u, now()->space.now.flags);
        assert_is_reference(&now()->space.now, &in_space);
        assert_is_reference(&now()->space.engaged, &in_space);
        ASSERT_CLOSE(in_plane.k[1][1], now()->space.across_n_per_mm, PROMISED * in_plane.k[1][1]);
        /* K in the plane is of the same limb: the coxa link yields in it too. */
        ASSERT_CLOSE(in_plane.k[0][0], now()->stiffness.now.k_xx_n_per_mm, 2e-5 * in_plane.k[0][0]);
        ticks(20); /* K without a load is worked out now and then */
        TEST_ASSERT_TRUE(now()->load.is_counted);
        ASSERT_CLOSE(in_plane.k[1][1], now()->load.unloaded_across_n_per_mm, PROMISED * in_plane.k[1][1]);
        ASSERT_CLOSE(in_plane.k[0][0], now()->load.unloaded.k_xx_n_per_mm, 2e-5 * in_plane.k[0][0]);
    }
}

static void test_K_in_space_elsewhere_is_the_reference(void)
{
    uint8_t data[8];
    brace_can_k_in_space_at_posture_answer_0_t a;
    brace_can_k_in_space_at_posture_answer_2_t c;
    brace_can_k_in_space_at_posture_answer_4_t e;
    const reference_spatial_t r = reference_spatial(&brace_app_parameters(&app)->limb, -0.5, 0.8, 1.1);
    brace_can_pack_k_in_space_at_posture_request(&(brace_can_k_in_space_at_posture_request_t){9, -0.5f, 0.8f, 1.1f},
                                                 data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(6, answer.count);
    for (uint32_t part = 0; part < 6u; part++) {
        TEST_ASSERT_EQUAL_HEX8(answer_number(BRACE_REQUEST_K_IN_SPACE_AT_POSTURE, part), answer.part[part][0]);
        TEST_ASSERT_EQUAL(9, answer.part[part][1]);
    }
    brace_can_unpack_k_in_space_at_posture_answer_0(answer.part[0], &a);
    brace_can_unpack_k_in_space_at_posture_answer_2(answer.part[2], &c);
    brace_can_unpack_k_in_space_at_posture_answer_4(answer.part[4], &e);
    ASSERT_CLOSE(r.k[0][0], a.k_xx_n_per_mm, 4e-4);
    ASSERT_CLOSE(r.k[0][1], a.k_xy_n_per_mm, 4e-4);
    ASSERT_CLOSE(r.k[1][2], c.k_yz_n_per_mm, 4e-4);
    ASSERT_CLOSE(r.k[2][2], c.k_zz_n_per_mm, 4e-4);
    TEST_ASSERT_EQUAL_HEX32(0u, e.flags);
    TEST_ASSERT_EQUAL(0, e.force_is_told);
}

static void test_K_in_space_beyond_the_travel_is_flagged(void)
{
    uint8_t data[8];
    brace_can_k_in_space_at_posture_answer_4_t e;
    brace_can_pack_k_in_space_at_posture_request(&(brace_can_k_in_space_at_posture_request_t){9, -0.5f, -2.5f, 1.0f},
                                                 data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(6, answer.count);
    brace_can_unpack_k_in_space_at_posture_answer_4(answer.part[4], &e);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_OUT_OF_RANGE, e.flags);
}

/* K under a force from any side, by the core's estimator: tests/judges/engine judges it. */
typedef struct {
    brace_stiffness_spatial_t k;
    float moved_mm[3];
} under_load_t;

static const float load_posture_rad[BRACE_LINK_COUNT] = {-0.5f, 0.8f, 1.1f};

static under_load_t under_load(const float force_n[3])
{
    const brace_parameters_t *p = brace_app_parameters(&app);
    const brace_loaded_joint_t spring[BRACE_LINK_COUNT] = {
        {p->limb.joint[0].compliance_rad_per_n_mm, p->limb.joint[0].compliance_rad_per_n_mm},
        {p->limb.joint[1].compliance_rad_per_n_mm, p->limb.joint[1].compliance_rad_per_n_mm},
        {p->limb.joint[2].compliance_rad_per_n_mm, p->limb.joint[2].compliance_rad_per_n_mm}};
    const brace_space_load_t load = {.tip_n = {force_n[0], force_n[1], force_n[2]},
                                     .down = {0.0f, 0.0f, -1.0f},
                                     .yaw = spring[BRACE_COXA],
                                     .hip = spring[BRACE_FEMUR],
                                     .knee = spring[BRACE_TIBIA]};
    brace_loaded_space_t limb;
    brace_space_rest_t rest;
    brace_space_result_t result;
    under_load_t expected = {0};
    brace_loaded_space_collapse(&p->limb, &p->gravity, &limb);
    TEST_ASSERT_EQUAL(BRACE_OK,
                      brace_loaded_space_settle(&limb, load_posture_rad[1], load_posture_rad[2], &load, &rest));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_stiffness(&limb, &rest, &result));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_space_turn(load_posture_rad[0], &result.k, &expected.k));
    expected.moved_mm[0] = result.displacement_mm.x;
    expected.moved_mm[1] = result.displacement_mm.y;
    expected.moved_mm[2] = result.displacement_mm.z;
    return expected;
}

static const float forces_n[][3] = {{4.0f, -6.0f, 9.0f}, {-12.0f, 8.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};

static answer_t ask_in_space(void)
{
    uint8_t data[8];
    brace_can_pack_k_in_space_at_posture_request(
        &(brace_can_k_in_space_at_posture_request_t){9, load_posture_rad[0], load_posture_rad[1], load_posture_rad[2]},
        data);
    return ask(data);
}

static void assert_answers(const answer_t *answer, const under_load_t *expected, bool force_is_told)
{
    brace_can_k_in_space_at_posture_answer_0_t a;
    brace_can_k_in_space_at_posture_answer_1_t b;
    brace_can_k_in_space_at_posture_answer_2_t c;
    brace_can_k_in_space_at_posture_answer_3_t d;
    brace_can_k_in_space_at_posture_answer_4_t e;
    brace_can_k_in_space_at_posture_answer_5_t f;
    TEST_ASSERT_EQUAL(6, answer->count);
    brace_can_unpack_k_in_space_at_posture_answer_0(answer->part[0], &a);
    brace_can_unpack_k_in_space_at_posture_answer_1(answer->part[1], &b);
    brace_can_unpack_k_in_space_at_posture_answer_2(answer->part[2], &c);
    brace_can_unpack_k_in_space_at_posture_answer_3(answer->part[3], &d);
    brace_can_unpack_k_in_space_at_posture_answer_4(answer->part[4], &e);
    brace_can_unpack_k_in_space_at_posture_answer_5(answer->part[5], &f);
    TEST_ASSERT_EQUAL(force_is_told, e.force_is_told);
    TEST_ASSERT_EQUAL_HEX32(0u, e.flags);
    ASSERT_CLOSE(expected->k.k_xx_n_per_mm, a.k_xx_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.k_xy_n_per_mm, a.k_xy_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.k_xz_n_per_mm, b.k_xz_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.k_yy_n_per_mm, b.k_yy_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.k_yz_n_per_mm, c.k_yz_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.k_zz_n_per_mm, c.k_zz_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.lambda_n_per_mm[0], d.lambda_1_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.lambda_n_per_mm[1], d.lambda_2_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->k.lambda_n_per_mm[2], e.lambda_3_n_per_mm, 4e-4);
    ASSERT_CLOSE(expected->moved_mm[0], f.dx_mm, 6e-3);
    ASSERT_CLOSE(expected->moved_mm[1], f.dy_mm, 6e-3);
    ASSERT_CLOSE(expected->moved_mm[2], f.dz_mm, 6e-3);
}

/* Where the limb is and under its load, K is what a question elsewhere would get: the load couples plane and across. */
static void test_K_here_is_K_as_asked_for_here(void)
{
    for (int joint = 0; joint < BRACE_LINK_COUNT; joint++) {
        fake.joint[joint].sample.motor_rad = load_posture_rad[joint];
    }
    bench_believe();
    fake.joint[BRACE_COXA].sample.torque_n_mm = 2500.0f;
    fake.force_x_n = -5.0f, fake.force_z_n = 12.0f;
    ticks(200);
    TEST_ASSERT_TRUE(now()->space.is_valid && now()->load.is_counted);
    TEST_ASSERT_TRUE(fabsf(now()->load.force_y_n) > 2.0f);
    const brace_k_question_t question = {.where = BRACE_K_IN_SPACE,
                                         .theta_rad = {app.controller.posture.unbent_rad[0],
                                                       app.controller.posture.unbent_rad[1],
                                                       app.controller.posture.unbent_rad[2]},
                                         .tip_force = {now()->load.force_x_n, now()->load.force_z_n},
                                         .force_across_n = now()->load.force_y_n};
    brace_k_answer_t answer;
    int32_t status = BRACE_APP_LATER;
    for (int i = 0; i < 30 && status == BRACE_APP_LATER; i++) {
        status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer);
        ticks(1);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, status);
    const brace_stiffness_spatial_t *here = &now()->space.engaged, *asked = &answer.in_space;
    const double off = 1e-4 * (double)asked->lambda_n_per_mm[2];
    ASSERT_CLOSE(asked->k_xx_n_per_mm, here->k_xx_n_per_mm, off);
    ASSERT_CLOSE(asked->k_xy_n_per_mm, here->k_xy_n_per_mm, off);
    ASSERT_CLOSE(asked->k_xz_n_per_mm, here->k_xz_n_per_mm, off);
    ASSERT_CLOSE(asked->k_yy_n_per_mm, here->k_yy_n_per_mm, off);
    ASSERT_CLOSE(asked->k_yz_n_per_mm, here->k_yz_n_per_mm, off);
    ASSERT_CLOSE(asked->k_zz_n_per_mm, here->k_zz_n_per_mm, off);
}

static void test_K_in_space_elsewhere_counts_a_force_once(void)
{
    const under_load_t alone = under_load((float[]){0.0f, 0.0f, 0.0f});
    for (uint32_t i = 0; i < sizeof forces_n / sizeof *forces_n; i++) {
        const float *n = forces_n[i];
        uint8_t data[8];
        brace_can_tip_force_in_space_answer_0_t reported;
        brace_can_pack_tip_force_in_space_request(&(brace_can_tip_force_in_space_request_t){3, n[0], n[1], n[2]}, data);
        answer_t answer = ask(data);
        TEST_ASSERT_EQUAL(1, answer.count);
        brace_can_unpack_tip_force_in_space_answer_0(answer.part[0], &reported);
        ASSERT_CLOSE(n[1], reported.fy_n, 6e-3);
        const under_load_t expected = under_load(n);
        answer = ask_in_space();
        assert_answers(&answer, &expected, true);
        answer = ask_in_space(); /* the force belonged to the first */
        assert_answers(&answer, &alone, false);
    }
}

static void test_K_in_space_elsewhere_under_a_force_that_folds_the_limb_is_refused(void)
{
    uint8_t data[8];
    brace_can_pack_tip_force_in_space_request(&(brace_can_tip_force_in_space_request_t){3, -300.0f, 0.0f, -300.0f},
                                              data);
    (void)ask(data);
    answer_t answer = ask_in_space();
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, refusal_of(&answer, BRACE_REQUEST_K_IN_SPACE_AT_POSTURE).status);
    answer = ask_in_space();
    TEST_ASSERT_EQUAL(6, answer.count);
}

static void asked_over_modbus(reply_t (*asks)(uint8_t unit, const uint8_t *pdu, uint32_t count))
{
    const uint8_t head[] = {16, ASKED_SPACE_FORCE >> 8, ASKED_SPACE_FORCE & 0xff, 0, 12, 24};
    const uint8_t read[] = {4, ASKED_SPACE_K >> 8, ASKED_SPACE_K & 0xff, 0, 28};
    for (uint32_t i = 0; i < sizeof forces_n / sizeof *forces_n; i++) {
        uint8_t pdu[30];
        memcpy(pdu, head, sizeof head);
        for (uint32_t at = 0; at < 24u; at++) {
            const uint32_t value = at / 4u;
            pdu[sizeof head + at] = (uint8_t)(bits(value < 3u ? forces_n[i][value] : load_posture_rad[value - 3u]) >>
                                              (24u - 8u * (at % 4u)));
        }
        TEST_ASSERT_EQUAL(5, asks(UNIT, pdu, sizeof pdu).count);
        const reply_t reported = asks(UNIT, read, sizeof read);
        TEST_ASSERT_EQUAL_HEX32(0u, value_at(&reported, 9));
        TEST_ASSERT_EQUAL(1, value_at(&reported, 10));
        const under_load_t expected = under_load(forces_n[i]);
        for (uint32_t axis = 0; axis < 3u; axis++) {
            ASSERT_CLOSE(expected.moved_mm[axis], float_at(&reported, 11u + axis), 0.0);
        }
        ASSERT_CLOSE(expected.k.k_xx_n_per_mm, float_at(&reported, 0), 0.0);
        ASSERT_CLOSE(expected.k.k_xy_n_per_mm, float_at(&reported, 1), 0.0);
        ASSERT_CLOSE(expected.k.k_zz_n_per_mm, float_at(&reported, 5), 0.0);
        ASSERT_CLOSE(expected.k.lambda_n_per_mm[0], float_at(&reported, 6), 0.0);
    }
}

static void test_K_in_space_elsewhere_under_a_force_over_the_line_and_over_TCP(void)
{
    asked_over_modbus(line_asks);
    asked_over_modbus(tcp_asks);
}

/* ------------------------------------------------------------------------------------------- the wires -- */

/* One snapshot's parts, as they came. */
typedef struct {
    uint32_t seen; /* bits */
    brace_can_space_0_t a;
    brace_can_space_1_t b;
    brace_can_space_2_t c;
    brace_can_space_3_t d;
    brace_can_space_4_t e;
    brace_can_space_5_t f;
    brace_can_space_6_t g;
} parts_t;

/* Is it a part of K in space? */
static bool is_of_space(const brace_can_frame_t *frame)
{
    return frame->id == DETAILS_ID && frame->data[1] >= FIRST_PART && frame->data[1] < FIRST_PART + PARTS;
}

static void unpack_part(const uint8_t data[8], parts_t *parts)
{
    const uint32_t part = data[1] - (uint32_t)FIRST_PART;
    switch (part) {
    case 0: brace_can_unpack_space_0(data, &parts->a); break;
    case 1: brace_can_unpack_space_1(data, &parts->b); break;
    case 2: brace_can_unpack_space_2(data, &parts->c); break;
    case 3: brace_can_unpack_space_3(data, &parts->d); break;
    case 4: brace_can_unpack_space_4(data, &parts->e); break;
    case 5: brace_can_unpack_space_5(data, &parts->f); break;
    case 6: brace_can_unpack_space_6(data, &parts->g); break;
    default: TEST_FAIL_MESSAGE("a part that there is not");
    }
    parts->seen |= 1u << part;
}

/* The next snapshot that comes whole. */
static parts_t next_parts(void)
{
    parts_t parts = {0};
    brace_can_frame_t frame;
    drain();
    for (int i = 0; i < 200 && parts.seen != (1u << PARTS) - 1u; i++) {
        ticks(1);
        while (parts.seen != (1u << PARTS) - 1u && brace_fake_frame_take(&fake, &frame)) {
            if (is_of_space(&frame) && (frame.data[1] == FIRST_PART || parts.seen != 0)) {
                unpack_part(frame.data, &parts);
            }
        }
    }
    TEST_ASSERT_EQUAL_HEX32((1u << PARTS) - 1u, parts.seen);
    return parts;
}

static void assert_parts_are(const parts_t *parts, const brace_snapshot_t *of)
{
    const brace_stiffness_spatial_t *k = &of->space.now;
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_xx_n_per_mm, parts->a.k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_xy_n_per_mm, parts->a.k_xy_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_xz_n_per_mm, parts->b.k_xz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_yy_n_per_mm, parts->b.k_yy_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_yz_n_per_mm, parts->c.k_yz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->k_zz_n_per_mm, parts->c.k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->lambda_n_per_mm[0], parts->d.lambda_1_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->lambda_n_per_mm[1], parts->d.lambda_2_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(2.6e-4f, k->lambda_n_per_mm[2], parts->e.lambda_3_n_per_mm);
    TEST_ASSERT_EQUAL_HEX32(k->flags, parts->e.flags);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->stiff_axis[0], parts->f.stiff_axis_x);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->stiff_axis[1], parts->f.stiff_axis_y);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, k->stiff_axis[2], parts->f.stiff_axis_z);
    TEST_ASSERT_FLOAT_WITHIN(1.1e-5f, of->theta_rad[BRACE_COXA], parts->g.theta0_rad);
    TEST_ASSERT_EQUAL(of->play[BRACE_COXA].state, parts->g.play_coxa);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, of->space.across_n_per_mm, parts->g.k_across_n_per_mm);
}

/* The joint turns in every tick, the bus has no room now and then, and a snapshot is due before the last has left. */
static void test_frames_of_a_snapshot_come_whole_and_are_never_mixed(void)
{
    static brace_snapshot_t kept[KEPT];
    parts_t parts = {0};
    brace_can_frame_t frame;
    uint32_t whole = 0, sequence = 0;
    brace_parameters_t p = space_parameters();
    p.controller.stiffness_hz = 500;
    start_with(&p);
    for (int i = 0; i < 5000; i++) {
        fake.joint[BRACE_COXA].sample.motor_rad = -1.0f + 4e-4f * (float)i;
        fake.joint[BRACE_FEMUR].sample.motor_rad = 0.5f + 4e-4f * (float)(i % 1500);
        if (i % 1500 == 0) {
            bench_believe();
        }
        fake.can_room = i % 7 == 0 ? 0 : 64;
        ticks(1);
        kept[now()->sequence % KEPT] = *now();
        while (brace_fake_frame_take(&fake, &frame)) {
            const bool began_before = whole == 0u && parts.seen == 0u && frame.data[1] != FIRST_PART;
            if (!is_of_space(&frame) || began_before) {
                continue;
            }
            TEST_ASSERT_TRUE(parts.seen == 0 ? frame.data[1] == FIRST_PART : frame.data[0] == sequence);
            sequence = frame.data[0];
            unpack_part(frame.data, &parts);
            if (parts.seen == (1u << PARTS) - 1u) {
                assert_parts_are(&parts, &kept[sequence]);
                parts.seen = 0;
                whole++;
            }
        }
    }
    TEST_ASSERT_TRUE(whole > 800u); /* 5 s, nine frames each, two in a tick */
}

static void test_over_CAN_FD_it_is_one_frame_more(void)
{
    brace_parameters_t p = space_parameters();
    p.controller.can_fd_bit_rate = 2000000;
    bench_start(&p);
    fake.can_takes_fd = true;
    fake.joint[BRACE_COXA].absent = false;
    fake.joint[BRACE_COXA].sample.motor_rad = 0.3f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    drain();
    uint32_t in_space = 0, in_plane = 0;
    brace_can_frame_t frame;
    for (int i = 0; i < 1000; i++) {
        fake.joint[BRACE_COXA].sample.motor_rad = -1.0f + 1e-3f * (float)i;
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            in_plane += frame.fd && frame.id == BRACE_CAN_ID_SNAPSHOT_FD + NODE;
            TEST_ASSERT_FALSE(is_of_space(&frame));
            if (frame.id != BRACE_CAN_ID_DETAILS_FD + NODE ||
                brace_can_details_fd_part(frame.data) != BRACE_CAN_PART_SPACE_FD) {
                continue;
            }
            brace_can_space_fd_t got;
            const brace_snapshot_t *wanted = now();
            brace_can_unpack_space_fd(frame.data, &got);
            TEST_ASSERT_EQUAL(64, frame.length);
            TEST_ASSERT_EQUAL(wanted->sequence & 0xffu, got.sequence);
            TEST_ASSERT_EQUAL_FLOAT(wanted->space.now.k_xy_n_per_mm, got.k_xy_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->space.now.k_zz_n_per_mm, got.k_zz_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->space.now.lambda_n_per_mm[2], got.lambda_3_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->space.across_n_per_mm, got.k_across_n_per_mm);
            TEST_ASSERT_EQUAL_FLOAT(wanted->theta_rad[BRACE_COXA], got.theta0_rad);
            TEST_ASSERT_EQUAL_HEX32(wanted->space.now.flags, got.flags);
            in_space++;
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 50, in_space);
    TEST_ASSERT_EQUAL(in_plane, in_space);
}

/* Frames within a second, and of these K in space's. */
static uint32_t frames_of_a_second(uint32_t *in_space)
{
    uint32_t count = 0;
    brace_can_frame_t frame;
    *in_space = 0;
    drain();
    for (int i = 0; i < 1000; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            *in_space += is_of_space(&frame);
            count++;
        }
    }
    return count;
}

static void test_its_frames_count_in_what_the_bus_may_carry(void)
{
    brace_parameters_t p = space_parameters();
    p.controller.can_bit_rate = 125000;
    p.controller.stiffness_hz = p.controller.posture_hz = 100;
    p.controller.load_hz = p.controller.sigma_hz = 0;
    p.controller.bus_load_ratio = 0.3f;
    start_with(&p);
    uint32_t in_space;
    const uint32_t allowed = 277; /* 0.3 of 125,000 bit/s, 135 bits a frame */
    const uint32_t count = frames_of_a_second(&in_space);
    TEST_ASSERT_TRUE(count <= allowed + 11u && count >= allowed - 22u);
    TEST_ASSERT_UINT32_WITHIN(14, allowed * 7u / 11u, in_space);
    bench_start(&p); /* the same limb without a coxa joint reports its plane only, and more often */
    ticks(50);
    TEST_ASSERT_TRUE(frames_of_a_second(&in_space) <= allowed + 4u);
    TEST_ASSERT_EQUAL(0, in_space);
}

/* What a limb in space reports of the load across its plane: two frames with each load, of the same snapshot. */
static void test_the_load_across_the_plane_is_sent_with_the_load(void)
{
    brace_parameters_t p = space_parameters();
    p.controller.load_hz = 50;
    start_with(&p);
    brace_can_frame_t frame;
    brace_can_load_across_0_t force = {0};
    brace_can_load_across_1_t k = {0};
    uint32_t loads = 0, across[2] = {0};
    for (int i = 0; i < 1000; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            const uint32_t part = frame.id == (uint32_t)DETAILS_ID ? brace_can_details_part(frame.data) : 0u;
            loads += part == BRACE_CAN_PART_LOAD_0;
            if (part == BRACE_CAN_PART_LOAD_ACROSS_0) {
                brace_can_unpack_load_across_0(frame.data, &force);
                across[0]++;
            } else if (part == BRACE_CAN_PART_LOAD_ACROSS_1) {
                brace_can_unpack_load_across_1(frame.data, &k);
                TEST_ASSERT_EQUAL(force.sequence, k.sequence);
                across[1]++;
            }
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 50, loads);
    TEST_ASSERT_UINT32_WITHIN(1, loads, across[0]);
    TEST_ASSERT_UINT32_WITHIN(1, loads, across[1]);
    const brace_snapshot_load_t *load = &now()->load;
    TEST_ASSERT_EQUAL(load->is_counted, isfinite(force.counted_force_y_n));
    if (load->is_counted) {
        TEST_ASSERT_FLOAT_WITHIN(0.002f, load->force_y_n, force.counted_force_y_n);
        TEST_ASSERT_FLOAT_WITHIN(0.002f, load->moved_y_mm, force.moved_y_mm);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001f, load->unloaded_across_n_per_mm, k.unloaded_k_across_n_per_mm);
    bench_start(&p); /* the same limb without a coxa joint */
    ticks(50);
    drain();
    for (int i = 0; i < 200; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            const uint32_t part = frame.id == (uint32_t)DETAILS_ID ? brace_can_details_part(frame.data) : 0u;
            TEST_ASSERT_TRUE(part != BRACE_CAN_PART_LOAD_ACROSS_0 && part != BRACE_CAN_PART_LOAD_ACROSS_1);
        }
    }
}

static float entry_float(uint32_t entry)
{
    const uint32_t word = read_entry(entry);
    float value;
    memcpy(&value, &word, 4);
    return value;
}

enum {
    ENTRY_IN_SPACE = 0x1000 + 58,
    ENTRY_THETA0,
    ENTRY_K_XX,
    ENTRY_K_ACROSS = 0x1000 + 73,
    ENTRY_PLAY_COXA,
    ENTRY_FAULTS = 0x1000 + 7,
    ENTRY_TAKE_UP = 0x1000 + 97
};

/* One read of registers is one snapshot, and an entry over CAN is the same number. */
static void test_registers_and_entries_report_it(void)
{
    fake.joint[BRACE_COXA].sample.motor_rad = 0.7f;
    bench_believe();
    ticks(2);
    const brace_stiffness_spatial_t *k = &now()->space.now, *engaged = &now()->space.engaged;
    const reply_t reply = read_asks(4, 116, 84);
    const float wanted[] = {now()->theta_rad[BRACE_COXA],
                            k->k_xx_n_per_mm,
                            k->k_xy_n_per_mm,
                            k->k_xz_n_per_mm,
                            k->k_yy_n_per_mm,
                            k->k_yz_n_per_mm,
                            k->k_zz_n_per_mm,
                            k->lambda_n_per_mm[0],
                            k->lambda_n_per_mm[1],
                            k->lambda_n_per_mm[2],
                            k->stiff_axis[0],
                            k->stiff_axis[1],
                            k->stiff_axis[2]};
    TEST_ASSERT_EQUAL(1, value_at(&reply, 0));
    for (uint32_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        TEST_ASSERT_EQUAL_FLOAT(wanted[i], float_at(&reply, 1u + i));
    }
    TEST_ASSERT_EQUAL_HEX32(k->flags, value_at(&reply, 14));
    TEST_ASSERT_EQUAL_FLOAT(now()->space.across_n_per_mm, float_at(&reply, 15));
    TEST_ASSERT_EQUAL(now()->play[BRACE_COXA].state, value_at(&reply, 16));
    TEST_ASSERT_EQUAL_FLOAT(0.7f, float_at(&reply, 19)); /* motor_coxa */
    TEST_ASSERT_EQUAL_FLOAT(engaged->k_xx_n_per_mm, float_at(&reply, 21));
    TEST_ASSERT_EQUAL_FLOAT(engaged->lambda_n_per_mm[2], float_at(&reply, 29));
    TEST_ASSERT_EQUAL(1, read_entry(ENTRY_IN_SPACE));
    TEST_ASSERT_EQUAL_FLOAT(k->k_xx_n_per_mm, entry_float(ENTRY_K_XX));
}

/* ---------------------------------------------------------------------------------- play, sensor, take-up -- */

static void test_an_open_gap_of_the_coxa_joint_carries_nothing_across(void)
{
    brace_parameters_t p = space_parameters();
    p.limb.joint[BRACE_COXA].gap_rad = GAP_RAD;
    start_with(&p);
    const brace_space_stiffness_t *space = &now()->space;
    TEST_ASSERT_TRUE(space->is_valid);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_GAP_OPEN, space->now.flags);
    TEST_ASSERT_EQUAL_HEX32(0u, space->engaged.flags);
    TEST_ASSERT_EQUAL_HEX32(0u, now()->stiffness.now.flags); /* the plane has no gap */
    TEST_ASSERT_EQUAL_FLOAT(0.0f, space->across_n_per_mm);
    const double c = cos((double)now()->theta_rad[BRACE_COXA]), s = sin((double)now()->theta_rad[BRACE_COXA]);
    const double most = (double)space->now.lambda_n_per_mm[2];
    ASSERT_CLOSE(0.0, -s * (double)space->now.k_xx_n_per_mm + c * (double)space->now.k_xy_n_per_mm, 1e-6 * most);
    ASSERT_CLOSE(0.0, -s * (double)space->now.k_xy_n_per_mm + c * (double)space->now.k_yy_n_per_mm, 1e-6 * most);
    ASSERT_CLOSE(0.0, space->now.lambda_n_per_mm[0], 1e-6 * most);
    const reference_spatial_t r =
        reference_spatial(&p.limb, (double)now()->theta_rad[BRACE_COXA], (double)now()->theta_rad[BRACE_FEMUR],
                          (double)now()->theta_rad[BRACE_TIBIA]);
    assert_is_reference(&space->engaged, &r);
    const parts_t parts = next_parts();
    assert_parts_are(&parts, now());
    TEST_ASSERT_EQUAL_FLOAT(0.0f, parts.g.k_across_n_per_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, entry_float(ENTRY_K_ACROSS));
    for (int i = 0; i < 300; i++) { /* a load that decides the flank closes the gap */
        fake.joint[BRACE_COXA].sample.torque_n_mm = 1500.0f;
        ticks(1);
    }
    TEST_ASSERT_EQUAL_HEX32(0u, now()->space.now.flags);
    TEST_ASSERT_EQUAL_FLOAT(now()->space.engaged_across_n_per_mm, now()->space.across_n_per_mm);
    TEST_ASSERT_EQUAL(BRACE_BACKLASH_ENGAGED_POSITIVE, now()->play[BRACE_COXA].state);
    TEST_ASSERT_EQUAL(BRACE_BACKLASH_ENGAGED_POSITIVE, read_entry(ENTRY_PLAY_COXA));
}

static void test_without_its_sensor_K_in_space_is_not_known_and_the_planes_stays(void)
{
    const float k_xx_n_per_mm = now()->stiffness.now.k_xx_n_per_mm;
    brace_can_frame_t frame;
    uint32_t emergencies = 0;
    fake.joint[BRACE_COXA].not_newer = true;
    for (int i = 0; i < 100; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            emergencies += frame.id == 0x080 + NODE && frame.data[5] == BRACE_FAULT_SENSOR_COXA >> 8;
        }
    }
    TEST_ASSERT_EQUAL(1, emergencies);
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_SENSOR_COXA, now()->faults);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
    TEST_ASSERT_TRUE(now()->k_is_valid);
    TEST_ASSERT_EQUAL_FLOAT(k_xx_n_per_mm, now()->stiffness.now.k_xx_n_per_mm);
    TEST_ASSERT_FALSE(now()->space.is_valid);
    const parts_t parts = next_parts();
    TEST_ASSERT_TRUE(isnan(parts.a.k_xx_n_per_mm) && isnan(parts.b.k_yy_n_per_mm) && isnan(parts.c.k_zz_n_per_mm));
    TEST_ASSERT_TRUE(isnan(parts.d.lambda_1_n_per_mm) && isnan(parts.e.lambda_3_n_per_mm));
    TEST_ASSERT_TRUE(isnan(parts.f.stiff_axis_y) && isnan(parts.g.k_across_n_per_mm));
    TEST_ASSERT_EQUAL_HEX32(BRACE_FLAG_STALE | BRACE_FLAG_LOAD_UNKNOWN, parts.e.flags);
    TEST_ASSERT_EQUAL(0, read_entry(ENTRY_IN_SPACE));
    TEST_ASSERT_TRUE(isnan(entry_float(ENTRY_K_XX)));
    TEST_ASSERT_EQUAL_HEX32(BRACE_FAULT_SENSOR_COXA, read_entry(ENTRY_FAULTS));
    fake.joint[BRACE_COXA].not_newer = false;
    ticks(200);
    TEST_ASSERT_TRUE(now()->space.is_valid);
    TEST_ASSERT_EQUAL_HEX32(0, now()->faults);
}

static void test_where_there_is_no_coxa_joint_nothing_is_a_number(void)
{
    const brace_parameters_t p = space_parameters();
    bench_start(&p);
    ticks(20);
    TEST_ASSERT_EQUAL(0, read_entry(ENTRY_IN_SPACE));
    for (uint32_t entry = ENTRY_THETA0; entry < ENTRY_K_XX + 12u; entry++) {
        TEST_ASSERT_TRUE(isnan(entry_float(entry)));
    }
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, read_entry(ENTRY_K_XX + 12u)); /* space_flags */
    TEST_ASSERT_TRUE(isnan(entry_float(ENTRY_K_ACROSS)));
    TEST_ASSERT_EQUAL(1, read_entry(0x1000 + 8)); /* and K in the plane is valid */
}

/* Each joint's motor behind its gap, pulled by a servo: test_app_takeup.c. */
static void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    brace_fake_joint_t *ours = &board->joint[joint];
    const float asked = ours->command.offset_rad, half = 0.5f * GAP_RAD;
    float moved = asked, torque = 0.0f;
    if (!link_is_free[joint] && (asked > half || asked < -half)) {
        const float edge = asked > 0.0f ? half : -half;
        moved = (SERVO_N_MM_PER_RAD * asked + SPRING_N_MM_PER_RAD * edge) / (SERVO_N_MM_PER_RAD + SPRING_N_MM_PER_RAD);
        torque = SPRING_N_MM_PER_RAD * (moved - edge);
    }
    ours->sample.motor_rad = middle_rad[joint] + moved;
    ours->sample.torque_n_mm = torque;
}

static void start_with_play(void)
{
    brace_parameters_t p = space_parameters();
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.limb.joint[i].gap_rad = GAP_RAD;
    }
    start_with(&p);
    fake.play = play;
    ticks(50);
    drain();
}

static void take_up(uint32_t joint)
{
    uint8_t data[8];
    brace_can_pack_take_up_request(&(brace_can_take_up_request_t){1, joint, 1}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL_HEX8(BRACE_TAKE_UP_ANSWER_0, answer.part[0][0]);
}

static brace_can_take_up_result_answer_0_t take_up_result(uint32_t joint)
{
    uint8_t data[8];
    brace_can_take_up_result_answer_0_t result;
    brace_can_pack_take_up_result_request(&(brace_can_take_up_result_request_t){1, joint}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    brace_can_unpack_take_up_result_answer_0(answer.part[0], &result);
    TEST_ASSERT_EQUAL(joint, result.joint);
    return result;
}

static void test_the_coxa_joint_is_taken_up_and_carries_across(void)
{
    start_with_play();
    begin_to_live();
    TEST_ASSERT_EQUAL_FLOAT(0.0f, now()->space.across_n_per_mm);
    take_up(BRACE_COXA);
    for (int i = 0; i < 10000 && now()->play[BRACE_COXA].phase != BRACE_TAKEUP_HOLD; i++) {
        ticks(1);
    }
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, now()->play[BRACE_COXA].phase);
    TEST_ASSERT_TRUE(now()->space.across_n_per_mm > 0.0f);
    TEST_ASSERT_EQUAL_FLOAT(now()->space.engaged_across_n_per_mm, now()->space.across_n_per_mm);
    drain();
    const brace_can_take_up_result_answer_0_t result = take_up_result(BRACE_COXA);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_DONE, result.outcome);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_HOLD, result.phase);
    TEST_ASSERT_FLOAT_WITHIN(0.06f, fake.joint[BRACE_COXA].sample.torque_n_mm, result.torque_n_mm);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_DONE, read_entry(ENTRY_TAKE_UP + BRACE_COXA));
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_NONE, read_entry(ENTRY_TAKE_UP + BRACE_FEMUR));
    const parts_t parts = next_parts();
    TEST_ASSERT_TRUE(parts.g.k_across_n_per_mm > 0.0f);
}

static void test_every_wire_reports_why_a_take_up_failed(void)
{
    for (uint32_t joint = BRACE_COXA; joint < BRACE_LINK_COUNT; joint++) {
        start_with_play();
        begin_to_live();
        link_is_free[joint] = true; /* nothing holds it */
        take_up(joint);
        ticks(1);
        TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
        for (int i = 0; i < 10000 && now()->mode != BRACE_MODE_MONITOR; i++) {
            ticks(1);
        }
        drain();
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_E_TRAVEL, now()->play[joint].takeup);
        TEST_ASSERT_EQUAL(BRACE_TAKEUP_E_TRAVEL, take_up_result(joint).outcome);
        TEST_ASSERT_EQUAL(256 + BRACE_TAKEUP_E_TRAVEL, read_entry(ENTRY_TAKE_UP + joint));
        const reply_t reply = read_asks(4, 194, 6);
        for (uint32_t other = BRACE_COXA; other < BRACE_LINK_COUNT; other++) {
            const int32_t wanted = other == joint ? 256 + (int32_t)BRACE_TAKEUP_E_TRAVEL : (int32_t)BRACE_TAKEUP_NONE;
            TEST_ASSERT_EQUAL(wanted, value_at(&reply, other));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_K_in_space_is_the_reference_at_every_posture);
    RUN_TEST(test_K_in_space_elsewhere_is_the_reference);
    RUN_TEST(test_K_in_space_beyond_the_travel_is_flagged);
    RUN_TEST(test_K_here_is_K_as_asked_for_here);
    RUN_TEST(test_K_in_space_elsewhere_counts_a_force_once);
    RUN_TEST(test_K_in_space_elsewhere_under_a_force_that_folds_the_limb_is_refused);
    RUN_TEST(test_K_in_space_elsewhere_under_a_force_over_the_line_and_over_TCP);
    RUN_TEST(test_frames_of_a_snapshot_come_whole_and_are_never_mixed);
    RUN_TEST(test_over_CAN_FD_it_is_one_frame_more);
    RUN_TEST(test_its_frames_count_in_what_the_bus_may_carry);
    RUN_TEST(test_the_load_across_the_plane_is_sent_with_the_load);
    RUN_TEST(test_registers_and_entries_report_it);
    RUN_TEST(test_an_open_gap_of_the_coxa_joint_carries_nothing_across);
    RUN_TEST(test_without_its_sensor_K_in_space_is_not_known_and_the_planes_stays);
    RUN_TEST(test_where_there_is_no_coxa_joint_nothing_is_a_number);
    RUN_TEST(test_the_coxa_joint_is_taken_up_and_carries_across);
    RUN_TEST(test_every_wire_reports_why_a_take_up_failed);
    return UNITY_END();
}
