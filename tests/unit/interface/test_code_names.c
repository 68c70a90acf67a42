/* Names and sentences of numbers: each number that means something has its own, and no other number has one. */
#include <string.h>

#include "brace/code_names.h"
#include "unity.h"

typedef const char *(*told_t)(int32_t number);

static const struct {
    told_t name, text;
    const char *first; /* the name of number 0 */
} tables[] = {
    {brace_mode_name, brace_mode_text, "START"},
    {brace_play_name, brace_play_text, NULL},
    {brace_take_up_phase_name, brace_take_up_phase_text, NULL},
    {brace_take_up_outcome_name, brace_take_up_outcome_text, NULL},
    {brace_loading_outcome_name, brace_loading_outcome_text, NULL},
    {brace_drift_state_name, brace_drift_state_text, NULL},
    {brace_drift_cause_name, brace_drift_cause_text, NULL},
    {brace_drift_next_step_name, brace_drift_next_step_text, NULL},
    {brace_heartbeat_state_name, brace_heartbeat_state_text, NULL},
    {brace_parameter_origin_name, brace_parameter_origin_text, NULL},
    {brace_contact_name, brace_contact_text, NULL},
    {brace_fault_name, brace_fault_text, "SENSOR_FEMUR"},
    {brace_flag_name, brace_flag_text, NULL},
    {brace_drift_could_be_name, brace_drift_could_be_text, NULL},
    {brace_setting_name, brace_setting_text, NULL},
    {brace_owner_name, brace_owner_text, NULL},
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_has_name_and_text_or_neither);
    return UNITY_END();
}
