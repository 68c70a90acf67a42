/* Questions for K where the limb is not, on every port: under a force or under the weight alone, in turn and in time;
 * and the direction of down, which the main computer sets. */
#include "can_bench.h"
#include "modbus_master.h"

#define DOWN_RAD (-1.57079633f)

enum {
    ALL_PORTS_TICKS = 8 + 1 + 3, /* four ports ask at once; process data may leave meanwhile, and K's
                                    uncertainty has each fourth tick */
    LINE_TICKS = 3,      /* a request on the line: bytes and silence */
    ASKED_THETA1 = 0x400c,
    ASKED_GRAVITY = 16418,
    ASKED_POSTURE_FORCE = 16422,
    ASKED_TIP_FORCE = 16430,
    LOADED = 4128,
    TAKEN_GRAVITY = 4148 /* docs/modbus.md */
};

static brace_parameters_t parameters;

static void start(void)
{
    bench_start(&parameters);
    ticks(50);
    drain();
}

void setUp(void)
{
    parameters = bench_parameters();
    parameters.controller.modbus_address = UNIT;
    parameters.gravity.femur_n = 2.0f;
    parameters.gravity.tibia_n = 3.0f;
    start();
}

void tearDown(void) {}

static brace_loaded_stiffness_t expected(float theta1_rad, float theta2_rad, float x_n, float z_n)
{
    return equilibrium(&parameters, theta1_rad, theta2_rad, (brace_force_t){x_n, z_n}, (brace_vec_t){0.0f, -1.0f});
}

/* ----------------------------------------------------------------------------------------------- CAN -- */

static void assert_reported(const answer_t *answer, const brace_loaded_stiffness_t *k)
{
    brace_can_k_under_load_at_posture_answer_0_t a;
    brace_can_k_under_load_at_posture_answer_3_t d;
    brace_can_k_under_load_at_posture_answer_4_t e;
    TEST_ASSERT_EQUAL(5, answer->count);
    brace_can_unpack_k_under_load_at_posture_answer_0(answer->part[0], &a);
    brace_can_unpack_k_under_load_at_posture_answer_3(answer->part[3], &d);
    brace_can_unpack_k_under_load_at_posture_answer_4(answer->part[4], &e);
    ASSERT_CLOSE(k->stiffness.k_xx_n_per_mm, a.k_xx_n_per_mm, 4e-4);
    ASSERT_CLOSE(k->stiffness.k_xz_n_per_mm, a.k_xz_n_per_mm, 4e-4);
    ASSERT_CLOSE(k->displacement.x_mm, d.dx_mm, 2e-3);
    ASSERT_CLOSE(k->displacement.z_mm, d.dz_mm, 2e-3);
    TEST_ASSERT_TRUE(isinf(k->buckling_factor) ? isinf(e.buckling_factor)
                                               : fabsf(k->buckling_factor - e.buckling_factor) < 1e-2f);
    TEST_ASSERT_EQUAL_HEX32(k->buckling_factor < 3.0f ? BRACE_FLAG_SOFTENED : 0u, e.flags);
}

static answer_t ask_for_force(float x_n, float z_n)
{
    uint8_t data[8];
    brace_can_pack_tip_force_request(&(brace_can_tip_force_request_t){3, x_n, z_n}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(1, answer.count);
    return answer;
}

static answer_t ask_under_load(float theta1_rad, float theta2_rad)
{
    uint8_t data[8];
    brace_can_pack_k_under_load_at_posture_request(
        &(brace_can_k_under_load_at_posture_request_t){4, theta1_rad, theta2_rad}, data);
    return ask_within(data, K_TICKS);
}

static void test_K_under_a_force_over_CAN_and_the_force_is_used_up(void)
{
    static const float force_n[][2] = {{0.0f, 10.0f}, {-40.0f, 0.0f}, {5.0f, -3.0f}};
    for (int i = 0; i < 3; i++) {
        (void)ask_for_force(force_n[i][0], force_n[i][1]);
        const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, force_n[i][0], force_n[i][1]);
        answer_t answer = ask_under_load(0.8f, 1.2f);
        assert_reported(&answer, &k);
        answer = ask_under_load(0.8f, 1.2f); /* the force belonged to that question */
        TEST_ASSERT_EQUAL(BRACE_REFUSED_ORDER, refusal_of(&answer, BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE).status);
    }
}

