/* K in firmware with an operating system: a tick that reads joints and computes K, a task that tells others, and a task
 * that takes in another limb. docs/rtos.md says why each does what it does.
 *
 * POSIX threads stand in for the operating system's tasks; the comments name what FreeRTOS and Zephyr have instead.
 *   python3 tools/release/two_files.py --out build
 *   cc -std=c11 -O2 -pthread -Ibuild -I../bare_loop main.c ../bare_loop/limb.c build/brace_core.c -lm && ./a.out
 */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <time.h>

#include "limb.h" /* the paper's limb; yours: brace export --model limb.toml --c limb.c */

enum { PERIOD_NS = 1000000, TICKS = 1200, CHANGE_AT = 400, TOLD_EVERY = 400 }; /* a real controller never ends */
#define STALE_NS (3 * (int64_t)PERIOD_NS)

/* What the tick publishes, all of one posture. `number` is odd while the tick writes. */
typedef struct {
    atomic_uint number;
    _Atomic float k_xx_n_per_mm, k_xz_n_per_mm, k_zz_n_per_mm;
    atomic_int status;
    atomic_uint ticks, late;
} published_t;

static published_t published;
static brace_planar_t collapsed[2]; /* one is in force, the other is spare */
static _Atomic(const brace_planar_t *) in_force;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void sleep_until(int64_t at_ns) /* vTaskDelayUntil; k_sleep(K_TIMEOUT_ABS_US(...)) */
{
    const struct timespec at = {at_ns / 1000000000, at_ns % 1000000000};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) != 0) {
    }
}

static void publish(const brace_stiffness_t *k, brace_status_t status)
{
    atomic_fetch_add(&published.number, 1);
    atomic_store(&published.status, (int)status);
    if (status == BRACE_OK) { /* a refused call leaves K as it was: the status says so */
        atomic_store(&published.k_xx_n_per_mm, k->k_xx_n_per_mm);
        atomic_store(&published.k_xz_n_per_mm, k->k_xz_n_per_mm);
        atomic_store(&published.k_zz_n_per_mm, k->k_zz_n_per_mm);
    }
    atomic_fetch_add(&published.number, 1);
}

/* The task with the highest priority that computes. Only here are joints read and K computed. */
static void *tick_task(void *unused)
{
    int64_t due_ns = now_ns();
    for (unsigned tick = 1; tick <= TICKS; tick++) {
        sleep_until(due_ns);
        if (now_ns() - due_ns > STALE_NS) { /* late: do not catch up, the posture of the lost ticks is gone */
            atomic_fetch_add(&published.late, 1);
            due_ns = now_ns();
        }
        due_ns += PERIOD_NS;
        brace_stiffness_t k;
        publish(&k, brace_planar_stiffness(atomic_load(&in_force), 1.0f, 1.4f, &k));
        atomic_store(&published.ticks, tick);
    }
    return unused;
}

/* A task of low priority: a whole K, read without holding the tick up. It reads again what a tick has changed. */
static brace_status_t read_k(float k[3])
{
    unsigned before;
    brace_status_t status;
    do {
        before = atomic_load(&published.number);
        k[0] = atomic_load(&published.k_xx_n_per_mm);
        k[1] = atomic_load(&published.k_xz_n_per_mm);
        k[2] = atomic_load(&published.k_zz_n_per_mm);
        status = (brace_status_t)atomic_load(&published.status);
    } while (before % 2 != 0 || before != atomic_load(&published.number));
    return status;
}

/* Collapsing is work for a task of low priority. The tick takes the new constants from its next start on. */
static brace_status_t take_in(const brace_limb_t *new_limb)
{
    brace_planar_t *const spare = &collapsed[atomic_load(&in_force) == &collapsed[0]];
    const brace_status_t status = brace_planar_collapse(new_limb, spare);
    if (status == BRACE_OK) {
        const unsigned tick = atomic_load(&published.ticks);
        atomic_store(&in_force, spare);
        while (atomic_load(&published.ticks) - tick < 2 && atomic_load(&published.ticks) < TICKS) {
            sleep_until(now_ns() + PERIOD_NS); /* two ticks on, nobody reads the old constants: they are spare */
        }
    }
    return status;
}

static void wait_for_tick(unsigned tick)
{
    while (atomic_load(&published.ticks) < tick) {
        sleep_until(now_ns() + PERIOD_NS);
    }
}

int main(void)
{
    pthread_t tick; /* yours: a static task with a priority above all that talks, and its own stack */
    brace_limb_t softer = limb;
    softer.joint[BRACE_TIBIA].compliance_rad_per_n_mm *= 2.0f;
    atomic_store(&in_force, &limb_planar); /* the constants as they were exported */
    if (limb_check() != BRACE_OK || pthread_create(&tick, NULL, tick_task, NULL) != 0) {
        return 1;
    }
    for (unsigned at = TOLD_EVERY; at <= TICKS; at += TOLD_EVERY) {
        float k[3];
        wait_for_tick(at);
        if (read_k(k) == BRACE_OK) {
            printf("k_xx %.5f k_xz %.5f k_zz %.5f N/mm\n", (double)k[0], (double)k[1], (double)k[2]);
        }
        if (at == CHANGE_AT && take_in(&softer) != BRACE_OK) {
            return 1;
        }
    }
    pthread_join(tick, NULL);
    printf("%u ticks, %u late\n", atomic_load(&published.ticks), atomic_load(&published.late));
    return 0;
}
