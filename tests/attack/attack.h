/* A limb with play on a guarded board or a bench, its operator, who has the key, and somebody else on the same buses.
 *
 * Each attack says what it sends. Then the limb must have commanded nothing new, the set in force and what is staged
 * must be the operator's, and the controller must have refused, reported and counted. */
#ifndef ATTACK_H
#define ATTACK_H

#include <stdio.h>
#include <string.h>

#include "brace/words.h"
#include "can_bench.h"
#include "modbus_master.h"
#include "session/siphash.h"

enum { OPERATOR_TOKEN = 0x20, MASTER_OF_OPERATOR = 2, FIRST_COMMAND = BRACE_ENTRY_COMMANDS };
#define COMMAND_ENTRY(member) (FIRST_COMMAND + offsetof(brace_commands_t, member) / 4u)
#define COMMAND_REGISTER(member) (BRACE_REGISTER_COMMANDS + offsetof(brace_commands_t, member) / 2u)
#define ENTRY(member) (BRACE_ENTRY_MEASURED + offsetof(brace_measured_t, member) / 4u)

#define GAP_RAD 0.01f
#define SERVO_N_MM_PER_RAD 50000.0f
#define SPRING_N_MM_PER_RAD 80000.0f

static const uint8_t the_key[16] = {0x0f, 0x1e, 0x2d, 0x3c, 0x4b, 0x5a, 0x69, 0x78,
                                    0x87, 0x96, 0xa5, 0xb4, 0xc3, 0xd2, 0xe1, 0xf0};
static const uint8_t another_key[16] = {1};

static uint64_t challenge;
static uint32_t counter;
static bool has_coxa;           /* of the limb that start_limb starts */
static bool operator_lives;     /* the operator's signs of life go out every 40 ms */
static bool operator_begins;    /* its motion waits for a sign of life with the number that its answer brought */
static uint32_t begin_heard;
static uint8_t recorded[600][8]; /* every frame that the operator has sent over CAN */
static uint32_t recorded_count;

/* ------------------------------------------------------------------------------------------- the limb -- */

/* Links held by the ground, each motor behind its gap pulled by a servo. */
static inline void held_link(void *user, brace_fake_t *board, int32_t joint)
{
    static const float middle_rad[BRACE_LINK_COUNT] = {0.0f, 1.0f, 1.4f};
    (void)user;
    brace_fake_joint_t *ours = &board->joint[joint];
    const float asked = ours->command.offset_rad, half = 0.5f * GAP_RAD;
    float moved = asked, torque = 0.0f;
    if (asked > half || asked < -half) {
        const float edge = asked > 0.0f ? half : -half;
        moved = (SERVO_N_MM_PER_RAD * asked + SPRING_N_MM_PER_RAD * edge) / (SERVO_N_MM_PER_RAD + SPRING_N_MM_PER_RAD);
        torque = SPRING_N_MM_PER_RAD * (moved - edge);
        const float most = ours->command.torque_limit_n_mm;
        torque = torque > most ? most : torque < -most ? -most : torque;
    }
    ours->sample.motor_rad = middle_rad[joint] + moved;
    ours->sample.torque_n_mm = torque;
}

static inline void start_limb(bool is_guarded, const uint8_t *key)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = GAP_RAD;
    p.controller.modbus_address = UNIT;
    bench_start(&p);
    brace_fake_without_force(&fake);
    fake.joint[BRACE_COXA].absent = !has_coxa;
    brace_fake_with_peers(&fake);
    if (is_guarded) {
        brace_fake_guarded(&fake, key);
    }
    fake.play = held_link;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        fake.joint[i].command = (brace_hal_joint_command_t){0.0f, __builtin_inff()};
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    operator_lives = operator_begins = false;
    recorded_count = 0;
    ticks(50);
    drain();
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* --------------------------------------------------------------------------------------- the operator -- */

static inline uint32_t check_of(const uint8_t *key, uint32_t number, uint32_t kind, const uint8_t *bytes,
                                uint32_t count)
{
    siphash_t hash;
    siphash_start(&hash, key);
    siphash_word(&hash, challenge);
    siphash_word(&hash, (uint64_t)kind << 32 | number);
    return (uint32_t)siphash_end(&hash, bytes, count);
}

