/* Names and sentences of numbers: each number that means something has its own, and no other number has one. */
#include <stdbool.h>
#include <string.h>

#include "brace/code_names.h"
#include "brace/codes.h"
#include "unity.h"

typedef const char *(*lookup_t)(int32_t number);

static const struct {
    lookup_t name, text;
    const char *first; /* the name of number 0 */
    int32_t least, most;
} tables[] = {
    {brace_mode_name, brace_mode_text, "START", 0, 5},
    {brace_play_name, brace_play_text, NULL, 0, 5},
    {brace_take_up_phase_name, brace_take_up_phase_text, NULL, 0, 4},
    {brace_take_up_outcome_name, brace_take_up_outcome_text, NULL, -7, 2},
    {brace_loading_outcome_name, brace_loading_outcome_text, NULL, -7, 3},
    {brace_drift_state_name, brace_drift_state_text, NULL, 0, 2},
    {brace_drift_cause_name, brace_drift_cause_text, NULL, 0, 4},
    {brace_drift_next_step_name, brace_drift_next_step_text, NULL, 0, 7},
    {brace_heartbeat_state_name, brace_heartbeat_state_text, NULL, 0, 127},
    {brace_parameter_origin_name, brace_parameter_origin_text, NULL, 0, 2},
    {brace_contact_name, brace_contact_text, NULL, 0, 2},
    {brace_fault_name, brace_fault_text, "SENSOR_FEMUR", 0, BRACE_FAULT_COUNT - 1},
    {brace_flag_name, brace_flag_text, NULL, 0, 9},
    {brace_drift_could_be_name, brace_drift_could_be_text, NULL, 0, 3},
    {brace_setting_name, brace_setting_text, NULL, 1, 3},
    {brace_owner_name, brace_owner_text, NULL, 0, 5},
};

enum { TABLES = sizeof tables / sizeof *tables, FROM = -40, TO = 140 };

void setUp(void) {}

void tearDown(void) {}

static void test_a_number_has_name_and_text_or_neither(void)
{
    for (int t = 0; t < TABLES; t++) {
        int known = 0;
        for (int32_t number = FROM; number < TO; number++) {
            const char *name = tables[t].name(number), *text = tables[t].text(number);
            TEST_ASSERT_EQUAL(strcmp(name, "?") == 0, strcmp(text, "?") == 0);
            if (strcmp(name, "?") != 0) {
                known++;
                TEST_ASSERT_TRUE(name[0] >= 'A' && name[0] <= 'Z');
                TEST_ASSERT_TRUE(strlen(text) > 10u && text[strlen(text) - 1u] == '.'); /* a sentence */
                for (int32_t other = FROM; other < number; other++) {
                    TEST_ASSERT_NOT_EQUAL(0, strcmp(name, tables[t].name(other)));
                    TEST_ASSERT_NOT_EQUAL(0, strcmp(text, tables[t].text(other)));
                }
            }
        }
        TEST_ASSERT_GREATER_THAN(1, known);
        if (tables[t].first != NULL) {
            TEST_ASSERT_EQUAL_STRING(tables[t].first, tables[t].name(0));
        }
    }
}

/* What a heartbeat says has the numbers that CANopen gives its states; all other numbers follow one another. */
static void test_which_numbers_have_a_name(void)
{
    for (int t = 0; t < TABLES; t++) {
        for (int32_t number = FROM; number < TO; number++) {
            const bool is_in = number >= tables[t].least && number <= tables[t].most;
            const bool has_gaps = tables[t].name == brace_heartbeat_state_name;
            const bool is_wanted = has_gaps ? number == 0 || number == 4 || number == 5 || number == 127 : is_in;
            TEST_ASSERT_EQUAL(is_wanted, strcmp(tables[t].name(number), "?") != 0);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_has_name_and_text_or_neither);
    RUN_TEST(test_which_numbers_have_a_name);
    return UNITY_END();
}
