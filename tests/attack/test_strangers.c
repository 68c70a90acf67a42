/* Somebody without the key on the buses of a guarded limb: commands, forged and replayed seals, floods. None succeeds,
 * each is refused, reported and counted, whatever the operator is doing meanwhile. */
#include "attack.h"

typedef enum { ALONE, WITH_SESSION, MOVING, CONFIGURING, SITUATIONS } situation_t;

static const char *const situation_name[SITUATIONS] = {"nobody has a session", "the operator has one",
                                                       "the operator moves the limb", "the operator configures"};
static uint32_t attacks;

void setUp(void) {}

void tearDown(void)
{
    operator_lives = false;
}

static void begin(situation_t situation)
{
    start_limb(true, the_key);
    if (situation != ALONE) {
        open_session();
        operator_lives = true;
    }
    if (situation == MOVING) {
        begin_to_move();
    } else if (situation == CONFIGURING) {
        begin_to_configure();
    }
    drain();
}

/* What the operator set is unchanged. The controller has refused the stranger, reported this and counted it. */
static void nothing_came_of_it(const state_t *before, situation_t situation, const char *attack, uint32_t reported)
{
    char where[160];
    const state_t after = state_now();
    (void)snprintf(where, sizeof where, "%s, while %s", attack, situation_name[situation]);
    const float way_rad = after.offset_rad[BRACE_FEMUR] - before->offset_rad[BRACE_FEMUR];
    TEST_ASSERT_TRUE_MESSAGE(situation == MOVING ? way_rad >= 0.0f : way_rad == 0.0f, where);
    TEST_ASSERT_EQUAL_FLOAT_MESSAGE(before->offset_rad[BRACE_TIBIA], after.offset_rad[BRACE_TIBIA], where);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(before->crc, after.crc, where);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(before->staged_crc, after.staged_crc, where);
    TEST_ASSERT_EQUAL_MESSAGE(before->erases, after.erases, where);
    TEST_ASSERT_EQUAL_MESSAGE(before->mode, after.mode, where);
    TEST_ASSERT_EQUAL_FLOAT_MESSAGE(before->gravity_rad, after.gravity_rad, where);
    TEST_ASSERT_TRUE_MESSAGE(after.refused > before->refused, where);
    TEST_ASSERT_TRUE_MESSAGE(reported > 0u, where);
    attacks++;
}

