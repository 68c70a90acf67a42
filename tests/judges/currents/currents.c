/* The force on the tip as a controller estimates it from its servos' currents, against what the force is. The servos
 * are those of servos.h. The controller runs on a fake board and has no sensor at the tip.
 *
 *   currents SEED HELD MOVING < BLOCK
 *
 * BLOCK is a parameter block, of the limb in mx106.toml. Each case draws both servos anew: the fit, M5 or M6, by a
 * coin; the torque by current and the friction by as much as mx106.toml says that they are not known. A line a case
 * goes to standard output: "held" or "moving", of x and z the true force, the interval's ends and the reported force
 * [N], of both joints the true load and the interval's ends [N mm].
 *
 * held: the tip comes to its place from a random side, and stands there. Then the ground presses: the force goes to one
 *   to four places after one another, each drawn anew. It is judged where it has rested for 0.2 to 0.5 s.
 * moving: both joints turn at speeds of their own, 0.1 to 2 rad/s, under a force of one size and direction. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app_bench.h"
#include "servos.h"

#define STEP_S 1e-4
#define STEPS_A_TICK 10
#define CURRENT_STEP_A 3.36e-3 /* Present Current of the MX-106 */
#define CURRENT_NOISE_A 0.010
#define MAKERS_N_MM_PER_A 1615.0f /* as the driver has it: docs/joints.md */
#define FIT_PER_MAKERS 1.37f      /* torque_ratio of the board */
#define ENCODER_STEP_RAD (6.283185307179586 / 4096.0)
#define CONSTANT_SD 0.03          /* torque_gain_rel of mx106.toml */
#define FRICTION_SPREAD 0.1       /* friction_tolerance_ratio of mx106.toml */
#define HOLDS_NM 5.0              /* the greatest load of a joint */

static uint64_t luck;
static limb_t limb;

void setUp(void) {}

void tearDown(void) {}

static double lot(double low, double high)
{
    return draw_uniform(&luck, low, high);
}

/* The motors' world goes on by one tick, and so does the controller. */
static void tick(const double speed_rad_per_s[SERVOS])
{
    for (int step = 0; step < STEPS_A_TICK; step++) {
        for (int i = 0; i < SERVOS; i++) {
            limb.servo[i].goal_rad += speed_rad_per_s[i] * STEP_S;
        }
        limb_step(&limb, STEP_S);
    }
    for (int i = 0; i < SERVOS; i++) {
        const servo_t *servo = &limb.servo[i];
        brace_hal_joint_t *sample = &fake.joint[BRACE_FEMUR + i].sample;
        const double current_a = servo->current_a + CURRENT_NOISE_A * draw_normal(&luck);
        const float steps = (float)round(current_a / CURRENT_STEP_A);
        sample->motor_rad = NAN;
        sample->link_rad = (float)(ENCODER_STEP_RAD * floor(servo->angle_rad / ENCODER_STEP_RAD));
        sample->torque_n_mm = steps * (float)CURRENT_STEP_A * MAKERS_N_MM_PER_A * FIT_PER_MAKERS;
    }
    fake.now_us += TICK_US;
    brace_app_tick(&app, fake.now_us);
}

static void go(double seconds, const double speed_rad_per_s[SERVOS])
{
    for (int i = 0; i < (int)(1000.0 * seconds); i++) {
        tick(speed_rad_per_s);
    }
}

static const double stands[SERVOS] = {0.0, 0.0};

/* A force that the joints can hold where the limb stands. */
static void draw_force(double force_n[2])
{
    double turned[SERVOS];
    const double before[2] = {limb.force_n[0], limb.force_n[1]};
    do {
        const double size_n = lot(1.0, 20.0), way_rad = lot(-3.141592653589793, 3.141592653589793);
        force_n[0] = limb.force_n[0] = size_n * cos(way_rad);
        force_n[1] = limb.force_n[1] = size_n * sin(way_rad);
        limb_turned(&limb, turned);
    } while (fabs(turned[0]) > HOLDS_NM || fabs(turned[1]) > HOLDS_NM);
    limb.force_n[0] = before[0];
    limb.force_n[1] = before[1];
}

