/* A bit of the controller's RAM flips by itself: in its parameters, or in the constants made from them. Within 100 ms
 * MEMORY is set and K invalid, and then the store's set is in force again; or the flip changes K by less than 0.1 %. */
#include <stddef.h>

#include "app_bench.h"

enum { WITHIN_TICKS = 100, MENDED_WITHIN_TICKS = 400 };

static brace_parameters_t parameters;

void setUp(void)
{
    parameters = bench_parameters();
    bench_start(&parameters);
    ticks(20);
}

void tearDown(void) {}

/* Has it been seen in time? */
static bool is_seen(void)
{
    for (int i = 0; i < WITHIN_TICKS; i++) {
        ticks(1);
        if ((now()->faults & (uint32_t)BRACE_FAULT_MEMORY) != 0u) {
            TEST_ASSERT_FALSE(now()->k_is_valid);
            return true;
        }
    }
    return false;
}

static bool is_near(float a, float b)
{
    return fabsf(a - b) <= 1e-3f * fabsf(b) + 1e-6f;
}

/* Flips bits of a part of the memory, one after another. */
static void flip_all_in(void *start, size_t bytes)
{
    uint8_t *part = start;
    const brace_stiffness_t k = now()->stiffness.now;
    const size_t apart = ON_BOARD ? 111u : 5u; /* odd: each bit of a word has its turn */
    for (size_t i = 0; i < bytes * 8u; i += apart) {
        part[i / 8u] ^= (uint8_t)(1u << i % 8u);
        const bool seen = is_seen();
        if (seen) {
            for (int tick = 0; tick < MENDED_WITHIN_TICKS && !now()->k_is_valid; tick++) {
                ticks(1);
            }
        } else {
            part[i / 8u] ^= (uint8_t)(1u << i % 8u);
            ticks(1);
        }
        TEST_ASSERT_TRUE_MESSAGE(now()->k_is_valid, "not mended");
        TEST_ASSERT_EQUAL_MEMORY(&parameters, &app.controller.parameters.in_force, sizeof parameters);
        TEST_ASSERT_TRUE_MESSAGE(is_near(now()->stiffness.now.k_xx_n_per_mm, k.k_xx_n_per_mm) &&
                                     is_near(now()->stiffness.now.k_zz_n_per_mm, k.k_zz_n_per_mm),
                                 "mended, but to another K");
        TEST_ASSERT_TRUE_MESSAGE(seen, "a flip was not seen");
    }
}

static void test_every_bit_of_the_parameters(void)
{
    flip_all_in(&app.controller.parameters.in_force, sizeof app.controller.parameters.in_force);
}

static void test_every_bit_of_the_constants_of_K(void)
{
    flip_all_in(&app.controller.model.planar, sizeof app.controller.model.planar);
    flip_all_in(&app.controller.model.loaded, sizeof app.controller.model.loaded);
}

static void test_every_bit_of_the_constants_in_space(void)
{
    bench_board();
    bench_store(&parameters);
    fake.joint[BRACE_COXA].absent = false;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(20);
    TEST_ASSERT_TRUE(now()->space.is_valid);
    /* the springs are the tick's */
    flip_all_in(&app.controller.model.spatial, offsetof(brace_spatial_t, yaw_rad_per_n_mm));
    flip_all_in(&app.controller.model.loaded_space, sizeof app.controller.model.loaded_space);
}

static void test_every_bit_of_what_backlash_goes_by(void)
{
    parameters.limb.joint[BRACE_TIBIA].gap_rad = 0.01f;
    bench_start(&parameters);
    ticks(20);
    flip_all_in(&app.controller.flank.joint[BRACE_TIBIA].machine.params,
                sizeof app.controller.flank.joint[BRACE_TIBIA].machine.params);
}

static void test_every_bit_of_where_down_is(void)
{
    flip_all_in(&app.controller.gravity.down, sizeof app.controller.gravity.down);
}

/* The store has none: the safe defaults are in force, and come back. */
static void test_defaults_are_mended_too(void)
{
    bench_board();
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    ticks(20);
    brace_parameters_t defaults;
    brace_parameters_default(&defaults);
    app.controller.parameters.in_force.limb.femur_mm += 8.0f;
    TEST_ASSERT_TRUE(is_seen());
    ticks(20); /* no memory has to be read: a tick for each of the parts that are made anew */
    TEST_ASSERT_FALSE(app.controller.memory_is_wrong);
    ticks(MENDED_WITHIN_TICKS);
    TEST_ASSERT_EQUAL_MEMORY(&defaults, &app.controller.parameters.in_force, sizeof defaults);
    TEST_ASSERT_BITS_LOW(BRACE_FAULT_MEMORY, now()->faults);
    app.controller.parameters.crc ^= 4u; /* the CRC that the snapshot carries for the set */
    app.controller.parameters.origin = BRACE_PARAMETERS_SLOT_A;
    TEST_ASSERT_TRUE(is_seen());
    ticks(MENDED_WITHIN_TICKS);
    TEST_ASSERT_EQUAL_HEX32(brace_parameters_crc(&defaults), now()->parameter_crc);
    TEST_ASSERT_EQUAL(BRACE_PARAMETERS_DEFAULT, now()->parameter_origin);
    TEST_ASSERT_BITS_LOW(BRACE_FAULT_MEMORY, now()->faults);
}

/* The memory does not answer: the fault stays, and K is never reported. */
static void test_what_cannot_be_mended_stays_a_fault(void)
{
    brace_fake_fail_next(&fake, BRACE_FAKE_NVM_READ, 100000, BRACE_HAL_E_DEVICE);
    app.controller.parameters.in_force.limb.femur_mm += 8.0f;
    TEST_ASSERT_TRUE(is_seen());
    for (int i = 0; i < 1000; i++) {
        ticks(1);
        TEST_ASSERT_BITS_HIGH(BRACE_FAULT_MEMORY, now()->faults);
        TEST_ASSERT_FALSE(now()->k_is_valid);
    }
    fake.failure_count = 0;
    ticks(MENDED_WITHIN_TICKS);
    TEST_ASSERT_EQUAL(0, now()->faults);
    TEST_ASSERT_TRUE(now()->k_is_valid);
}

static void test_nothing_that_is_meant_is_taken_for_a_flip(void)
{
    for (int i = 0; i < 500; i++) {
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_set_gravity(&app, -1.5f + 0.001f * (float)i, 0.0f));
        fake.joint[BRACE_FEMUR].sample.torque_n_mm = 100.0f * sinf(0.1f * (float)i);
        fake.joint[BRACE_TIBIA].sample.temp_degc = 20.0f + 0.1f * (float)i;
        ticks(1);
        TEST_ASSERT_EQUAL(0, now()->faults);
    }
    ticks(200);
    TEST_ASSERT_EQUAL(0, now()->faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_bit_of_the_parameters);
    RUN_TEST(test_every_bit_of_the_constants_of_K);
    RUN_TEST(test_every_bit_of_the_constants_in_space);
    RUN_TEST(test_every_bit_of_what_backlash_goes_by);
    RUN_TEST(test_every_bit_of_where_down_is);
    RUN_TEST(test_defaults_are_mended_too);
    RUN_TEST(test_what_cannot_be_mended_stays_a_fault);
    RUN_TEST(test_nothing_that_is_meant_is_taken_for_a_flip);
    return UNITY_END();
}