static inline void says(const uint8_t data[8])
{
    arrives(0x600u + NODE, data, 8);
}

static inline void operator_says(const uint8_t data[8])
{
    if (recorded_count < 600u) {
        memcpy(recorded[recorded_count++], data, 8);
    }
    says(data);
}

static inline void make_write(uint32_t entry, uint32_t value, uint32_t token, uint8_t data[8])
{
    brace_can_pack_write_entry_request(&(brace_can_write_entry_request_t){token, entry, value}, data);
}

static inline bool is_guarded(void)
{
    return brace_app_setting(&app) != BRACE_SETTING_BENCH;
}

/* A sign of life with a number of the controller.
 *   key: null on a bench */
static inline void make_sign(const uint8_t *key, uint32_t number, uint32_t token, uint8_t data[8])
{
    const uint32_t check = key == NULL ? number : check_of(key, number, 1, NULL, 0);
    brace_can_pack_sign_of_life_request(&(brace_can_sign_of_life_request_t){token, number & 0xffffu, check}, data);
}

/* What everybody hears in answers: the number of now. */
static inline uint32_t number_now(void)
{
    brace_session_report_t reported;
    brace_app_session(&app, &reported);
    return reported.number;
}

static inline void sign_of_life(void)
{
    uint8_t data[8];
    make_sign(is_guarded() ? the_key : NULL, operator_begins ? begin_heard : number_now(), OPERATOR_TOKEN, data);
    operator_begins = false;
    operator_says(data);
}

/* Ticks in which the operator, if it lives, gives its signs of life, and at once where a motion waits. */
static inline void pass(int count)
{
    static int since;
    for (int i = 0; i < count; i++) {
        if (operator_lives && (++since >= 40 || operator_begins)) {
            since = 0;
            sign_of_life();
        }
        ticks(1);
        if (fake.can_sent.count > 48u) {
            drain(); /* so that what is asked for next finds room */
        }
    }
}

static inline void open_session(void)
{
    challenge = read_entry(ENTRY(challenge_low));
    challenge |= (uint64_t)read_entry(ENTRY(challenge_high)) << 32;
    counter = 0;
    sign_of_life();
    ticks(2);
    drain();
    TEST_ASSERT_EQUAL(BRACE_OWNER_CAN, read_entry(ENTRY(owner)));
    drain();
}

/* Gives a command its token, and the seal that goes before it. */
static inline void seal(uint8_t data[8], uint8_t sealing[8])
{
    data[1] = (uint8_t)(is_guarded() ? ++counter : OPERATOR_TOKEN);
    make_write(COMMAND_ENTRY(seal_mac), check_of(the_key, counter, 2, data, 8), data[1], sealing);
}

static inline bool moves(const uint8_t data[8])
{
    const uint32_t entry = (uint32_t)data[2] | (uint32_t)data[3] << 8;
    return data[0] == BRACE_REQUEST_TAKE_UP || data[0] == BRACE_REQUEST_LET_GO ||
           data[0] == BRACE_REQUEST_LOADING_TEST_START ||
           (data[0] == BRACE_REQUEST_WRITE_ENTRY && entry == COMMAND_ENTRY(end_test));
}

/* The operator's command and its answer. */
static inline answer_t command(uint8_t data[8])
{
    uint8_t sealing[8];
    brace_can_frame_t frame;
    answer_t answer = {0};
    seal(data, sealing);
    if (is_guarded()) {
        operator_says(sealing);
    }
    operator_says(data);
    for (int i = 0; i < PATIENCE_TICKS && answer.count == 0; i++) {
        ticks(1);
        while (brace_fake_frame_take(&fake, &frame)) {
            const uint32_t entry = (uint32_t)frame.data[2] | (uint32_t)frame.data[3] << 8;
            const bool is_of_seal =
                frame.data[0] == (uint8_t)BRACE_WRITE_ENTRY_ANSWER_0 && entry == COMMAND_ENTRY(seal_mac);
            if (frame.id == 0x580u + NODE && answered_code(frame.data) == data[0] && frame.data[1] == data[1] &&
                !is_of_seal) {
                memcpy(answer.part[answer.count++], frame.data, 8);
            }
        }
    }
    operator_begins = answer.count > 0 && answer.part[0][0] != BRACE_ANSWER_REFUSED && moves(data);
    begin_heard = answer.count > 0 ? brace_get_u32(&answer.part[0][4]) : 0u;
    return answer;
}