static void press(const double force_n[2], double seconds)
{
    const double before[2] = {limb.force_n[0], limb.force_n[1]};
    const int count = (int)(1000.0 * seconds);
    for (int i = 1; i <= count; i++) {
        const double share = (double)i / count;
        limb.force_n[0] = before[0] + share * (force_n[0] - before[0]);
        limb.force_n[1] = before[1] + share * (force_n[1] - before[1]);
        tick(stands);
    }
}

static void start(const brace_parameters_t *parameters)
{
    limb = (limb_t){.femur_m = 0.185, .tibia_m = 0.3135, .femur_n = 2.0, .tibia_n = 1.5};
    const double angle_rad[SERVOS] = {lot(-0.6, 1.2), lot(0.5, 2.4)};
    for (int i = 0; i < SERVOS; i++) {
        servo_t *servo = &limb.servo[i];
        servo->fit = lot(0.0, 1.0) < 0.5 ? mx106_m5 : mx106_m6;
        servo->fit.kt *= 1.0 + CONSTANT_SD * draw_normal(&luck);
        servo->friction_factor = lot(1.0 - FRICTION_SPREAD, 1.0 + FRICTION_SPREAD);
        servo->goal_rad = servo->angle_rad = angle_rad[i];
    }
    bench_board();
    brace_fake_fail(&fake, BRACE_FAKE_TIP_FORCE_READ, 1, UINT32_MAX, BRACE_HAL_E_UNSUPPORTED);
    for (int i = 0; i < SERVOS; i++) {
        fake.joint[BRACE_FEMUR + i].sample =
            (brace_hal_joint_t){.motor_rad = NAN, .link_rad = (float)angle_rad[i], .temp_degc = NAN};
    }
    bench_store(parameters);
    if (brace_app_start(&app, &fake.hal) != BRACE_OK) {
        abort();
    }
}

static void hold(void)
{
    const double way_s = lot(0.1, 0.4);
    double speed[SERVOS], force_n[2];
    for (int i = 0; i < SERVOS; i++) {
        speed[i] = lot(-1.0, 1.0);
    }
    go(0.1, stands);
    go(way_s, speed);
    go(0.2, stands);
    const int places = (int)lot(1.0, 5.0);
    for (int i = 0; i < places; i++) {
        draw_force(force_n);
        press(force_n, lot(0.1, 0.4));
    }
    go(lot(0.2, 0.5), stands);
}

static void move(void)
{
    double speed[SERVOS], force_n[2];
    for (int i = 0; i < SERVOS; i++) {
        speed[i] = exp(lot(log(0.1), log(2.0))) * (lot(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
    }
    draw_force(force_n);
    press(force_n, 0.1);
    go(0.1, stands);
    go(lot(0.2, 0.5), speed);
}

static void tell(const char *kind)
{
    const brace_snapshot_t *s = now();
    double turned[SERVOS];
    limb_turned(&limb, turned);
    printf("%s %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g", kind, limb.force_n[0], (double)s->force_x_interval_n.low,
           (double)s->force_x_interval_n.high, (double)s->force_x_n, limb.force_n[1], (double)s->force_z_interval_n.low,
           (double)s->force_z_interval_n.high, (double)s->force_z_n);
    for (int i = 0; i < SERVOS; i++) {
        const brace_interval_t load = s->load_interval_n_mm[BRACE_FEMUR + i];
        printf(" %.9g %.9g %.9g", -1e3 * turned[i], (double)load.low, (double)load.high);
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    uint8_t block[BRACE_BLOCK_BYTES];
    brace_parameters_t parameters;
    if (argc != 4 || fread(block, sizeof block, 1, stdin) != 1 ||
        brace_parameters_unpack(block, sizeof block, &parameters, NULL, NULL) != BRACE_OK) {
        fprintf(stderr, "currents SEED HELD MOVING < BLOCK\n");
        return 2;
    }
    luck = strtoull(argv[1], NULL, 10);
    for (int i = atoi(argv[2]); i > 0; i--) {
        start(&parameters);
        hold();
        tell("held");
    }
    for (int i = atoi(argv[3]); i > 0; i--) {
        start(&parameters);
        move();
        tell("moving");
    }
    return 0;
}
