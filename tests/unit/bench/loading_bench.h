/* A controller whose limb stands with its tip on the ground, a linear limb of known stiffness: for the tests of what a
 * loading test measures.
 *
 * With the joints' movement m from rest, the levers' matrix L under the preload and the true stiffness K, the ground
 * pushes with f = f0 - K L m and the motors carry -A'f, A the levers of straight links; servos of stiffness P give way,
 * so commanded offsets c lead to m = (I + A'K L / P)^-1 c. Worked out in double, apart from the firmware. */
#ifndef LOADING_BENCH_H
#define LOADING_BENCH_H

#include <string.h>

#include "app_bench.h"

typedef struct {
    double xx, xz, zz;
} symmetric_t;

static symmetric_t truth;       /* N/mm */
static double servo_n_mm_per_rad, preload_x_n, preload_z_n, weight_n;
static double drive_rad_per_n_mm; /* between motor and link encoder; 0: there is none */
static bool tip_is_free;
static float noise_n;
static uint32_t noise_state;

static double theta1 = 1.0, theta2 = 1.4;
static const double femur_mm = 185.0, tibia_mm = 313.5;

static inline float noise(void) /* uniform, one sigma noise_n */
{
    noise_state = noise_state * 1664525u + 1013904223u;
    return noise_n * 3.4641016f * ((float)(noise_state >> 8) / 16777216.0f - 0.5f);
}

/* What the world is given, and what follows from it. An emulated processor without a floating point unit takes long to
 * work it out in double, so that is done only when something has changed. */
typedef struct {
    double theta1, theta2, servo_n_mm_per_rad, preload_x_n, preload_z_n, weight_n, drive_rad_per_n_mm;
    symmetric_t truth;
    float command_rad[2];
    bool tip_is_free;
} world_t;

typedef struct {
    float motor_rad[2], torque_n_mm[2], link_rad[2], force_x_n, force_z_n;
} response_t;

/* Where a limb stands, and which limb it is: what the levers follow from. */
typedef struct {
    double theta1, theta2, preload_x_n, preload_z_n;
    brace_limb_t limb;
    brace_gravity_t gravity;
} stance_t;

static inline bool same_stance(const stance_t *a, const stance_t *b)
{
    return a->theta1 == b->theta1 && a->theta2 == b->theta2 && a->preload_x_n == b->preload_x_n &&
           a->preload_z_n == b->preload_z_n && memcmp(&a->limb, &b->limb, sizeof a->limb) == 0 &&
           memcmp(&a->gravity, &b->gravity, sizeof a->gravity) == 0;
}

/* How what the load moves changes with theta1 and theta2, while the load stays. The step is not the firmware's. Four
 * equilibria are the dearest part of this world, so they are worked out only when the limb stands otherwise, not for
 * each command that its drives follow. */
static inline void levers_under_preload(const world_t *w, double l[2][2])
{
    static stance_t last; /* zero: no limb stands so */
    static double more[2][2];
    const double step_rad = 0.02;
    const brace_parameters_t *p = &app.controller.parameters.in_force;
    const stance_t stance = {w->theta1, w->theta2, w->preload_x_n, w->preload_z_n, p->limb, p->gravity};
    if (!same_stance(&stance, &last)) {
        last = stance;
        const brace_force_t tip = {(float)w->preload_x_n, (float)w->preload_z_n};
        const brace_vec_t down = {0.0f, -1.0f};
        for (int j = 0; j < 2; j++) {
            brace_displacement_t moved[2];
            for (int side = 0; side < 2; side++) {
                const double step = side == 0 ? step_rad : -step_rad;
                moved[side] = equilibrium(p, (float)(w->theta1 + (j == 0 ? step : 0.0)),
                                          (float)(w->theta2 + (j == 1 ? step : 0.0)), tip, down)
                                  .displacement;
            }
            more[0][j] = (double)(moved[0].x_mm - moved[1].x_mm) / (2.0 * step_rad);
            more[1][j] = (double)(moved[0].z_mm - moved[1].z_mm) / (2.0 * step_rad);
        }
    }
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            l[i][j] += more[i][j];
        }
    }
}

