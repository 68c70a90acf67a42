/* What a controller settles at under loads that stand. Standard input has one record after another: a parameter block
 * and a load_t. Each begins with a controller of its own. Of each a line goes to standard output: the status of the
 * block, whether K is valid, its flags, the joints whose gap is open (bit 0 coxa, bit 1 femur, bit 2 tibia), and K
 * [N/mm]: xx, xz, zz of a limb in its plane; xx, xy, xz, yy, yz, zz of one in space.
 *
 *   settled < RECORDS */
#include <stdio.h>

#include "app_bench.h"

enum { SETTLES_TICKS = 2000 };

/* The motors' angles and torques, of coxa, femur and tibia joint, and what the sensor at the tip reads. */
typedef struct {
    int32_t in_space; /* 0: no coxa joint is fitted */
    float motor_rad[BRACE_LINK_COUNT], torque_n_mm[BRACE_LINK_COUNT], force_n[2];
} load_t;

void setUp(void) {}

void tearDown(void) {}

static bool settle(const brace_parameters_t *parameters, const load_t *load)
{
    bench_board();
    fake.joint[BRACE_COXA].absent = load->in_space == 0;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        brace_hal_joint_t *sample = &fake.joint[i].sample;
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
        const unsigned open = (unsigned)flank_open_gaps(&app.controller.flank);
        if (load.in_space != 0) {
            const brace_stiffness_spatial_t *k = &s->space.now;
            printf("0 %d %u %u %.9g %.9g %.9g %.9g %.9g %.9g\n", (int)s->space.is_valid, (unsigned)k->flags, open,
                   (double)k->k_xx_n_per_mm, (double)k->k_xy_n_per_mm, (double)k->k_xz_n_per_mm,
                   (double)k->k_yy_n_per_mm, (double)k->k_yz_n_per_mm, (double)k->k_zz_n_per_mm);
        } else {
            const brace_stiffness_t *k = &s->stiffness.now;
            printf("0 %d %u %u %.9g %.9g %.9g\n", (int)s->k_is_valid, (unsigned)k->flags, open,
                   (double)k->k_xx_n_per_mm, (double)k->k_xz_n_per_mm, (double)k->k_zz_n_per_mm);
        }
    }
    return 0;
}
