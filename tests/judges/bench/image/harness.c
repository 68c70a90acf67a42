/* main of every bench image: runs the job at each index and prints its numbers as the hexadecimal of their bits,
 * then how deep below its caller the job's stack went. The plugin counts meanwhile. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "job.h"

enum { PAINTED_WORDS = 2048 };
static const uint32_t paint = 0xA5C3F00Du;

static inline uint32_t *stack_pointer(void)
{
    uint32_t *sp;
    __asm__ volatile("mov %0, sp" : "=r"(sp));
    return sp;
}

int main(void)
{
    job_setup();
    unsigned deepest_bytes = 0;
    for (int index = 0; index < job_runs; index++) {
        float out[JOB_OUT_MAX];
        volatile uint32_t *const top = stack_pointer();
        for (int i = 1; i <= PAINTED_WORDS; i++) {
            top[-i] = paint;
        }
        job_run(index, out);
        int untouched = PAINTED_WORDS;
        while (untouched > 0 && top[-untouched] == paint) {
            untouched--;
        }
        if ((unsigned)untouched * 4u > deepest_bytes) {
            deepest_bytes = (unsigned)untouched * 4u;
        }
        printf("run");
        for (int i = 0; i < job_out_count; i++) {
            uint32_t bits;
            memcpy(&bits, &out[i], sizeof bits);
            printf(" %08lx", (unsigned long)bits);
        }
        printf("\n");
    }
    printf("stack %u\n", deepest_bytes);
    return 0;
}
