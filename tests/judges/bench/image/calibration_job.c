/* A function whose instructions can be counted by hand, to check the counter and the stack's paint before they are
 * believed: see run.py. */
#include "job.h"

enum { LOOPS = 3 };

const int job_runs = LOOPS;
const int job_out_count = 1;

/* 1 push, 1 mov, 1 sub of the stack, 1 store, per loop 4 (cmp, it, the skipped or done add, subs) and a branch, then
 * 1 add of the stack, 1 call, 1 pop. The callee: 1 nop, 1 return. For n loops: 4 + 5 n + 3 + 2. Stack: 8 + 24. */
__asm__(".syntax unified\n.thumb\n"
        ".section .text.calibration_leaf, \"ax\"\n.type calibration_leaf, %function\n.thumb_func\n"
        "calibration_leaf:\n nop\n bx lr\n"
        ".section .text.calibration, \"ax\"\n.global calibration\n.type calibration, %function\n.thumb_func\n"
        "calibration:\n"
        " push {r4, lr}\n"
        " mov r4, r0\n"
        " sub sp, sp, #24\n"
        " str r4, [sp]\n"
        "1: cmp r4, #1\n"
        " it eq\n"
        " addeq r4, r4, #0\n"
        " subs r4, r4, #1\n"
        " bne 1b\n"
        " add sp, sp, #24\n"
        " bl calibration_leaf\n"
        " pop {r4, pc}\n");

void calibration(int loops);

void job_setup(void) {}

void job_run(int index, float *out)
{
    calibration(index + 1);
    out[0] = (float)index;
}