static uint32_t next_random(void)
{
    static uint32_t state = 1;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/* ------------------------------------------------------------------------------ commands over CAN -- */

enum { COMMANDS = 13 };
static const char *const command_name[COMMANDS] = {
    "take_up",     "let_go",       "loading_test_start", "set_mode CONFIGURATION",   "set_mode MONITOR",
    "write_entry", "upload_begin", "upload_word",        "commit of what is staged", "commit of a block",
    "rollback",    "clear",        "set_gravity"};

static void make_command(uint32_t which, uint8_t data[8])
{
    memset(data, 0, 8);
    switch (which) {
    case 0: make_take_up(BRACE_TIBIA, data); break;
    case 1: make_let_go(data); break;
    case 2:
        brace_can_pack_loading_test_start_request(&(brace_can_loading_test_start_request_t){0, 0, 2, 0.5f, 20}, data);
        break;
    case 3: make_set_mode(BRACE_MODE_CONFIGURATION, data); break;
    case 4: make_set_mode(BRACE_MODE_MONITOR, data); break;
    case 5: make_write(1, bits(250.0f), 0, data); break;
    case 6:
        brace_can_pack_upload_begin_request(&(brace_can_upload_begin_request_t){0, BRACE_BLOCK_BYTES, 1}, data);
        break;
    case 7: brace_can_pack_upload_word_request(&(brace_can_upload_word_request_t){0, 0, 1}, data); break;
    case 8: make_commit(0, data); break;
    case 9: make_commit(0x12345678u, data); break;
    case 10: data[0] = BRACE_REQUEST_ROLLBACK; break;
    case 11: brace_can_pack_clear_request(&(brace_can_clear_request_t){0, BRACE_FAULT_MODEL_DRIFT}, data); break;
    default: brace_can_pack_set_gravity_request(&(brace_can_set_gravity_request_t){0, 1.0f, 0.0f}, data); break;
    }
}

/* How a stranger dresses its command. */
typedef enum {
    BARE,          /* without a seal */
    WRONG_KEY,
    NO_CHECK,      /* zeros for a check */
    ALL_ONES,
    HALF_A_CHECK,  /* the right 16 bits, and zeros */
    ONE_BIT_OFF,
    LIFES_CHECK,   /* the right check of a sign of life */
    OTHERS_CHECK,  /* the right check of another command */
    OTHER_TOKEN,   /* the right check, and the command has another token */
    FAR_AHEAD,     /* a counter more than half its numbers ahead, with the right check */
    USED_BEFORE,   /* a counter that has been, with the right check */
    DRESSES
} dress_t;

static const char *const dress_name[DRESSES] = {
    "bare",          "another key",         "a check of zeros",       "a check of ones",
    "half a check",  "one bit off",         "a life sign's check",    "another command's check",
    "another token", "a counter far ahead", "a counter that has been"};

static void send_dressed(uint8_t data[8], dress_t dress)
{
    uint8_t sealing[8];
    const uint32_t ahead = dress == FAR_AHEAD ? 200u : dress == USED_BEFORE ? 0u : 1u;
    const uint32_t number = counter + ahead;
    data[1] = (uint8_t)number;
    uint32_t check = check_of(dress == WRONG_KEY ? another_key : the_key, number, dress == LIFES_CHECK ? 1 : 2, data,
                              dress == LIFES_CHECK ? 0 : 8);
    uint8_t other[8];
    memcpy(other, data, 8);
    other[2] ^= 1u;
    switch (dress) {
    case NO_CHECK: check = 0; break;
    case ALL_ONES: check = UINT32_MAX; break;
    case HALF_A_CHECK: check &= 0xffffu; break;
    case ONE_BIT_OFF: check ^= 0x400u; break;
    case OTHERS_CHECK: check = check_of(the_key, number, 2, other, 8); break;
    default: break;
    }
    make_write(COMMAND_ENTRY(seal_mac), check, number & 0xffu, sealing);
    if (dress == OTHER_TOKEN) {
        data[1]++;
    }
    if (dress != BARE) {
        says(sealing);
    }
    says(data);
}

static void test_no_command_of_a_stranger_is_taken(void)
{
    for (uint32_t situation = 0; situation < SITUATIONS; situation++) {
        begin((situation_t)situation);
        for (uint32_t which = 0; which < COMMANDS; which++) {
            for (uint32_t dress = 0; dress < DRESSES; dress++) {
                uint8_t data[8];
                char attack[80];
                (void)snprintf(attack, sizeof attack, "%s, %s", command_name[which], dress_name[dress]);
                make_command(which, data);
                const state_t before = state_now();
                send_dressed(data, (dress_t)dress);
                ticks(6);
                nothing_came_of_it(&before, (situation_t)situation, attack, refusals_reported());
                if (situation != ALONE) { /* the operator goes on: the attack has not shut it out */
                    sign_of_life();
                    ticks(2);
                    drain();
                }
            }
        }
        TEST_ASSERT_EQUAL(situation == ALONE ? BRACE_OWNER_NONE : BRACE_OWNER_CAN, read_entry(ENTRY(owner)));
    }
}

/* ---------------------------------------------------------------------------------- over Modbus -- */

static void modbus_refuses(situation_t situation, const char *attack, const uint8_t *pdu, uint32_t count, bool by_tcp)
{
    const state_t before = state_now();
    const reply_t reply = by_tcp ? tcp_asks(UNIT, pdu, count) : line_asks(UNIT, pdu, count);
    TEST_ASSERT_EQUAL_MESSAGE(2, reply.count, attack);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(pdu[0] | 0x80u, reply.byte[0], attack);
    nothing_came_of_it(&before, situation, attack, reply.byte[1] == 7u);
    if (situation != ALONE) {
        sign_of_life();
        ticks(2);
        drain();
    }
}

static uint32_t make_block(uint32_t start, uint32_t first, uint32_t second, uint32_t values, uint8_t pdu[14])
{
    const uint8_t head[6] = {16, (uint8_t)(start >> 8),  (uint8_t)start,
                             0,  (uint8_t)(2u * values), (uint8_t)(4u * values)};
    memcpy(pdu, head, sizeof head);
    for (uint32_t i = 0; i < 4u; i++) {
        pdu[6u + i] = (uint8_t)(first >> (24u - 8u * i));
        pdu[10u + i] = (uint8_t)(second >> (24u - 8u * i));
    }
    return 6u + 4u * values;
}

static void test_no_register_takes_a_stranger_s_write(void)
{
    const struct {
        const char *name;
        uint32_t start, value;
    } writes[] = {{"take_up by register", COMMAND_REGISTER(take_up), 0x101},
                  {"let_go by register", COMMAND_REGISTER(let_go), 1},
                  {"end_test by register", COMMAND_REGISTER(end_test), 1},
                  {"CONFIGURATION by register", COMMAND_REGISTER(set_mode), 0xc0de0002},
                  {"commit by register", COMMAND_REGISTER(commit), 0xc0de0001},
                  {"commit_crc by register", COMMAND_REGISTER(commit_crc), 0x12345678},
                  {"rollback by register", COMMAND_REGISTER(rollback), 0xc0de0001},
                  {"clear by register", COMMAND_REGISTER(clear_faults), BRACE_FAULT_MODEL_DRIFT},
                  {"a parameter by register", 2, 0x437a0000}};
    uint8_t pdu[14];
    for (uint32_t situation = 0; situation < SITUATIONS; situation++) {
        begin((situation_t)situation);
        for (uint32_t i = 0; i < sizeof writes / sizeof *writes; i++) {
            for (uint32_t by_tcp = 0; by_tcp < 2u; by_tcp++) {
                uint32_t count = make_block(writes[i].start, writes[i].value, 0, 1, pdu);
                modbus_refuses((situation_t)situation, writes[i].name, pdu, count, by_tcp == 1u);
                const uint8_t half[] = {6, (uint8_t)(writes[i].start >> 8), (uint8_t)writes[i].start, 0, 1};
                modbus_refuses((situation_t)situation, "half a value by function 06", half, sizeof half, by_tcp == 1u);
                /* with a seal that was made without the key, and one that is right for the number before */
                uint8_t sealing[14];
                const uint32_t number = counter + 1u;
                (void)make_block(COMMAND_REGISTER(seal_counter), number, check_of(another_key, number, 2, pdu, count),
                                 2, sealing);
                (void)(by_tcp == 1u ? tcp_asks(UNIT, sealing, 14) : line_asks(UNIT, sealing, 14));
                modbus_refuses((situation_t)situation, "a register under another key's seal", pdu, count, by_tcp == 1u);
            }
        }
        const uint32_t asked = make_block(COMMAND_REGISTER(asked_gravity_direction_rad), bits(1.0f), 0, 2, pdu);
        modbus_refuses((situation_t)situation, "where down is, by register", pdu, asked, true);
        const uint32_t life = make_block(COMMAND_REGISTER(life_heard), number_now(), 0x1234, 2, pdu);
        modbus_refuses((situation_t)situation, "a forged life sign by register", pdu, life, true);
    }
}

/* A sign of life by Modbus TCP, with the number that the register shows. */
static reply_t lives_by_tcp(void)
{
    uint8_t pdu[14];
    const uint32_t number = sign_now().heard;
    const uint32_t count =
        make_block(COMMAND_REGISTER(life_heard), number, check_of(the_key, number, 1, NULL, 0), 2, pdu);
    return tcp_asks(UNIT, pdu, count);
}

/* The owner's own way over Modbus TCP: its challenge, a sign of life in one block, then each command behind its
 * seal. */
static void test_the_owner_goes_by_modbus_too(void)
{
    uint8_t pdu[14], sealing[14];
    begin(ALONE);
    challenge = read_entry(ENTRY(challenge_low));
    challenge |= (uint64_t)read_entry(ENTRY(challenge_high)) << 32;
    drain();
    TEST_ASSERT_EQUAL(5, lives_by_tcp().count);
    TEST_ASSERT_EQUAL(BRACE_OWNER_MODBUS_TCP, read_entry(ENTRY(owner)));
    /* the femur's play, towards its positive flank */
    uint32_t count = make_block(COMMAND_REGISTER(take_up), 0x101, 0, 1, pdu);
    TEST_ASSERT_EQUAL_HEX8(0x90, tcp_asks(UNIT, pdu, count).byte[0]); /* not without its seal */
    const uint32_t check = check_of(the_key, 5, 2, pdu, count);
    const uint32_t sealed = make_block(COMMAND_REGISTER(seal_counter), 5, check, 2, sealing);
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, sealing, sealed).count);
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, pdu, count).count);
    TEST_ASSERT_EQUAL(5, lives_by_tcp().count);
    ticks(20);
    TEST_ASSERT_NOT_EQUAL(BRACE_TAKEUP_IDLE, now()->play[BRACE_FEMUR].phase);
    TEST_ASSERT_EQUAL_HEX8(0x90, tcp_asks(UNIT, pdu, count).byte[0]); /* a seal is used up */
    TEST_ASSERT_EQUAL(5, lives_by_tcp().count);
    /* a seal is over one request: there is none over half a value */
    const uint8_t half[] = {6, (uint8_t)(COMMAND_REGISTER(let_go) >> 8), (uint8_t)COMMAND_REGISTER(let_go), 0, 1};
    const uint32_t halves = make_block(COMMAND_REGISTER(seal_counter), 0x50000001u,
                                       check_of(the_key, 0x50000001u, 2, half, sizeof half), 2, sealing);
    TEST_ASSERT_EQUAL(5, tcp_asks(UNIT, sealing, halves).count);
    TEST_ASSERT_EQUAL_HEX8(0x86, tcp_asks(UNIT, half, sizeof half).byte[0]);
    drain();
}

