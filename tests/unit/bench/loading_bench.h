/* A controller whose limb stands with its tip on the ground, a linear limb of known stiffness: for the tests of what a
 * loading test measures.
 *
 * With the joints' movement m from rest, the levers' matrix L and the true stiffness K, the ground pushes with
 * f = f0 - K L m and the motors carry -L'f; servos of stiffness P give way, so commanded offsets c lead to
 * m = (I + L'K L / P)^-1 c. Worked out in double, apart from the firmware. */
#ifndef LOADING_BENCH_H
#define LOADING_BENCH_H

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

static inline void play(void *user, brace_fake_t *board, int32_t joint)
{
    (void)user;
    (void)joint;
    static double at1 = NAN, at2 = NAN, tip_x, tip_z, knee_x, knee_z; /* an emulated board is slow at these */
    if (at1 != theta1 || at2 != theta2) {
        at1 = theta1;
        at2 = theta2;
        tip_x = femur_mm * cos(theta1) + tibia_mm * cos(theta1 - theta2);
        tip_z = femur_mm * sin(theta1) + tibia_mm * sin(theta1 - theta2);
        knee_x = femur_mm * cos(theta1);
        knee_z = femur_mm * sin(theta1);
    }
    /* tip's movement for theta1 and for theta2, which is flexion */
    const double l[2][2] = {{-tip_z, tip_z - knee_z}, {tip_x, -(tip_x - knee_x)}};
    const double k[2][2] = {{truth.xx, truth.xz}, {truth.xz, truth.zz}};
    double a[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 && !tip_is_free; j++) {
            for (int p = 0; p < 2; p++) {
                for (int q = 0; q < 2; q++) {
                    a[i][j] += l[p][i] * k[p][q] * l[q][j] / servo_n_mm_per_rad;
                }
            }
        }
    }
    const double c[2] = {(double)board->joint[1].command.offset_rad, (double)board->joint[2].command.offset_rad};
    const double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const double m[2] = {(a[1][1] * c[0] - a[0][1] * c[1]) / det, (a[0][0] * c[1] - a[1][0] * c[0]) / det};
    const double dx = l[0][0] * m[0] + l[0][1] * m[1], dz = l[1][0] * m[0] + l[1][1] * m[1];
    const double fx = tip_is_free ? 0.0 : preload_x_n - truth.xx * dx - truth.xz * dz;
    const double fz = tip_is_free ? 0.0 : preload_z_n - truth.xz * dx - truth.zz * dz;
    board->joint[1].sample.motor_rad = (float)(theta1 + m[0]);
    board->joint[2].sample.motor_rad = (float)(theta2 + m[1]);
    /* the tibia weighs at its middle */
    const double w1 = weight_n * 0.5 * (knee_x + tip_x), w2 = -weight_n * 0.5 * (tip_x - knee_x);
    board->joint[1].sample.torque_n_mm = (float)(w1 - (l[0][0] * fx + l[1][0] * fz));
    board->joint[2].sample.torque_n_mm = (float)(w2 - (l[0][1] * fx + l[1][1] * fz));
    for (int i = 1; i <= 2 && drive_rad_per_n_mm > 0.0; i++) { /* the link stays behind what its motor brings */
        brace_hal_joint_t *sample = &board->joint[i].sample;
        sample->link_rad = (float)((double)sample->motor_rad - drive_rad_per_n_mm * (double)sample->torque_n_mm);
    }
    board->force_x_n = (float)fx + noise();
    board->force_z_n = (float)fz + noise();
}

static const brace_loading_setup_t along_x = {.axis = BRACE_AXIS_X, .steps_per_side = 4, .step_mm = 0.635f,
                                              .dwell_us = 400000, .rate_mm_per_s = 10.0f, .force_max_n = 100.0f,
                                              .torque_max_n_mm = 8000.0f, .source = BRACE_LOADING_ENCODED};

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
