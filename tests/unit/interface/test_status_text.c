#include <string.h>

#include "brace/status_text.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static void test_every_status_has_a_text_of_its_own(void)
{
    const char *unknown = brace_status_text((brace_status_t)-99);
    TEST_ASSERT_EQUAL_STRING(unknown, brace_status_text((brace_status_t)1));
    for (int status = BRACE_E_MODE; status <= BRACE_OK; status++) {
        if (status == -9) { /* the host library's */
            continue;
        }
        const char *text = brace_status_text((brace_status_t)status);
        for (int other = BRACE_E_MODE; other < status; other++) {
            TEST_ASSERT_NOT_EQUAL(0, strcmp(text, brace_status_text((brace_status_t)other)));
        }
        TEST_ASSERT_NOT_EQUAL(0, strcmp(text, unknown));
        TEST_ASSERT_NOT_EQUAL(0, strlen(text));
    }
}

static void test_the_first_and_the_last(void)
{
    TEST_ASSERT_EQUAL_STRING("done", brace_status_text(BRACE_OK));
    TEST_ASSERT_EQUAL_STRING("not in the mode that the controller is in", brace_status_text(BRACE_E_MODE));
    TEST_ASSERT_EQUAL_STRING("not a status of this library", brace_status_text((brace_status_t)-9));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_status_has_a_text_of_its_own);
    RUN_TEST(test_the_first_and_the_last);
    return UNITY_END();
}