static void test_at_a_tip_the_posture_is_the_one_before_the_load_moves_it(void)
{
    const double x = 185.0 * cos(0.7) + 313.5 * cos(0.7 - 1.2), z = 185.0 * sin(0.7) + 313.5 * sin(0.7 - 1.2);
    uint8_t data[8];
    (void)ask_for_force(0.0f, 8.0f);
    brace_can_pack_k_under_load_at_tip_knee_up_request(
        &(brace_can_k_under_load_at_tip_knee_up_request_t){4, (float)x, (float)z}, data);
    const answer_t answer = ask_within(data, K_TICKS);
    const brace_loaded_stiffness_t k = expected(0.7f, 1.2f, 0.0f, 8.0f);
    assert_reported(&answer, &k);
}

/* The old questions mean no force on the tip; the limb weighs all the same. */
static void test_without_a_force_the_weight_counts(void)
{
    uint8_t data[8];
    brace_can_k_at_posture_answer_0_t a;
    brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){4, 0.8f, 1.2f}, data);
    const answer_t answer = ask_within(data, K_TICKS);
    TEST_ASSERT_EQUAL(4, answer.count);
    brace_can_unpack_k_at_posture_answer_0(answer.part[0], &a);
    const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, 0.0f, 0.0f);
    ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, a.k_xx_n_per_mm, 4e-4);
    parameters.gravity.femur_n = parameters.gravity.tibia_n = 0.0f;
    const brace_loaded_stiffness_t weightless = expected(0.8f, 1.2f, 0.0f, 0.0f);
    TEST_ASSERT_TRUE(fabsf(weightless.stiffness.k_xx_n_per_mm - a.k_xx_n_per_mm) > 2e-3f);
}

/* Each joint yields as warm as it is, elsewhere as here. */
static void test_a_warm_joint_yields_more_wherever_it_is_asked(void)
{
    parameters.slow.joint_compliance_per_degc = 0.01f;
    parameters.slow.reference_degc = 20.0f;
    start();
    fake.joint[BRACE_FEMUR].sample.temp_degc = 40.0f;
    fake.joint[BRACE_TIBIA].sample.temp_degc = 70.0f;
    ticks(2);
    drain();
    (void)ask_for_force(2.0f, 5.0f);
    const answer_t answer = ask_under_load(0.8f, 1.2f);
    parameters.limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm *= 1.2f;
    parameters.limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= 1.5f;
    const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, 2.0f, 5.0f);
    assert_reported(&answer, &k);
}

static question_inputs_t inputs_of_job(void)
{
    return (question_inputs_t){.model = &app.controller.model,
                               .parameters = brace_app_parameters(&app),
                               .is_calibrated = true,
                               .joints = &app.controller.joints,
                               .down = app.controller.gravity.down};
}

/* Somebody gives up while its K is half worked out: the next one gets the K of its own question. */
static void test_what_was_given_up_is_nobody_else_s(void)
{
    question_job_t *job = &app.controller.question;
    const question_inputs_t inputs = inputs_of_job();
    const brace_k_question_t first = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.3f, 0.9f}};
    const brace_k_question_t second = {
        .where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.8f, 1.2f}, .tip_force = {2.0f, 5.0f}};
    brace_k_answer_t answer;
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &first, &answer));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 1)); /* the first of two steps */
    for (int i = 0; i < 10; i++) {
        question_job_age(job);
    }
    TEST_ASSERT_FALSE(question_job_is_coming(job, BRACE_ASKER_CAN));
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_MODBUS_TCP, &second, &answer));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 1));
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_MODBUS_TCP, &second, &answer));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 1));
    TEST_ASSERT_EQUAL(BRACE_OK, question_job_ask(job, BRACE_ASKER_MODBUS_TCP, &second, &answer));
    const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, 2.0f, 5.0f);
    ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, answer.k.k_xx_n_per_mm, 4e-4);
    ASSERT_CLOSE(k.displacement.z_mm, answer.moved_mm.z_mm, 2e-3);
}