static inline void accepted_command(uint8_t data[8])
{
    const answer_t answer = command(data);
    TEST_ASSERT_TRUE(answer.count > 0);
    TEST_ASSERT_TRUE_MESSAGE(!is_refusal(answer.part[0]), "the operator's own command is refused");
}

static inline void make_take_up(uint32_t joint, uint8_t data[8])
{
    brace_can_pack_take_up_request(&(brace_can_take_up_request_t){0, joint, 1}, data);
}

static inline void make_let_go(uint8_t data[8])
{
    memset(data, 0, 8);
    data[0] = BRACE_REQUEST_LET_GO;
}

static inline void make_set_mode(uint32_t mode, uint8_t data[8])
{
    brace_can_pack_set_mode_request(&(brace_can_set_mode_request_t){0, mode, 0xc0de}, data);
}

static inline void make_commit(uint32_t crc, uint8_t data[8])
{
    brace_can_pack_commit_request(&(brace_can_commit_request_t){0, crc}, data);
}

/* The operator takes up the femur's play; the motor is on its way when this returns. */
static inline void begin_to_move(void)
{
    uint8_t data[8];
    operator_lives = true;
    make_take_up(BRACE_FEMUR, data);
    accepted_command(data);
    pass(30);
    TEST_ASSERT_EQUAL(BRACE_TAKEUP_APPROACH, now()->play[BRACE_FEMUR].phase);
    drain();
}

/* The operator is in CONFIGURATION and has staged a longer femur. */
static inline void begin_to_configure(void)
{
    uint8_t data[8];
    operator_lives = true;
    make_set_mode(BRACE_MODE_CONFIGURATION, data);
    accepted_command(data);
    make_write(1, bits(190.0f), 0, data);
    accepted_command(data);
    drain();
}

static inline void stage(uint32_t number, uint32_t value)
{
    uint8_t data[8];
    make_write(number, value, 0, data);
    accepted_command(data);
}

/* -------------------------------------------------------------------------------------- what has come -- */

/* What an attack must leave as it was. */
typedef struct {
    float offset_rad[BRACE_LINK_COUNT];
    uint32_t crc, staged_crc, erases, refused;
    brace_mode_t mode;
    float gravity_rad;
} state_t;

static inline state_t state_now(void)
{
    state_t state;
    brace_session_report_t session;
    float lean_rad;
    brace_app_session(&app, &session);
    memset(&state, 0, sizeof state);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        state.offset_rad[i] = fake.joint[i].command.offset_rad;
    }
    state.crc = brace_parameters_crc(brace_app_parameters(&app));
    state.staged_crc = brace_parameters_crc(brace_app_parameters_staged(&app));
    state.erases = session.erases;
    state.refused = session.strangers + session.replays + session.commits_refused;
    state.mode = brace_app_mode(&app);
    brace_app_gravity(&app, &state.gravity_rad, &lean_rad);
    return state;
}

static inline bool is_own_refusal(int32_t status)
{
    return status <= BRACE_REFUSED_STRANGER && status >= BRACE_REFUSED_EARLY;
}

/* How many of the answers that have come refuse somebody as a stranger, a replay, ... */
static inline uint32_t refusals_reported(void)
{
    brace_can_frame_t frame;
    uint32_t reported = 0;
    while (brace_fake_frame_take(&fake, &frame)) {
        if (frame.id == 0x580u + NODE && is_refusal(frame.data)) {
            brace_can_refusal_t refusal;
            brace_can_unpack_refusal(frame.data, &refusal);
            reported += is_own_refusal(refusal.status);
        }
    }
    return reported;
}

#endif
