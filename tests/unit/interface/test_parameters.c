#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "brace/parameters.h"
#include "noise.h"
#include "unity.h"

static brace_parameters_t parameters;
static uint8_t block[BRACE_BLOCK_BYTES];

void setUp(void)
{
    noise_state = 20261121u;
    brace_parameters_default(&parameters);
    parameters.limb.femur_mm = 180.25f;
    parameters.drive[BRACE_TIBIA].coulomb_n_mm = 12.5f;
    parameters.controller.node_id = 17;
    (void)brace_parameters_pack(&parameters, 7, block, sizeof block);
}

void tearDown(void) {}

static void put_word(uint32_t at, uint32_t word)
{
    for (int i = 0; i < 4; i++) {
        block[at + (uint32_t)i] = (uint8_t)(word >> (8 * i));
    }
}

/* The CRC bit by bit, as its standard says it: shares nothing with the table of the firmware. */
static uint32_t crc_of(const uint8_t *bytes, uint32_t count)
{
    uint32_t crc = 0xffffffffu;
    for (uint32_t i = 0; i < count; i++) {
        for (int bit = 0; bit < 8; bit++) {
            const uint32_t in = (crc ^ (uint32_t)(bytes[i] >> bit)) & 1u;
            crc = (crc >> 1) ^ (in != 0u ? 0xedb88320u : 0u);
        }
    }
    return crc ^ 0xffffffffu;
}

static void seal(void)
{
    put_word(BRACE_BLOCK_BYTES - 4, crc_of(block, BRACE_BLOCK_BYTES - 4));
}

static brace_status_t unpacked(uint32_t *wrong_index)
{
    brace_parameters_t out;
    return brace_parameters_unpack(block, sizeof block, &out, NULL, wrong_index);
}

static void test_crc_is_the_standard_one(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u, brace_crc32(0, (const uint8_t *)"123456789", 9));
    TEST_ASSERT_EQUAL_HEX32(0xcbf43926u,
                            brace_crc32(brace_crc32(0, (const uint8_t *)"1234", 4), (const uint8_t *)"56789", 5));
    TEST_ASSERT_EQUAL_HEX32(0, brace_crc32(0, NULL, 0));
}

static void test_defaults_are_a_limb_that_listens_only(void)
{
    brace_parameters_t safe;
    brace_parameters_default(&safe);
    brace_parameters_default(NULL);
    uint32_t wrong = BRACE_PARAMETER_COUNT;
    const brace_status_t status = brace_parameters_check(&safe, &wrong);
    TEST_ASSERT_EQUAL_MESSAGE(BRACE_OK, status, brace_parameter_key(wrong));
    TEST_ASSERT_EQUAL(0, safe.controller.node_id);
    TEST_ASSERT_EQUAL_FLOAT(185.0f, safe.limb.femur_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, safe.limb.joint[BRACE_FEMUR].gap_rad);
}

static void test_layout_is_as_documented(void)
{
    TEST_ASSERT_EQUAL_MEMORY("BRCE\x01\x00\x14\x00", block, 8);
    const uint32_t expected[] = {BRACE_SCHEMA_HASH, 4 * BRACE_PARAMETER_COUNT, 7};
    for (uint32_t i = 0; i < 3; i++) {
        const uint8_t *at = block + 8 + 4 * i;
        TEST_ASSERT_EQUAL_HEX32(expected[i],
                                at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24);
    }
    static const uint8_t femur_mm[4] = {0x00, 0x40, 0x34, 0x43}; /* 180.25f */
    TEST_ASSERT_EQUAL_MEMORY(femur_mm, block + 20 + 4 * BRACE_PARAMETER_GEOMETRY_FEMUR_MM, 4);
    static const uint8_t node[4] = {17, 0, 0, 0};
    TEST_ASSERT_EQUAL_MEMORY(node, block + 20 + 4 * BRACE_PARAMETER_CONTROLLER_NODE_ID, 4);
    put_word(BRACE_BLOCK_BYTES - 4, ~crc_of(block, BRACE_BLOCK_BYTES - 4));
    TEST_ASSERT_EQUAL(BRACE_E_CHECKSUM, unpacked(NULL));
    seal();
    TEST_ASSERT_EQUAL(BRACE_OK, unpacked(NULL));
}