/* Where all questions are forgotten, the one in work is, too: whoever asks next waits for the K of its own question. */
static void test_what_was_in_work_is_forgotten_with_the_rest(void)
{
    question_job_t *job = &app.controller.question;
    const question_inputs_t inputs = inputs_of_job();
    const brace_k_question_t first = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.3f, 0.9f}};
    const brace_k_question_t second = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.8f, 1.2f}};
    brace_k_answer_t answer;
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &first, &answer));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 1));
    question_job_forget(job);
    TEST_ASSERT_FALSE(question_job_work(job, &inputs, 1));
    brace_k_question_t odd; /* whatever its words are, nobody has answered it */
    memset(&odd, 0xff, sizeof odd);
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &odd, &answer));
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &second, &answer));
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &second, &answer));
        TEST_ASSERT_TRUE(question_job_work(job, &inputs, 1));
    }
    TEST_ASSERT_EQUAL(BRACE_OK, question_job_ask(job, BRACE_ASKER_CAN, &second, &answer));
    const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, 0.0f, 0.0f);
    ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, answer.k.k_xx_n_per_mm, 4e-4);
}

/* An answer that nobody has taken gives way to the next one, and does not go to whom the next one is not for. Who still
 * waits keeps its place. */
static void test_an_answer_goes_to_its_asker_alone(void)
{
    question_job_t *job = &app.controller.question;
    const question_inputs_t inputs = inputs_of_job();
    const brace_k_question_t one = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.3f, 0.9f}};
    const brace_k_question_t two = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.8f, 1.2f}};
    brace_k_answer_t answer;
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &one, &answer));
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_SLCAN, &two, &answer));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 2));
    TEST_ASSERT_FALSE(question_job_is_coming(job, BRACE_ASKER_CAN));
    TEST_ASSERT_TRUE(question_job_is_coming(job, BRACE_ASKER_SLCAN));
    TEST_ASSERT_TRUE(question_job_work(job, &inputs, 2));
    TEST_ASSERT_FALSE(question_job_is_coming(job, BRACE_ASKER_SLCAN));
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(job, BRACE_ASKER_CAN, &one, &answer)); /* it came too late */
    TEST_ASSERT_EQUAL(BRACE_OK, question_job_ask(job, BRACE_ASKER_SLCAN, &two, &answer));
    const brace_loaded_stiffness_t k = expected(0.8f, 1.2f, 0.0f, 0.0f);
    ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, answer.k.k_xx_n_per_mm, 4e-4);
}

/* In a tick in which the wires have nothing to do, a question has both of its steps; a node that only listens on its
 * bus has nothing to do there. */
static void test_a_quiet_tick_answers_at_once(void)
{
    const brace_k_question_t question = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.8f, 1.2f}};
    brace_k_answer_t answer;
    parameters.controller.node_id = 0;
    start();
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL(BRACE_APP_LATER, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer));
        ticks(1);
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer));
        ticks(1);
    }
}

/* A board that nobody has configured answers too, and says that its limb is nobody's. */
static void test_without_parameters_the_answer_is_uncalibrated(void)
{
    bench_board();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    brace_k_question_t question = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 1.0f, 1.4f}};
    brace_k_answer_t found;
    int32_t status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &found);
    for (int i = 0; i < 5 && status == BRACE_APP_LATER; i++) {
        ticks(1);
        status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &found);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, status);
    TEST_ASSERT_BITS_HIGH(BRACE_FLAG_UNCALIBRATED, found.k.flags);
}

static void test_a_force_that_folds_the_limb_or_is_none_is_refused(void)
{
    (void)ask_for_force(-300.0f, 0.0f); /* along the straight limb */
    answer_t answer = ask_under_load(0.0f, 0.0f);
    TEST_ASSERT_EQUAL(BRACE_E_SINGULAR, refusal_of(&answer, BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE).status);
    (void)ask_for_force(__builtin_nanf(""), 0.0f);
    answer = ask_under_load(1.0f, 1.4f);
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, refusal_of(&answer, BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE).status);
}

/* -------------------------------------------------------------------------------------------- Modbus -- */

static uint32_t write_of(uint32_t first, const float *values, uint32_t count, int32_t last, uint8_t *pdu)
{
    const uint32_t all = count + (last >= 0);
    const uint8_t head[] = {16, (uint8_t)(first >> 8), (uint8_t)first, 0, (uint8_t)(2u * all), (uint8_t)(4u * all)};
    memcpy(pdu, head, sizeof head);
    for (uint32_t i = 0; i < all; i++) {
        const uint32_t word = i < count ? bits(values[i]) : (uint32_t)last;
        for (uint32_t j = 0; j < 4u; j++) {
            pdu[sizeof head + 4u * i + j] = (uint8_t)(word >> (24u - 8u * j));
        }
    }
    return (uint32_t)sizeof head + 4u * all;
}