/* A request to everybody on the line is answered by nobody, but counted. */
static void test_a_broadcast_moves_nothing(void)
{
    begin(WITH_SESSION);
    uint8_t pdu[14];
    const uint32_t count = make_block(COMMAND_REGISTER(take_up), 0x101, 0, 1, pdu);
    const state_t before = state_now();
    TEST_ASSERT_EQUAL(0, line_asks(0, pdu, count).count);
    nothing_came_of_it(&before, WITH_SESSION, "take_up to everybody on the line", 1);
}

/* -------------------------------------------------------------------------------------- replays -- */

static void replay_all(situation_t situation, const char *attack)
{
    const state_t before = state_now();
    uint32_t reported = 0;
    for (uint32_t i = 0; i < recorded_count; i++) {
        says(recorded[i]);
        ticks(3);
        reported += refusals_reported();
    }
    nothing_came_of_it(&before, situation, attack, reported);
}

/* The operator opens a session, uploads a whole block, commits it, and goes; somebody has recorded every frame. */
static void test_a_recorded_block_does_not_replay(void)
{
    static uint8_t block[BRACE_BLOCK_BYTES];
    uint8_t data[8];
    begin(WITH_SESSION);
    brace_parameters_t changed = *brace_app_parameters(&app);
    changed.limb.femur_mm = 200.0f;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&changed, 0, block, sizeof block));
    make_set_mode(BRACE_MODE_CONFIGURATION, data);
    accepted_command(data);
    for (int step = 0; step < PUSH_STEPS - 1; step++) {
        push_request(block, step, data);
        accepted_command(data);
    }
    uint8_t sealing[8];
    push_request(block, PUSH_STEPS - 1, data);
    seal(data, sealing);
    operator_says(sealing);
    operator_says(data);
    pass(300);
    TEST_ASSERT_EQUAL_FLOAT(200.0f, brace_app_parameters(&app)->limb.femur_mm);
    make_set_mode(BRACE_MODE_MONITOR, data);
    accepted_command(data);
    pass(20);
    drain();
    replay_all(WITH_SESSION, "every frame again, in the same session");
    operator_lives = false;
    ticks(SESSION_IDLE_US / TICK_US + 20);
    drain();
    TEST_ASSERT_EQUAL(BRACE_OWNER_NONE, read_entry(ENTRY(owner)));
    replay_all(ALONE, "every frame again, after the session");
    open_session();
    replay_all(WITH_SESSION, "every frame again, in the next session");
}

