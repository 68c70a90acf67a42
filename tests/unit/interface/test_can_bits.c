/* Numbers in a frame's bits (can_bits.h). A number is rounded to the nearest step. A number beyond the range becomes
 * the end of the range on its own side. 'Not known' has a code of its own. */
#include <math.h>

#include "can_bits.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static uint32_t limited;

static uint64_t signed_code(float value)
{
    limited = 0;
    return brace_bits_signed(value, 10.0f, 0, 16, &limited);
}

static uint64_t unsigned_code(float value)
{
    limited = 0;
    return brace_bits_unsigned(value, 10.0f, 0, 16, &limited);
}

static void test_a_number_with_a_sign(void)
{
    static const struct {
        float value;
        uint32_t code, limited;
    } row[] = {{0.0f, 0, 0},          {1.04f, 10, 0},        {-1.04f, 0xfff6, 0},   {1.06f, 11, 0},
               {3276.7f, 0x7fff, 0},  {-3276.7f, 0x8001, 0}, {3277.0f, 0x7fff, 1},  {-3277.0f, 0x8001, 1},
               {1e30f, 0x7fff, 1},    {-1e30f, 0x8001, 1},   {INFINITY, 0x7fff, 1}, {-INFINITY, 0x8001, 1},
               {3276.75f, 0x7fff, 0}, {NAN, 0x8000, 0}};
    for (uint32_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_HEX32(row[i].code, signed_code(row[i].value));
        TEST_ASSERT_EQUAL_UINT32(row[i].limited, limited);
    }
}

static void test_a_number_without_a_sign(void)
{
    static const struct {
        float value;
        uint32_t code, limited;
    } row[] = {{0.0f, 0, 0},  {1.04f, 10, 0},     {6553.4f, 0xfffe, 0}, {6553.8f, 0xfffe, 1},
               {-1.0f, 0, 1}, {1e30f, 0xfffe, 1}, {-1e30f, 0, 1},       {NAN, 0xffff, 0}};
    for (uint32_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        TEST_ASSERT_EQUAL_HEX32(row[i].code, unsigned_code(row[i].value));
        TEST_ASSERT_EQUAL_UINT32(row[i].limited, limited);
    }
}

/* Whole numbers have all codes of their bits: what is beyond becomes the end on its own side. */
static void test_whole_numbers(void)
{
    static const struct {
        int32_t value;
        uint32_t code, limited;
    } row[] = {{0, 0, 0},     {127, 0x7f, 0},  {128, 0x7f, 1},  {INT32_MAX, 0x7f, 1},
               {-1, 0xff, 0}, {-128, 0x80, 0}, {-129, 0x80, 1}, {INT32_MIN, 0x80, 1}},
      natural[] = {{0, 0, 0}, {255, 0xff, 0}, {256, 0xff, 1}, {INT32_MAX, 0xff, 1}};
    for (uint32_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        limited = 0;
        TEST_ASSERT_TRUE(brace_bits_whole(row[i].value, 24, 8, &limited) == (uint64_t)row[i].code << 24);
        TEST_ASSERT_EQUAL_UINT32(row[i].limited, limited);
    }
    for (uint32_t i = 0; i < sizeof natural / sizeof natural[0]; i++) {
        limited = 0;
        TEST_ASSERT_TRUE(brace_bits_number((uint32_t)natural[i].value, 40, 8, &limited) == (uint64_t)natural[i].code
                                                                                               << 40);
        TEST_ASSERT_EQUAL_UINT32(natural[i].limited, limited);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_with_a_sign);
    RUN_TEST(test_a_number_without_a_sign);
    RUN_TEST(test_whole_numbers);
    return UNITY_END();
}