typedef reply_t (*asks_t)(uint8_t unit, const uint8_t *pdu, uint32_t count);

static void asked_over_modbus(asks_t asks)
{
    const double x = 185.0 * cos(0.7) + 313.5 * cos(0.7 - 1.2), z = 185.0 * sin(0.7) + 313.5 * sin(0.7 - 1.2);
    const float at_posture[] = {0.0f, 10.0f, 0.8f, 1.2f}, at_tip[] = {-6.0f, 3.0f, (float)x, (float)z};
    const uint8_t read[] = {4, LOADED >> 8, LOADED & 0xff, 0, 20};
    for (int tip = 0; tip < 2; tip++) {
        uint8_t pdu[64];
        const uint32_t count =
            tip ? write_of(ASKED_TIP_FORCE, at_tip, 4, 0, pdu) : write_of(ASKED_POSTURE_FORCE, at_posture, 4, -1, pdu);
        TEST_ASSERT_EQUAL(5, asks(UNIT, pdu, count).count);
        const reply_t reported = asks(UNIT, read, sizeof read);
        const brace_loaded_stiffness_t k = tip ? expected(0.7f, 1.2f, -6.0f, 3.0f) : expected(0.8f, 1.2f, 0.0f, 10.0f);
        ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, float_at(&reported, 0), 1e-4);
        ASSERT_CLOSE(k.stiffness.k_zz_n_per_mm, float_at(&reported, 2), 1e-4);
        ASSERT_CLOSE(k.displacement.x_mm, float_at(&reported, 6), 1e-3);
        ASSERT_CLOSE(k.displacement.z_mm, float_at(&reported, 7), 1e-3);
        TEST_ASSERT_EQUAL_FLOAT(k.buckling_factor, float_at(&reported, 8));
    }
}

/* No K is an answer, too: its registers say so, and the question stands. */
static void test_a_force_that_folds_the_limb_has_no_K_over_Modbus(void)
{
    const float folds[] = {-300.0f, 0.0f, 0.0f, 0.0f};
    uint8_t pdu[64];
    asked_over_modbus(line_asks);
    TEST_ASSERT_EQUAL(5, line_asks(UNIT, pdu, write_of(ASKED_POSTURE_FORCE, folds, 4, -1, pdu)).count);
    const reply_t reported = read_asks(4, LOADED, 20), asked = read_asks(3, ASKED_POSTURE_FORCE, 2);
    for (uint32_t i = 0; i < 9u; i++) {
        TEST_ASSERT_TRUE(isnan(float_at(&reported, i)));
    }
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, value_at(&reported, 9));
    TEST_ASSERT_EQUAL_FLOAT(-300.0f, float_at(&asked, 0));
}

static void test_K_under_a_force_over_the_line_and_over_TCP(void)
{
    asked_over_modbus(line_asks);
    asked_over_modbus(tcp_asks);
}

/* --------------------------------------------------------------------------------- all ports at once -- */

static void as_text(const uint8_t data[8])
{
    char line[40];
    uint32_t at = (uint32_t)snprintf(line, sizeof line, "t%03X8", 0x600u + NODE);
    for (uint32_t i = 0; i < 8u; i++) {
        at += (uint32_t)snprintf(line + at, sizeof line - at, "%02X", data[i]);
    }
    line[at++] = '\r';
    TEST_ASSERT_EQUAL(at, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)line, at));
}

static uint32_t heard_on(brace_serial_port_t port)
{
    uint8_t bytes[600];
    return brace_fake_bytes_take(&fake, port, bytes, sizeof bytes);
}