static inline response_t response_of(const world_t *w)
{
    const double knee_x = femur_mm * cos(w->theta1), knee_z = femur_mm * sin(w->theta1);
    const double tip_x = knee_x + tibia_mm * cos(w->theta1 - w->theta2);
    const double tip_z = knee_z + tibia_mm * sin(w->theta1 - w->theta2);
    const double arm[2][2] = {{-tip_z, tip_z - knee_z}, {tip_x, -(tip_x - knee_x)}}; /* of the motors' torques */
    double l[2][2] = {{arm[0][0], arm[0][1]}, {arm[1][0], arm[1][1]}};
    if (!w->tip_is_free) {
        levers_under_preload(w, l);
    }
    const double k[2][2] = {{w->truth.xx, w->truth.xz}, {w->truth.xz, w->truth.zz}};
    double a[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 && !w->tip_is_free; j++) {
            for (int p = 0; p < 2; p++) {
                for (int q = 0; q < 2; q++) {
                    a[i][j] += arm[p][i] * k[p][q] * l[q][j] / w->servo_n_mm_per_rad;
                }
            }
        }
    }
    const double c[2] = {(double)w->command_rad[0], (double)w->command_rad[1]};
    const double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const double m[2] = {(a[1][1] * c[0] - a[0][1] * c[1]) / det, (a[0][0] * c[1] - a[1][0] * c[0]) / det};
    const double dx = l[0][0] * m[0] + l[0][1] * m[1], dz = l[1][0] * m[0] + l[1][1] * m[1];
    const double fx = w->tip_is_free ? 0.0 : w->preload_x_n - k[0][0] * dx - k[0][1] * dz;
    const double fz = w->tip_is_free ? 0.0 : w->preload_z_n - k[1][0] * dx - k[1][1] * dz;
    /* the tibia weighs at its middle */
    const double weight_n_mm[2] = {w->weight_n * 0.5 * (knee_x + tip_x), -w->weight_n * 0.5 * (tip_x - knee_x)};
    const double theta[2] = {w->theta1, w->theta2};
    response_t r = {.force_x_n = (float)fx, .force_z_n = (float)fz};
    for (int i = 0; i < 2; i++) {
        r.motor_rad[i] = (float)(theta[i] + m[i]);
        r.torque_n_mm[i] = (float)(weight_n_mm[i] - (arm[0][i] * fx + arm[1][i] * fz));
        /* the link stays behind what its motor brings */
        r.link_rad[i] = (float)((double)r.motor_rad[i] - w->drive_rad_per_n_mm * (double)r.torque_n_mm[i]);
    }
    return r;
}

static inline bool same_world(const world_t *a, const world_t *b)
{
    return a->theta1 == b->theta1 && a->theta2 == b->theta2 && a->servo_n_mm_per_rad == b->servo_n_mm_per_rad &&
           a->preload_x_n == b->preload_x_n && a->preload_z_n == b->preload_z_n && a->weight_n == b->weight_n &&
           a->drive_rad_per_n_mm == b->drive_rad_per_n_mm && a->truth.xx == b->truth.xx && a->truth.xz == b->truth.xz &&
           a->truth.zz == b->truth.zz && a->command_rad[0] == b->command_rad[0] &&
           a->command_rad[1] == b->command_rad[1] && a->tip_is_free == b->tip_is_free;
}

static inline void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    (void)joint;
    static world_t last; /* zero: no limb stands so */
    static response_t r;
    const world_t w = {theta1,
                       theta2,
                       servo_n_mm_per_rad,
                       preload_x_n,
                       preload_z_n,
                       weight_n,
                       drive_rad_per_n_mm,
                       truth,
                       {board->joint[1].command.offset_rad, board->joint[2].command.offset_rad},
                       tip_is_free};
    if (!same_world(&w, &last)) {
        last = w;
        r = response_of(&w);
    }
    for (int i = 0; i < 2; i++) {
        brace_hal_joint_t *sample = &board->joint[i + 1].sample;
        sample->motor_rad = r.motor_rad[i];
        sample->torque_n_mm = r.torque_n_mm[i];
        if (drive_rad_per_n_mm > 0.0) {
            sample->link_rad = r.link_rad[i];
        }
    }
    board->force_x_n = r.force_x_n + noise();
    board->force_z_n = r.force_z_n + noise();
}

static const brace_loading_setup_t along_x = {.axis = BRACE_AXIS_X,
                                              .steps_per_side = 4,
                                              .step_mm = 0.635f,
                                              .dwell_us = 100000 * TIMES_ON_HOST,
                                              .rate_mm_per_s = 10.0f,
                                              .force_max_n = 100.0f,
                                              .torque_max_n_mm = 8000.0f,
                                              .source = BRACE_LOADING_ENCODED};

static inline void stand(const brace_parameters_t *p)
{
    bench_start(p);
    truth = (symmetric_t){3.5, -0.5, 0.6};
    theta1 = 1.0;
    theta2 = 1.4;
    servo_n_mm_per_rad = 60000.0;
    preload_x_n = 1.0;
    preload_z_n = 6.0;
    weight_n = drive_rad_per_n_mm = 0.0;
    tip_is_free = false;
    noise_n = 0.0f;
    noise_state = 1;
    fake.play = play;
    ticks(50);
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, now()->mode);
}

static inline const brace_loading_result_t *result(void)
{
    return brace_app_loading_result(&app);
}

static inline void run(const brace_loading_setup_t *setup)
{
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, setup));
    ticks(1);
    TEST_ASSERT_EQUAL(BRACE_MODE_LOADING_TEST, now()->mode);
    for (int i = 0; i < 60000 && app.controller.mode.now == BRACE_MODE_LOADING_TEST; i++) {
        ticks(1);
    }
    ticks(2);
}

#endif