static void test_what_is_packed_comes_back(void)
{
    for (uint32_t i = 0; i < 200; i++) {
        /* some member, some bits that it may have */
        for (uint32_t member = 0; member < BRACE_PARAMETER_COUNT; member++) {
            brace_parameters_t changed = parameters;
            noise_uniform();
            memcpy((uint8_t *)&changed + 4 * member, &noise_state, 4);
            if (brace_parameters_check(&changed, NULL) == BRACE_OK) {
                parameters = changed;
            }
        }
        brace_parameters_t back;
        uint32_t sequence = 0;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&parameters, noise_state, block, sizeof block));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_unpack(block, sizeof block, &back, &sequence, NULL));
        TEST_ASSERT_EQUAL_MEMORY(&parameters, &back, sizeof back);
        TEST_ASSERT_EQUAL_HEX32(noise_state, sequence);
        uint8_t again[BRACE_BLOCK_BYTES];
        TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&back, sequence, again, sizeof again));
        TEST_ASSERT_EQUAL_MEMORY(block, again, sizeof again);
    }
}

static void test_every_single_bit_counts(void)
{
    for (uint32_t bit = 0; bit < 8 * sizeof block; bit++) {
        block[bit / 8] ^= (uint8_t)(1u << bit % 8);
        brace_parameters_t out;
        memset(&out, 0x5a, sizeof out);
        const brace_parameters_t untouched = out;
        uint32_t sequence = 99, wrong = 98;
        TEST_ASSERT_LESS_THAN(BRACE_OK, brace_parameters_unpack(block, sizeof block, &out, &sequence, &wrong));
        TEST_ASSERT_EQUAL_MEMORY(&untouched, &out, sizeof out);
        TEST_ASSERT_EQUAL(99, sequence);
        TEST_ASSERT_EQUAL(98, wrong); /* damage never comes as far as a value */
        block[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    TEST_ASSERT_EQUAL(BRACE_OK, unpacked(NULL));
}

#ifdef __arm__
enum { RANDOM_BLOCKS = 10000 }; /* emulated: a tenth of them */
#else
enum { RANDOM_BLOCKS = 100000 };
#endif

/* A third of the blocks is pure noise, a third has the right header, a third has the right CRC as well. */
static void test_random_blocks_never_pass(void)
{
    uint8_t header[BRACE_BLOCK_HEADER_BYTES];
    memcpy(header, block, sizeof header);
    uint32_t seen[3] = {0, 0, 0};
    for (uint32_t i = 0; i < RANDOM_BLOCKS; i++) {
        const uint32_t way = i % 3;
        const uint32_t bytes = way == 2 && i % 50 != 2 ? 64 : sizeof block; /* sealing is slow on a controller */
        for (uint32_t at = 0; at < bytes; at += 4) {
            noise_uniform();
            put_word(at, noise_state);
        }
        if (way > 0) {
            memcpy(block, header, sizeof header);
        }
        if (way == 2 && i % 50 == 2) {
            seal();
        }
        uint32_t wrong = BRACE_PARAMETER_COUNT;
        const brace_status_t status = unpacked(&wrong);
        TEST_ASSERT_LESS_THAN(BRACE_OK, status);
        seen[0] += status == BRACE_E_MAGIC;
        seen[1] += status == BRACE_E_CHECKSUM;
        seen[2] += status == BRACE_E_PARAMETER || status == BRACE_E_NOT_FINITE;
    }
    TEST_ASSERT_GREATER_THAN(RANDOM_BLOCKS * 3 / 10, seen[0]);
    TEST_ASSERT_GREATER_THAN(RANDOM_BLOCKS * 3 / 10, seen[1]);
    TEST_ASSERT_GREATER_THAN(RANDOM_BLOCKS / 200, seen[2]);
}

static void test_refusals_each_have_their_status(void)
{
    brace_parameters_t out;
    brace_block_header_t header;
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_parameters_unpack(NULL, sizeof block, &out, NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_parameters_unpack(block, sizeof block, NULL, NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_block_header(block, sizeof block, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_parameters_check(NULL, NULL));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_parameters_pack(NULL, 1, block, sizeof block));
    TEST_ASSERT_EQUAL(BRACE_E_NULL, brace_parameters_pack(&parameters, 1, NULL, sizeof block));
    TEST_ASSERT_EQUAL(BRACE_E_LENGTH, brace_parameters_pack(&parameters, 1, block, sizeof block - 1));
    for (uint32_t length = 0; length < sizeof block; length++) {
        TEST_ASSERT_EQUAL(BRACE_E_LENGTH, brace_parameters_unpack(block, length, &out, NULL, NULL));
    }
    TEST_ASSERT_EQUAL(BRACE_E_LENGTH, brace_parameters_unpack(block, sizeof block + 1, &out, NULL, NULL));

    TEST_ASSERT_EQUAL(BRACE_E_RANGE, brace_parameters_check_piece(&parameters, BRACE_CHECK_PIECES, NULL));
    put_word(12, 4 * BRACE_PARAMETER_COUNT - 4); /* shorter, and of this very dictionary */
    put_word(BRACE_BLOCK_BYTES - 8, crc_of(block, BRACE_BLOCK_BYTES - 8));
    TEST_ASSERT_EQUAL(BRACE_E_LENGTH, brace_parameters_unpack(block, sizeof block - 4, &out, NULL, NULL));
    put_word(12, 4 * BRACE_PARAMETER_COUNT);

    put_word(8, ~BRACE_SCHEMA_HASH);
    seal();
    TEST_ASSERT_EQUAL(BRACE_E_SCHEMA, unpacked(NULL));
    for (uint32_t length = 0; length < BRACE_BLOCK_HEADER_BYTES; length++) { /* cut off in its header */
        TEST_ASSERT_EQUAL(BRACE_E_LENGTH, brace_block_header(block, length, &header));
    }
    TEST_ASSERT_EQUAL(BRACE_OK, brace_block_header(block, BRACE_BLOCK_HEADER_BYTES, &header));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_block_header(block, sizeof block, &header));
    TEST_ASSERT_EQUAL(BRACE_BLOCK_FORMAT, header.format);
    TEST_ASSERT_EQUAL_HEX32(~BRACE_SCHEMA_HASH, header.schema_hash); /* both can be shown */
    put_word(12, 4 * BRACE_PARAMETER_COUNT - 4); /* another dictionary has another length */
    put_word(BRACE_BLOCK_BYTES - 8, crc_of(block, BRACE_BLOCK_BYTES - 8));
    TEST_ASSERT_EQUAL(BRACE_E_SCHEMA, brace_parameters_unpack(block, sizeof block - 4, &out, NULL, NULL));
    put_word(12, 0xfffffffcu); /* no length that could wrap */
    TEST_ASSERT_EQUAL(BRACE_E_LENGTH, unpacked(NULL));
    block[4] = 2;
    TEST_ASSERT_EQUAL(BRACE_E_FORMAT, unpacked(NULL));
    block[0] = 'b';
    TEST_ASSERT_EQUAL(BRACE_E_MAGIC, unpacked(NULL));
}

static void test_the_wrong_member_is_named(void)
{
    const uint32_t nan = 0x7fc00000u, huge = 0x7e967699u; /* 1e38f; as a whole number too large for any */
    for (uint32_t member = 0; member < BRACE_PARAMETER_COUNT; member++) {
        const char *key = brace_parameter_key(member);
        const bool whole = (strncmp(key, "controller.", 11) == 0 && strstr(key, "_ratio") == NULL) ||
                           member == BRACE_PARAMETER_CHANGE_LINK;
        const bool unbounded = member == BRACE_PARAMETER_SENSOR_SATURATION_N || member == BRACE_PARAMETER_CHANGE_AT_S ||
                               member == BRACE_PARAMETER_CREEP_TIME_CONSTANT_S;
        for (int way = 0; way < 2; way++) {
            brace_parameters_t wrong = parameters;
            uint32_t index = 12345;
            memcpy((uint8_t *)&wrong + 4 * member, way == 0 ? &nan : &huge, 4);
            const brace_status_t status = brace_parameters_check(&wrong, &index);
            if (way == 1 && unbounded) {
                TEST_ASSERT_EQUAL(BRACE_OK, status);
                continue;
            }
            TEST_ASSERT_EQUAL_MESSAGE(way == 0 && !whole ? BRACE_E_NOT_FINITE : BRACE_E_PARAMETER, status, key);
            TEST_ASSERT_EQUAL(member, index);
            TEST_ASSERT_EQUAL(status, brace_parameters_pack(&wrong, 1, block, sizeof block));
        }
    }
}

static void expect_fault(uint32_t expected)
{
    uint32_t index = 12345;
    TEST_ASSERT_EQUAL(BRACE_E_PARAMETER, brace_parameters_check(&parameters, &index));
    TEST_ASSERT_EQUAL(expected, index);
    setUp();
}

static void test_what_members_say_together(void)
{
    parameters.drive[0].torque_noise_n_mm = nextafterf(parameters.drive[0].torque_range_n_mm, INFINITY);
    expect_fault(BRACE_PARAMETER_MOTOR_COXA_TORQUE_NOISE_N_MM);
    parameters.drive[1].torque_bias_n_mm = 9000.0f;
    expect_fault(BRACE_PARAMETER_MOTOR_FEMUR_TORQUE_BIAS_N_MM);
    parameters.drive[2].takeup_torque_n_mm = 9000.0f;
    expect_fault(BRACE_PARAMETER_MOTOR_TIBIA_TAKEUP_TORQUE_N_MM);
    parameters.drive[2].angle_max_rad = parameters.drive[2].angle_min_rad;
    expect_fault(BRACE_PARAMETER_MOTOR_TIBIA_ANGLE_MAX_RAD);
    parameters.controller.tick_us = 2000;
    parameters.controller.age_limit_us = 1999;
    expect_fault(BRACE_PARAMETER_CONTROLLER_AGE_LIMIT_US);
    parameters.controller.tick_us = 2000;
    parameters.controller.age_limit_us = 1999;
    parameters.drive[2].angle_max_rad = parameters.drive[2].angle_min_rad;
    parameters.drive[1].torque_bias_n_mm = 9000.0f;
    expect_fault(BRACE_PARAMETER_MOTOR_FEMUR_TORQUE_BIAS_N_MM); /* of several it is the first */
    parameters.controller.can_bit_rate = 0;
    expect_fault(BRACE_PARAMETER_CONTROLLER_CAN_BIT_RATE);
    parameters.controller.can_bit_rate = 500001;
    expect_fault(BRACE_PARAMETER_CONTROLLER_CAN_BIT_RATE);
    parameters.controller.modbus_baud = 125000;
    expect_fault(BRACE_PARAMETER_CONTROLLER_MODBUS_BAUD);
    memset(parameters.limb.link, 0, sizeof parameters.limb.link);
    memset(parameters.limb.joint, 0, sizeof parameters.limb.joint);
    expect_fault(BRACE_PARAMETER_COUNT); /* nothing yields: no single member is to blame */
}

/* A drive's noise, bias and take-up may be its whole torque range, and no more; a sample may be as old as a tick. */
static void test_bounds_between_members_may_be_reached(void)
{
    static const uint32_t within[][3] = {
        {BRACE_PARAMETER_MOTOR_COXA_TORQUE_NOISE_N_MM, BRACE_PARAMETER_MOTOR_COXA_TORQUE_BIAS_N_MM,
         BRACE_PARAMETER_MOTOR_COXA_TAKEUP_TORQUE_N_MM},
        {BRACE_PARAMETER_MOTOR_FEMUR_TORQUE_NOISE_N_MM, BRACE_PARAMETER_MOTOR_FEMUR_TORQUE_BIAS_N_MM,
         BRACE_PARAMETER_MOTOR_FEMUR_TAKEUP_TORQUE_N_MM},
        {BRACE_PARAMETER_MOTOR_TIBIA_TORQUE_NOISE_N_MM, BRACE_PARAMETER_MOTOR_TIBIA_TORQUE_BIAS_N_MM,
         BRACE_PARAMETER_MOTOR_TIBIA_TAKEUP_TORQUE_N_MM}};
    for (uint32_t i = 0; i < 9u; i++) {
        const uint32_t member = within[i / 3u][i % 3u];
        const float most = parameters.drive[i / 3u].torque_range_n_mm, beyond = nextafterf(most, INFINITY);
        memcpy((uint8_t *)&parameters + 4u * member, &most, 4);
        TEST_ASSERT_EQUAL_MESSAGE(BRACE_OK, brace_parameters_check(&parameters, NULL), brace_parameter_key(member));
        memcpy((uint8_t *)&parameters + 4u * member, &beyond, 4);
        expect_fault(member);
    }
    parameters.controller.tick_us = parameters.controller.age_limit_us = 2000;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_check(&parameters, NULL));
}

/* The dictionary's ranges and those of brace_limb_check are the same: the float next to a bound is refused by both. */
static void test_ranges_are_those_of_the_limb(void)
{
    for (uint32_t member = 0; member < sizeof(brace_limb_t) / 4; member++) {
        for (int side = -1; side <= 1; side += 2) {
            float inside = 0.0f, outside = 0.0f;
            memcpy(&inside, (const uint8_t *)&parameters + 4 * member, 4);
            outside = (float)side * 3e4f;
            for (int i = 0; i < 200; i++) { /* to the last float that is allowed */
                const float middle = i < 160 ? inside + (outside - inside) / 2.0f : nextafterf(inside, outside);
                uint32_t wrong = 0;
                brace_parameters_t tried = parameters;
                memcpy((uint8_t *)&tried + 4 * member, &middle, 4);
                const bool allowed =
                    brace_parameters_check(&tried, &wrong) == BRACE_OK || wrong == BRACE_PARAMETER_COUNT;
                *(allowed ? &inside : &outside) = middle;
                if (!(inside < outside || inside > outside)) {
                    break;
                }
            }
            brace_limb_t limb = parameters.limb;
            memcpy((uint8_t *)&limb + 4 * member, &inside, 4);
            TEST_ASSERT_EQUAL_MESSAGE(BRACE_OK, brace_limb_check(&limb), brace_parameter_key(member));
            const float beyond = nextafterf(inside, (float)side * INFINITY);
            memcpy((uint8_t *)&limb + 4 * member, &beyond, 4);
            TEST_ASSERT_EQUAL_MESSAGE(BRACE_E_PARAMETER, brace_limb_check(&limb), brace_parameter_key(member));
        }
    }
}

static void test_identity_is_of_values_alone(void)
{
    const uint32_t before = brace_parameters_crc(&parameters);
    brace_parameters_t back;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_pack(&parameters, 999, block, sizeof block));
    TEST_ASSERT_EQUAL(BRACE_OK, brace_parameters_unpack(block, sizeof block, &back, NULL, NULL));
    TEST_ASSERT_EQUAL_HEX32(before, brace_parameters_crc(&back));
    back.sensor.gain = nextafterf(back.sensor.gain, 2.0f);
    TEST_ASSERT_NOT_EQUAL(before, brace_parameters_crc(&back));
    TEST_ASSERT_EQUAL(0, brace_parameters_crc(NULL));
}