static void test_a_command_does_not_count_twice_or_under_a_stolen_seal(void)
{
    uint8_t data[8], sealing[8], stolen[8];
    begin(WITH_SESSION);
    make_take_up(BRACE_FEMUR, data);
    accepted_command(data);
    pass(2);
    state_t before = state_now();
    says(data);
    ticks(3);
    nothing_came_of_it(&before, MOVING, "the command alone, once more", refusals_reported());
    before = state_now();
    says(recorded[recorded_count - 2u]);
    says(data);
    ticks(4);
    nothing_came_of_it(&before, MOVING, "the command and its seal, once more", refusals_reported());
    /* The stranger's command between the operator's seal and its command is refused, and the seal waits for its own. */
    make_let_go(data);
    seal(data, sealing);
    make_command(3, stolen);
    stolen[1] = data[1];
    before = state_now();
    says(sealing);
    says(stolen);
    ticks(3);
    nothing_came_of_it(&before, MOVING, "a stranger's command under the operator's seal", refusals_reported());
    operator_says(data);
    ticks(3);
    TEST_ASSERT_TRUE(something_waits());
}

/* Is a command with this token among the answers that have come, and let in? */
static bool is_let_in(const uint8_t data[8])
{
    brace_can_frame_t frame;
    bool is_found = false;
    while (brace_fake_frame_take(&fake, &frame)) {
        is_found = is_found || (frame.id == 0x580u + NODE && !is_refusal(frame.data) &&
                                answered_code(frame.data) == data[0] && frame.data[1] == data[1]);
    }
    return is_found;
}

