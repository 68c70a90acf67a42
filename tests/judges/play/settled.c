/* What a controller settles at under loads that stand. Standard input has one record after another: a parameter block
 * and a load_t. Each begins with a controller of its own. Of each a line goes to standard output: the status of the
 * block, whether K is valid, its flags, the joints whose gap is open (bit 0 femur, bit 1 tibia), and K's xx, xz, zz
 * [N/mm].
 *
 *   settled < RECORDS */
#include <stdio.h>

#include "app_bench.h"

enum { SETTLES_TICKS = 2000 };

/* The motors' angles and torques, of femur and tibia joint, and what the sensor at the tip reads. */
typedef struct {
    float motor_rad[2], torque_n_mm[2], force_n[2];
} load_t;

void setUp(void) {}

void tearDown(void) {}

static bool settle(const brace_parameters_t *parameters, const load_t *load)
{
    bench_board();
    for (int i = 0; i < 2; i++) {
        brace_hal_joint_t *sample = &fake.joint[BRACE_FEMUR + i].sample;
        sample->motor_rad = load->motor_rad[i];
        sample->torque_n_mm = load->torque_n_mm[i];
    }
    fake.force_x_n = load->force_n[0];
    fake.force_z_n = load->force_n[1];
    bench_store(parameters);
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        return false;
    }
    for (int i = 0; i < SETTLES_TICKS; i++) {
        fake.now_us += parameters->controller.tick_us;
        brace_app_tick(&app, fake.now_us);
    }
    return true;
}

int main(void)
{
    uint8_t block[BRACE_BLOCK_BYTES];
    load_t load;
    brace_parameters_t parameters;
    while (fread(block, sizeof block, 1, stdin) == 1 && fread(&load, sizeof load, 1, stdin) == 1) {
        const brace_status_t status = brace_parameters_unpack(block, sizeof block, &parameters, NULL, NULL);
        if (status != BRACE_OK || !settle(&parameters, &load)) {
            printf("%d 0 0 0 0 0 0\n", (int)status);
            continue;
        }
        const brace_snapshot_t *s = now();
        const brace_stiffness_t *k = &s->stiffness.now;
        const uint32_t open = flank_open_gaps(&app.controller.flank) >> BRACE_FEMUR;
        printf("0 %d %u %u %.9g %.9g %.9g\n", (int)s->k_is_valid, (unsigned)k->flags, (unsigned)open,
               (double)k->k_xx_n_per_mm, (double)k->k_xz_n_per_mm, (double)k->k_zz_n_per_mm);
    }
    return 0;
}
