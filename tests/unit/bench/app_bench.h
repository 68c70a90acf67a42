/* A controller on the fake board, with parameters in its store, for the tests of the application. */
#ifndef APP_BENCH_H
#define APP_BENCH_H

#include "brace/app.h"
#include "brace/app_memory.h"
#include "brace_hal_fake.h"
#include "close.h"
#include "sample_limbs.h"
#include "unity.h"

enum { TICK_US = 1000 };

/* An emulated board is slow. It has to show that its arithmetic agrees and that its compiler, its library and its
 * alignment change nothing. Each path of the code and each kind of input shows that once; where only the same is
 * repeated, and a test says so, hosts do it more often. */
#ifdef __arm__
enum { ON_BOARD = 1, TIMES_ON_HOST = 1 };
#else
enum { ON_BOARD = 0, TIMES_ON_HOST = 4 };
#endif

static brace_fake_t fake;
static brace_app_t app;

/* A limb as sold: the paper's, no play, quiet drives. */
static inline brace_parameters_t bench_parameters(void)
{
    brace_parameters_t p;
    brace_parameters_default(&p);
    p.limb = sample_limb[SAMPLE_PAPER];
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.drive[i] = (brace_drive_t){.torque_range_n_mm = 10000.0f,
                                     .torque_noise_n_mm = 10.0f,
                                     .torque_bias_n_mm = 10.0f,
                                     .motor_friction_n_mm = 20.0f,
                                     .motor_friction_tolerance_ratio = 0.2f,
                                     .angle_step_rad = 1e-5f,
                                     .angle_min_rad = -2.0f,
                                     .angle_max_rad = 3.0f,
                                     .takeup_torque_n_mm = 4000.0f};
    }
    p.sensor.noise_n = 0.05f;
    p.controller.node_id = 5;
    p.controller.tick_us = TICK_US;
    p.controller.age_limit_us = 20000;
    return p;
}

/* The model of a set, every part of it. */
static inline void bench_model(model_t *model, const brace_parameters_t *p, bool is_spatial)
{
    for (int part = 0; part < MODEL_PARTS; part++) {
        model_configure(model, p, is_spatial, (model_part_t)part);
    }
}

/* Puts a set into the fake's memory, as a controller that was configured long ago would have it. */
static inline void bench_store(const brace_parameters_t *p)
{
    static brace_store_t store;
    brace_parameters_t before;
    (void)brace_store_start(&store, &fake.hal, &before);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_store_begin(&store, p, NULL));
    brace_store_state_t state = BRACE_STORE_BUSY;
    for (int i = 0; i < 1000 && state == BRACE_STORE_BUSY; i++) {
        state = brace_store_step(&store);
    }
    TEST_ASSERT_EQUAL(BRACE_STORE_DONE, state);
}

/* A master that gives its sign of life while it wants the limb to move, in as many ticks as a client does, and at once
 * where a motion waits for it. */
enum { LIFE_TICKS = 40 };
static const brace_who_t *living_master;

/* The sign of life that a master of a bench gives now. */
static inline brace_sign_t sign_now(void)
{
    brace_session_report_t reported;
    brace_app_session(&app, &reported);
    return (brace_sign_t){.heard = reported.has_begin ? reported.begin : reported.number, .heard_bits = 32};
}

static inline bool something_waits(void)
{
    brace_session_report_t reported;
    brace_app_session(&app, &reported);
    return reported.has_begin;
}

static inline void bench_board(void)
{
    brace_fake_start(&fake);
    living_master = NULL;
    fake.joint[BRACE_COXA].absent = true; /* a limb that moves in its plane only */
    fake.joint[BRACE_FEMUR].sample.motor_rad = 1.0f;
    fake.joint[BRACE_TIBIA].sample.motor_rad = 1.4f;
}

static inline void bench_start(const brace_parameters_t *p)
{
    bench_board();
    bench_store(p);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
}

static inline void ticks(int count)
{
    static uint32_t since_life;
    for (int i = 0; i < count; i++) {
        fake.now_us += TICK_US;
        if (living_master != NULL && (++since_life >= (uint32_t)LIFE_TICKS || something_waits())) {
            const brace_sign_t sign = sign_now();
            since_life = 0;
            (void)brace_app_life(&app, *living_master, &sign);
        }
        brace_app_tick(&app, fake.now_us);
    }
}

/* Wherever the fake's joints stand now, they are believed there: a test that puts a limb elsewhere at once needs it. */
static inline void bench_believe(void)
{
    (void)brace_app_clear(&app, BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR | BRACE_FAULT_JUMP_TIBIA);
}

static inline const brace_snapshot_t *now(void)
{
    return brace_app_snapshot(&app);
}

static inline brace_app_counters_t counters(void)
{
    brace_app_counters_t all;
    brace_app_counters(&app, &all);
    return all;
}

/* A limb's equilibrium under a force on its tip, by the core's estimator: tests/judges/engine judges it. Every joint is
 * a linear spring. */
static inline brace_loaded_stiffness_t equilibrium(const brace_parameters_t *p, float theta1_rad, float theta2_rad,
                                                   brace_force_t tip, brace_vec_t down)
{
    const float hip = p->limb.joint[BRACE_FEMUR].compliance_rad_per_n_mm;
    const float knee = p->limb.joint[BRACE_TIBIA].compliance_rad_per_n_mm;
    const brace_load_t load = {.tip = tip, .down = down, .hip = {hip, hip}, .knee = {knee, knee}};
    brace_loaded_t loaded;
    brace_loaded_stiffness_t result;
    brace_loaded_collapse(&p->limb, &p->gravity, &loaded);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_loaded_stiffness(&loaded, theta1_rad, theta2_rad, &load, &result));
    return result;
}

static inline uint32_t engaged_flags(void)
{
    return now()->stiffness.engaged.flags;
}

#endif