static void send_forged_seals(uint32_t count, uint32_t token)
{
    uint8_t data[8];
    for (uint32_t i = 0; i < count; i++) {
        make_write(COMMAND_ENTRY(seal_mac), next_random(), token, data);
        says(data);
    }
}

/* The operator's seal and command, with forged seals of the same token before and between them, and with the stranger's
 * own command. */
static bool is_heard_between(uint32_t before, uint32_t between)
{
    uint8_t data[8], sealing[8], stolen[8];
    brace_can_pack_set_gravity_request(&(brace_can_set_gravity_request_t){0, 1e-3f * (float)between, 0.0f}, data);
    seal(data, sealing);
    make_command(COMMANDS - 1, stolen);
    stolen[1] = data[1];
    send_forged_seals(before, data[1]);
    operator_says(sealing);
    send_forged_seals(between, data[1]);
    says(stolen);
    operator_says(data);
    bool is_found = false;
    for (int i = 0; i < PATIENCE_TICKS && !is_found; i++) {
        pass(1);
        is_found = is_let_in(data);
    }
    return is_found;
}

/* A stranger who knows the next token repeats it before and between the operator's frames, and sends a command of its
 * own under it. The operator is let in each time. Eight seals between the two push its own out: then it is let in when
 * it tries again. */
static void test_who_repeats_the_owner_s_token_does_not_shut_it_out(void)
{
    begin(WITH_SESSION);
    for (uint32_t i = 0; i < 300u; i++) {
        TEST_ASSERT_TRUE(is_heard_between(next_random() % 10u, i % (uint32_t)BRACE_SEALS_MOST));
        attacks++;
    }
    TEST_ASSERT_FALSE(is_heard_between(0, BRACE_SEALS_MOST));
    TEST_ASSERT_TRUE(is_heard_between(BRACE_SEALS_MOST, BRACE_SEALS_MOST - 1));
}