static void test_members_have_their_names(void)
{
    TEST_ASSERT_EQUAL_STRING("joint.tibia.coulomb_n_mm", brace_parameter_key(BRACE_PARAMETER_JOINT_TIBIA_COULOMB_N_MM));
    TEST_ASSERT_EQUAL_STRING("N mm", brace_parameter_unit(BRACE_PARAMETER_JOINT_TIBIA_COULOMB_N_MM));
    TEST_ASSERT_EQUAL_STRING("controller.modbus_baud", brace_parameter_key(BRACE_PARAMETER_COUNT - 1));
    TEST_ASSERT_EQUAL_STRING("the limb as a whole", brace_parameter_key(BRACE_PARAMETER_COUNT));
}

/* Numbers on the wire stay when members are added between others: these are version 0.1's. */
static void test_numbers_on_the_wire_are_frozen(void)
{
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_GEOMETRY_COXA_MM, brace_parameter_index(0));
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_JOINT_FEMUR_GAP_RAD, brace_parameter_index(25));
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_CONTROLLER_MODBUS_BAUD, brace_parameter_index(107));
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_COUNT, brace_parameter_index(BRACE_PARAMETER_NUMBERS));
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_COUNT, brace_parameter_index(UINT32_MAX));
    for (uint32_t index = 0; index < BRACE_PARAMETER_COUNT; index++) {
        TEST_ASSERT_EQUAL(index, brace_parameter_index(brace_parameter_number(index)));
    }
    TEST_ASSERT_EQUAL(BRACE_PARAMETER_NUMBERS, brace_parameter_number(BRACE_PARAMETER_COUNT));
    TEST_ASSERT_EQUAL_STRING("", brace_parameter_unit(BRACE_PARAMETER_COUNT));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_crc_is_the_standard_one);
    RUN_TEST(test_defaults_are_a_limb_that_listens_only);
    RUN_TEST(test_layout_is_as_documented);
    RUN_TEST(test_what_is_packed_comes_back);
    RUN_TEST(test_every_single_bit_counts);
    RUN_TEST(test_random_blocks_never_pass);
    RUN_TEST(test_refusals_each_have_their_status);
    RUN_TEST(test_the_wrong_member_is_named);
    RUN_TEST(test_what_members_say_together);
    RUN_TEST(test_bounds_between_members_may_be_reached);
    RUN_TEST(test_ranges_are_those_of_the_limb);
    RUN_TEST(test_identity_is_of_values_alone);
    RUN_TEST(test_members_have_their_names);
    RUN_TEST(test_numbers_on_the_wire_are_frozen);
    return UNITY_END();
}