static void test_four_ports_that_ask_at_once_are_answered_within_twelve_ticks(void)
{
    TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2));
    ticks(3);
    for (int turn = 0; turn < 200; turn++) {
        const float theta_rad[] = {0.3f + 0.004f * (float)turn, 1.2f};
        uint8_t data[8], pdu[32], adu[40] = {0, 1, 0, 0, 0, 0, UNIT}, frame[40] = {UNIT};
        brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){1, theta_rad[0], theta_rad[1]}, data);
        const uint32_t count = write_of(ASKED_THETA1, theta_rad, 2, -1, pdu);
        memcpy(frame + 1, pdu, count);
        const uint32_t crc = crc_by_bits(frame, count + 1u);
        frame[count + 1u] = (uint8_t)crc;
        frame[count + 2u] = (uint8_t)(crc >> 8);
        line_says(frame, count + 3u);
        ticks(LINE_TICKS - 1 + turn % 2); /* the line's request ends with silence: all are whole about now */
        memcpy(adu + 7, pdu, count);
        adu[5] = (uint8_t)(count + 1u);
        TEST_ASSERT_EQUAL(count + 7u, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS_TCP, adu, count + 7u));
        arrives(0x600u + NODE, data, 8);
        as_text(data);
        (void)heard_on(BRACE_SERIAL_SLCAN);
        bool answered[4] = {false};
        for (int i = 0; i <= ALL_PORTS_TICKS; i++) { /* the first tick takes them */
            answer_t answer = {0};
            ticks(1);
            collect(&answer);
            answered[0] = answered[0] || answer.count == 4;
            answered[1] = answered[1] || heard_on(BRACE_SERIAL_SLCAN) > 4u * 20u;
            answered[2] = answered[2] || heard_on(BRACE_SERIAL_MODBUS) == 8u;
            answered[3] = answered[3] || heard_on(BRACE_SERIAL_MODBUS_TCP) == 12u;
        }
        TEST_ASSERT_TRUE(answered[0] && answered[1] && answered[2] && answered[3]);
    }
}

/* A tick that works on a K answers another port's request all the same. */
static void test_other_requests_are_answered_in_the_tick_that_finds_them(void)
{
    TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2));
    ticks(3);
    for (int turn = 0; turn < 20; turn++) {
        uint8_t k[8], entry[8];
        brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){1, 0.8f, 1.2f}, k);
        brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){9, BRACE_ENTRY_MEASURED}, entry);
        as_text(k);
        for (int i = 0; i < 4; i++) { /* taken, worked on in the same tick and in the next, answered in the third */
            drain();
            TEST_ASSERT_EQUAL(1, ask_within(entry, 1).count);
        }
        TEST_ASSERT_TRUE(heard_on(BRACE_SERIAL_SLCAN) > 3u * 20u);
    }
}

/* Who does not come back for its answer blocks nobody. */
/* Who asks another question before the answer to the first has come is answered the second. */
static void test_the_last_question_is_answered(void)
{
    brace_k_answer_t answer = {0}, wanted = {0};
    const brace_k_question_t first = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.5f, 1.0f}};
    const brace_k_question_t second = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.5f, 1.3f}};
    for (int i = 0; i < 2; i++) { /* alone, then behind the other */
        if (i == 1) {
            TEST_ASSERT_EQUAL(BRACE_APP_LATER, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &first, &answer));
        }
        int32_t status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &second, &answer);
        TEST_ASSERT_EQUAL(BRACE_APP_LATER, status);
        for (int tick = 0; tick < 10 && status == BRACE_APP_LATER; tick++) {
            ticks(1);
            status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &second, &answer);
        }
        TEST_ASSERT_EQUAL(BRACE_OK, status);
        wanted = i == 0 ? answer : wanted;
    }
    TEST_ASSERT_EQUAL_MEMORY(&wanted.k, &answer.k, sizeof answer.k);
}

static void test_a_port_that_is_closed_loses_its_question(void)
{
    uint8_t data[8];
    TEST_ASSERT_EQUAL(2, brace_fake_bytes_arrive(&fake, BRACE_SERIAL_SLCAN, (const uint8_t *)"O\r", 2));
    ticks(3);
    brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){1, 0.8f, 1.2f}, data);
    as_text(data);
    ticks(1);
    const brace_k_question_t question = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 0.5f, 1.0f}};
    brace_k_answer_t answer;
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer));
    ticks(10); /* the program has gone: its question is dropped, and the port has its answer */
    TEST_ASSERT_TRUE(heard_on(BRACE_SERIAL_SLCAN) > 60u);
    TEST_ASSERT_EQUAL(BRACE_APP_LATER, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer));
    ticks(2);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &answer));
    const brace_loaded_stiffness_t k = expected(0.5f, 1.0f, 0.0f, 0.0f);
    ASSERT_CLOSE(k.stiffness.k_xx_n_per_mm, answer.k.k_xx_n_per_mm, 1e-4);
}