/* What comes between seal and command takes the seal away from nobody: a flood of it would. It gets nothing by it. */
static void test_what_comes_between_seal_and_command_changes_nothing(void)
{
    uint8_t data[8], sealing[8], asking[8];
    begin(WITH_SESSION);
    make_take_up(BRACE_FEMUR, data);
    seal(data, sealing);
    brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){data[1] ^ 1u, 0}, asking);
    const state_t before = state_now();
    says(sealing);
    says(asking);
    asking[0] = BRACE_REQUEST_LET_GO;
    says(asking);
    ticks(4);
    nothing_came_of_it(&before, WITH_SESSION, "a command between a seal and its own", refusals_reported());
    operator_says(data);
    ticks(4);
    TEST_ASSERT_TRUE(something_waits());
    operator_begins = true;
    begin_heard = sign_now().heard;
    sign_of_life();
    ticks(4);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
}

/* --------------------------------------------------------------------------------- signs of life -- */

static void test_a_dead_operator_is_not_kept_alive(void)
{
    enum { FORGED, REPLAYED, FLOODED, WAYS };
    for (int way = 0; way < WAYS; way++) {
        begin(MOVING);
        operator_lives = false;
        const float before_rad = fake.joint[BRACE_FEMUR].command.offset_rad;
        uint8_t data[8];
        const uint32_t last = number_now();
        sign_of_life(); /* so that this number has counted */
        for (uint32_t i = 0; i < 150u; i++) {
            if (way == FLOODED || i % 20u == 0u) {
                make_sign(way == REPLAYED ? the_key : another_key, way == REPLAYED ? last : number_now(),
                          OPERATOR_TOKEN, data);
                says(data);
            }
            ticks(1);
            drain();
        }
        const float stood_rad = fake.joint[BRACE_FEMUR].command.offset_rad;
        TEST_ASSERT_TRUE(stood_rad - before_rad < 0.1f * 0.15f);
        ticks(1000);
        TEST_ASSERT_EQUAL_FLOAT(stood_rad, fake.joint[BRACE_FEMUR].command.offset_rad); /* it stands, and is held */
        drain();
        TEST_ASSERT_EQUAL(BRACE_OWNER_NONE, read_entry(ENTRY(owner)));
        TEST_ASSERT_EQUAL(1, read_entry(ENTRY(is_held)));
        TEST_ASSERT_EQUAL(1, read_entry(ENTRY(silences)));
        attacks++;
    }
}