/* ---------------------------------------------------------------------------------- where down is -- */

static void assert_down(float direction_rad, float lean_rad)
{
    fake.force_x_n = 1.0f;
    fake.force_z_n = 6.0f;
    ticks(2);
    drain();
    const brace_vec_t down = {(float)(cos((double)lean_rad) * cos((double)direction_rad)),
                              (float)(cos((double)lean_rad) * sin((double)direction_rad))};
    const brace_loaded_stiffness_t k = equilibrium(&parameters, 1.0f, 1.4f, (brace_force_t){1.0f, 6.0f}, down);
    ASSERT_CLOSE(k.stiffness.k_zz_n_per_mm, now()->stiffness.now.k_zz_n_per_mm, 1e-5);
    ASSERT_CLOSE(k.displacement.x_mm, now()->load.moved_x_mm, 1e-3);
    ASSERT_CLOSE(direction_rad, now()->gravity_direction_rad, 1e-6);
    ASSERT_CLOSE(lean_rad, now()->gravity_lean_rad, 1e-6);
}

static answer_t set_gravity(float direction_rad, float lean_rad)
{
    uint8_t data[8];
    brace_can_pack_set_gravity_request(&(brace_can_set_gravity_request_t){5, direction_rad, lean_rad}, data);
    return ask(data);
}

static void test_the_main_computer_sets_where_down_is_until_the_next_start(void)
{
    const float unknown = __builtin_nanf("");
    brace_can_set_gravity_answer_0_t reported;
    assert_down(DOWN_RAD, 0.0f);
    answer_t answer = set_gravity(0.4f, -0.3f);
    brace_can_unpack_set_gravity_answer_0(answer.part[0], &reported);
    ASSERT_CLOSE(0.4, reported.direction_rad, 1e-6);
    ASSERT_CLOSE(-0.3, reported.lean_rad, 1e-6);
    assert_down(0.4f, -0.3f);
    answer = set_gravity(4.0f, 0.0f);
    TEST_ASSERT_EQUAL(BRACE_E_RANGE, refusal_of(&answer, BRACE_REQUEST_SET_GRAVITY).status);
    answer = set_gravity(unknown, 0.0f);
    TEST_ASSERT_EQUAL(BRACE_E_NOT_FINITE, refusal_of(&answer, BRACE_REQUEST_SET_GRAVITY).status);
    assert_down(0.4f, -0.3f);
    (void)set_gravity(unknown, unknown); /* the parameters' own again */
    assert_down(DOWN_RAD, 0.0f);
    (void)set_gravity(0.4f, -0.3f);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    assert_down(DOWN_RAD, 0.0f);
}

static void test_down_is_set_over_Modbus_too(void)
{
    const float values[] = {2.0f, 0.5f};
    const uint8_t read[] = {4, TAKEN_GRAVITY >> 8, TAKEN_GRAVITY & 0xff, 0, 4};
    uint8_t pdu[32];
    const uint32_t count = write_of(ASKED_GRAVITY, values, 2, -1, pdu);
    TEST_ASSERT_EQUAL(5, line_asks(UNIT, pdu, count).count);
    const reply_t reported = line_asks(UNIT, read, sizeof read);
    ASSERT_CLOSE(2.0, float_at(&reported, 0), 1e-6);
    ASSERT_CLOSE(0.5, float_at(&reported, 1), 1e-6);
    assert_down(2.0f, 0.5f);
}

static bool is_kept(const question_job_t *job, brace_asker_t asker)
{
    return job->slot[asker].phase != 0u;
}

/* A port that stops asking is forgotten after six ticks. A port that asks again in time is not. */
static void test_a_question_is_kept_for_six_ticks(void)
{
    static question_job_t job;
    const brace_k_question_t question = {.where = BRACE_K_AT_POSTURE, .theta_rad = {0.0f, 1.0f, 1.4f}};
    brace_k_answer_t answer;
    for (int asker = 0; asker < (int)BRACE_ASKER_COUNT; asker++) {
        memset(&job, 0, sizeof job);
        for (int round = 0; round < 3; round++) {
            TEST_ASSERT_EQUAL(BRACE_APP_LATER, question_job_ask(&job, (brace_asker_t)asker, &question, &answer));
            for (int i = 0; i < 6; i++) {
                TEST_ASSERT_TRUE(is_kept(&job, (brace_asker_t)asker));
                question_job_age(&job);
            }
        }
        TEST_ASSERT_TRUE(is_kept(&job, (brace_asker_t)asker));
        question_job_age(&job);
        TEST_ASSERT_FALSE(is_kept(&job, (brace_asker_t)asker));
    }
}

/* --------------------------------------------------------------------------------------- in space -- */

static void start_in_space(void)
{
    bench_board();
    bench_store(&parameters);
    fake.joint[BRACE_COXA].absent = false;
    fake.joint[BRACE_COXA].sample.motor_rad = 0.4f;
    fake.force_x_n = 2.0f;
    fake.force_z_n = 6.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(50);
    TEST_ASSERT_TRUE(now()->space.is_valid && now()->load.is_counted);
}

/* Asked for where the limb stands, under the load that it bears, the job finds the K that the tick reports: nine steps,
 * of which a tick does one or two. */
static void test_K_in_space_is_that_of_the_tick(void)
{
    brace_k_answer_t found;
    int32_t status = BRACE_APP_LATER;
    int waited = 0;
    start_in_space();
    const float *unbent_rad = app.controller.posture.unbent_rad;
    const brace_snapshot_load_t *load = &now()->load;
    const brace_k_question_t question = {.where = BRACE_K_IN_SPACE,
                                         .theta_rad = {unbent_rad[0], unbent_rad[1], unbent_rad[2]},
                                         .tip_force = {load->force_x_n, load->force_z_n},
                                         .force_across_n = load->force_y_n};
    for (; waited < 20 && status == BRACE_APP_LATER; waited++) {
        status = brace_app_ask_k(&app, BRACE_ASKER_PROGRAM, &question, &found);
        ticks(status == BRACE_APP_LATER);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, status);
    TEST_ASSERT_LESS_OR_EQUAL(1 + 9, waited);
    const brace_stiffness_spatial_t *reported = &now()->space.now, *k = &found.in_space;
    const float largest = reported->lambda_n_per_mm[2];
    TEST_ASSERT_FLOAT_WITHIN(1e-4f * largest, reported->k_xx_n_per_mm, k->k_xx_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f * largest, reported->k_xy_n_per_mm, k->k_xy_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f * largest, reported->k_yz_n_per_mm, k->k_yz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f * largest, reported->k_zz_n_per_mm, k->k_zz_n_per_mm);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, load->moved_y_mm, found.moved_across_mm);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_K_under_a_force_over_CAN_and_the_force_is_used_up);
    RUN_TEST(test_at_a_tip_the_posture_is_the_one_before_the_load_moves_it);
    RUN_TEST(test_without_a_force_the_weight_counts);
    RUN_TEST(test_an_answer_goes_to_its_asker_alone);
    RUN_TEST(test_a_quiet_tick_answers_at_once);
    RUN_TEST(test_what_was_given_up_is_nobody_else_s);
    RUN_TEST(test_what_was_in_work_is_forgotten_with_the_rest);
    RUN_TEST(test_a_warm_joint_yields_more_wherever_it_is_asked);
    RUN_TEST(test_without_parameters_the_answer_is_uncalibrated);
    RUN_TEST(test_a_force_that_folds_the_limb_or_is_none_is_refused);
    RUN_TEST(test_a_force_that_folds_the_limb_has_no_K_over_Modbus);
    RUN_TEST(test_K_under_a_force_over_the_line_and_over_TCP);
    RUN_TEST(test_four_ports_that_ask_at_once_are_answered_within_twelve_ticks);
    RUN_TEST(test_other_requests_are_answered_in_the_tick_that_finds_them);
    RUN_TEST(test_the_last_question_is_answered);
    RUN_TEST(test_a_port_that_is_closed_loses_its_question);
    RUN_TEST(test_the_main_computer_sets_where_down_is_until_the_next_start);
    RUN_TEST(test_down_is_set_over_Modbus_too);
    RUN_TEST(test_a_question_is_kept_for_six_ticks);
    RUN_TEST(test_K_in_space_is_that_of_the_tick);
    return UNITY_END();
}