/* After a time-out the session cannot be taken over by going on with its counters, nor without the key. */
static void test_a_session_is_not_taken_over_after_its_time(void)
{
    uint8_t data[8];
    begin(MOVING);
    operator_lives = false;
    ticks(200);
    drain();
    const state_t before = state_now();
    make_let_go(data); /* with the key even, but of the session that is over */
    send_dressed(data, LIFES_CHECK + 1);
    make_let_go(data);
    uint8_t sealing[8];
    seal(data, sealing);
    says(sealing);
    says(data);
    make_sign(the_key, number_now(), OPERATOR_TOKEN, data);
    says(data);
    ticks(10);
    nothing_came_of_it(&before, WITH_SESSION, "the session that is over goes on", refusals_reported());
    /* Who has the key opens another one, and lets go. */
    open_session();
    operator_lives = true;
    make_let_go(data);
    accepted_command(data);
    pass(500);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* Two who have the key: one at a time. */
static void test_two_masters_with_the_key_take_turns(void)
{
    uint8_t data[8];
    begin(MOVING);
    const state_t before = state_now();
    const reply_t reply = lives_by_tcp(); /* opens, if there were no owner */
    TEST_ASSERT_EQUAL(2, reply.count);
    drain();
    make_let_go(data);
    says(data);
    ticks(3);
    nothing_came_of_it(&before, MOVING, "a second session", refusals_reported());
    const uint32_t number = counter + 1u;
    uint8_t pdu[14], sealing[14];
    const uint32_t count = make_block(COMMAND_REGISTER(let_go), 1, 0, 1, pdu);
    (void)make_block(COMMAND_REGISTER(seal_counter), number, check_of(the_key, number, 2, pdu, count), 2, sealing);
    (void)tcp_asks(UNIT, sealing, 14); /* the operator's session, by another port, with the key */
    sign_of_life();
    modbus_refuses(MOVING, "the operator's session by another port", pdu, count, true);
}

/* ---------------------------------------------------------------------------------------- floods -- */

/* Random requests and checks, as fast as the node takes them. */
static void test_a_flood_of_guesses_moves_nothing(void)
{
    begin(ALONE);
    const state_t before = state_now();
    uint32_t reported = 0;
    for (uint32_t i = 0; i < 30000u; i++) {
        uint8_t data[8];
        const uint32_t low = next_random(), high = next_random();
        memcpy(data, &low, 4);
        memcpy(data + 4, &high, 4);
        data[0] &= 31u;
        if (i % 3u == 0u) {
            make_write(COMMAND_ENTRY(seal_mac) - (i % 2u) * 2u, high, low & 0xffu, data);
        }
        if (data[0] == BRACE_REQUEST_LOADING_TEST_STOP ||
            (data[0] == BRACE_REQUEST_WRITE_ENTRY && data[3] == 0x20u && data[2] == 0x22u)) {
            continue; /* stop is anybody's */
        }
        says(data);
        do {
            ticks(1);
            reported += refusals_reported();
        } while (fake.can_received.count > 40u);
    }
    nothing_came_of_it(&before, ALONE, "guesses", reported);
}

/* Beside the flood the operator's stop is heard, and what it holds is held. */
static void test_stop_is_heard_in_a_flood(void)
{
    begin(MOVING);
    uint8_t data[8];
    const uint8_t stop[8] = {BRACE_REQUEST_LOADING_TEST_STOP, 0x77};
    make_command(0, data);
    for (uint32_t i = 0; i < 20u; i++) {
        says(data);
        ticks(1);
        drain();
    }
    says(stop); /* a stranger's, even */
    ticks(3);
    const float stood_rad = fake.joint[BRACE_FEMUR].command.offset_rad;
    pass(500);
    TEST_ASSERT_EQUAL_FLOAT(stood_rad, fake.joint[BRACE_FEMUR].command.offset_rad);
    TEST_ASSERT_EQUAL(BRACE_MODE_TAKING_UP, now()->mode);
    drain();
    make_let_go(data); /* only its owner lets go */
    const state_t before = state_now();
    says(data);
    ticks(5);
    nothing_came_of_it(&before, WITH_SESSION, "let_go of a limb that was stopped", refusals_reported());
    make_let_go(data);
    accepted_command(data);
    pass(500);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

/* ------------------------------------------------------------------------------ configuration, key -- */

/* A stranger neither holds CONFIGURATION nor ends it. */
static void test_configuration_is_its_owner_s(void)
{
    uint8_t data[8];
    begin(CONFIGURING);
    operator_lives = false;
    for (uint32_t i = 0; i < 11u; i++) {
        make_set_mode(BRACE_MODE_CONFIGURATION, data);
        says(data);
        make_write(1, bits(250.0f), 0, data);
        says(data);
        ticks(1000);
        drain();
    }
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode); /* it has ended by itself, as if nobody had asked */
    TEST_ASSERT_EQUAL_FLOAT(185.0f, brace_app_parameters(&app)->limb.femur_mm);
    attacks++;
}

/* A commit that does not name its set could take in what somebody else has staged: even its owner's is refused. */
static void test_a_guarded_board_stores_no_set_that_is_not_named(void)
{
    uint8_t data[8];
    begin(CONFIGURING);
    make_commit(0, data);
    const answer_t answer = command(data);
    TEST_ASSERT_EQUAL(BRACE_E_CHECKSUM, refusal_of(&answer, BRACE_REQUEST_COMMIT).status);
    pass(400);
    TEST_ASSERT_EQUAL_FLOAT(185.0f, brace_app_parameters(&app)->limb.femur_mm);
    brace_parameters_t meant = *brace_app_parameters(&app);
    meant.limb.femur_mm = 190.0f;
    make_commit(brace_parameters_crc(&meant), data);
    (void)command(data);
    pass(400);
    TEST_ASSERT_EQUAL_FLOAT(190.0f, brace_app_parameters(&app)->limb.femur_mm);
}

/* No request reads a byte of the key: every entry, every register. */
static void test_the_key_is_never_sent(void)
{
    begin(ALONE);
    for (uint32_t index = 0; index < 0x2040u; index++) {
        uint8_t data[8];
        brace_can_pack_read_entry_request(&(brace_can_read_entry_request_t){9, index}, data);
        const answer_t answer = ask(data);
        for (uint32_t i = 0; i + 4u <= 16u && answer.count > 0; i++) {
            TEST_ASSERT_TRUE(is_refusal(answer.part[0]) || memcmp(answer.part[0] + 4, the_key + i, 4) != 0);
        }
        drain();
    }
    for (uint32_t start = 0; start + 2u < 0x4060u; start += start == 252u ? 0x1000u - 252u : 2u) {
        for (uint32_t function = 3; function <= 4u; function++) {
            const reply_t reply = read_asks(function, start, 2);
            TEST_ASSERT_TRUE(reply.count != 6u || memcmp(reply.byte + 2, the_key, 4) != 0);
        }
        start = start >= 0x1060u && start < 0x4000u ? 0x3ffeu : start;
    }
    attacks++;
}

static void test_without_a_key_nobody_moves_it(void)
{
    uint8_t data[8];
    start_limb(true, NULL);
    for (uint32_t which = 0; which < COMMANDS; which++) {
        make_command(which, data);
        const state_t before = state_now();
        says(data);
        ticks(4);
        nothing_came_of_it(&before, ALONE, command_name[which], refusals_reported());
    }
    TEST_ASSERT_EQUAL(BRACE_SETTING_NO_KEY, read_entry(ENTRY(setting)));
}

static void test_reading_stays_open(void)
{
    begin(MOVING);
    uint8_t data[8];
    brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){9, 1.0f, 1.4f}, data);
    const answer_t answer = ask(data);
    TEST_ASSERT_EQUAL(4, answer.count);
    TEST_ASSERT_EQUAL(252, read_asks(4, 0, 125).count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_command_of_a_stranger_is_taken);
    RUN_TEST(test_no_register_takes_a_stranger_s_write);
    RUN_TEST(test_the_owner_goes_by_modbus_too);
    RUN_TEST(test_a_broadcast_moves_nothing);
    RUN_TEST(test_a_recorded_block_does_not_replay);
    RUN_TEST(test_a_command_does_not_count_twice_or_under_a_stolen_seal);
    RUN_TEST(test_who_repeats_the_owner_s_token_does_not_shut_it_out);
    RUN_TEST(test_what_comes_between_seal_and_command_changes_nothing);
    RUN_TEST(test_a_dead_operator_is_not_kept_alive);
    RUN_TEST(test_a_session_is_not_taken_over_after_its_time);
    RUN_TEST(test_two_masters_with_the_key_take_turns);
    RUN_TEST(test_a_flood_of_guesses_moves_nothing);
    RUN_TEST(test_stop_is_heard_in_a_flood);
    RUN_TEST(test_configuration_is_its_owner_s);
    RUN_TEST(test_a_guarded_board_stores_no_set_that_is_not_named);
    RUN_TEST(test_the_key_is_never_sent);
    RUN_TEST(test_without_a_key_nobody_moves_it);
    RUN_TEST(test_reading_stays_open);
    (void)printf("%u attacks, none succeeded\n", (unsigned)attacks);
    return UNITY_END();
}
