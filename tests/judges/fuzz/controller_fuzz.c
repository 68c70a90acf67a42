/* controller_fuzz [TICKS [SEED]]: a controller of any parameters that may be, at their limits too, on a board that
 * fails: samples absent, old, absurd; forces, commands, memory and buses that refuse; ticks late, the clock going
 * round; all requests at any time. It fails when
 *   a K is called valid in a mode or with a fault that has none, out of old samples, or is no stiffness at all
 *   one is called invalid and no flag says why, or is flagged GAP_OPEN otherwise than the joints' play says
 *   a drive is commanded what is no number
 *   the controller, once all that is over, is not back in MONITOR within RECOVERY_S
 * Exit code 0 and one line when all is well. */
#include "fuzz.h"

enum { NODE = 5, LIMB_TICKS = 4000, QUIET_EVERY = 1000, RECOVERY_S = 40 };

static uint32_t tick_us, in_time; /* ticks in a row that were not late */
static uint32_t valid, with_play, limbs, recovered, modes[6];

static float real(float low, float high)
{
    return low + (high - low) * (float)dice(1000001) * 1e-6f;
}

/* ------------------------------------------------------------------------------------------ parameters -- */

static uint32_t edge(void)
{
    static const float floats[] = {0.0f, 1e-45f, 1e-30f, 1e-9f, 1e-7f, 1e-5f, 1e-4f, 1e-3f, 0.01f,
                                   0.1f, 0.5f,   0.9f,   1.0f,  1.5f,  3.1f,  7.9f,  22.0f, 100.0f,
                                   1e3f, 1e4f,   1e5f,   1e6f,  1e9f,  1e20f, 1e30f, 3e38f, INFINITY};
    static const uint32_t words[] = {0,    1,    2,    5,    10,    127,    247,     500,     999,
                                     1000, 1001, 5000, 9600, 19200, 125000, 1000000, 8000000, 10000000};
    uint32_t word;
    if (dice(6) == 0u) {
        return words[dice(sizeof words / sizeof *words)];
    }
    float value = floats[dice(sizeof floats / sizeof *floats)];
    value = dice(3) == 0u ? -value : value;
    value = dice(2) == 0u ? value * real(0.5f, 1.5f) : value;
    memcpy(&word, &value, 4);
    return word;
}

/* The bench's, some members put to anywhere in their ranges, mostly where these end; but the node keeps its number. */
static brace_parameters_t any_parameters(void)
{
    brace_parameters_t p = bench_parameters();
    if (dice(2) == 0u) {
        p.limb.joint[BRACE_FEMUR].gap_rad = real(0.0f, 0.02f);
        p.limb.joint[BRACE_TIBIA].gap_rad = real(0.0f, 0.02f);
    }
    for (uint32_t left = dice(2) == 0u ? 0u : dice(12); left > 0u; left--) {
        const uint32_t index = dice(BRACE_PARAMETER_COUNT);
        brace_parameters_t changed = p;
        for (int i = 0; i < 50; i++) {
            const uint32_t word = edge();
            if (index != BRACE_PARAMETER_CONTROLLER_NODE_ID && brace_parameter_in_range(index, word) == BRACE_OK) {
                memcpy((uint8_t *)&changed + 4u * index, &word, 4);
                break;
            }
        }
        p = brace_parameters_check(&changed, NULL) == BRACE_OK ? changed : p;
    }
    return p;
}

static void start(void)
{
    const brace_parameters_t p = any_parameters();
    bench_board();
    bench_store(&p);
    fake.now_us = dice(3) == 0u ? 0xffffffffu - dice(3000000) : dice(0x7fffffff);
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    tick_us = p.controller.tick_us;
    limbs++;
}

/* ---------------------------------------------------------------------------------------------- the world -- */

static float absurd(void)
{
    static const float values[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e6f, 99.0f};
    return values[dice(6)];
}

static void move(void)
{
    for (int i = BRACE_FEMUR; i <= BRACE_TIBIA; i++) {
        brace_hal_joint_t *s = &fake.joint[i].sample;
        if (dice(3) == 0u) {
            s->motor_rad += real(-0.002f, 0.002f);
        }
        if (dice(4) == 0u) {
            s->torque_n_mm += real(-1000.0f, 1000.0f);
        }
        if (dice(2000) == 0u) {
            s->motor_rad = real(-2.5f, 3.5f);
            s->torque_n_mm = real(-9000.0f, 9000.0f);
            s->link_rad = dice(2) == 0u ? s->motor_rad : NAN;
            s->temp_degc = dice(2) == 0u ? real(-40.0f, 90.0f) : NAN;
        }
    }
    fake.force_x_n += real(-0.5f, 0.5f);
    fake.force_z_n += real(-0.5f, 0.5f);
}

static void disturb(void)
{
    brace_fake_joint_t *joint = &fake.joint[1u + dice(2)];
    switch (dice(14)) {
    case 0: joint->not_newer = !joint->not_newer; break;
    case 1: joint->sample.motor_rad = absurd(); break;
    case 2: joint->sample.torque_n_mm = absurd(); break;
    case 3: joint->sample.link_rad = absurd(); break;
    case 4: joint->sample.temp_degc = absurd(); break;
    case 5: fake.force_x_n = absurd(); break;
    case 6: fake.force_not_newer = !fake.force_not_newer; break;
    case 7: fake.now_us += dice(30) * tick_us; break;
    case 8: fake.can_health.bus_off = !fake.can_health.bus_off; break;
    case 9: fake.nvm_stuck = dice(2) == 0u ? 0x10 : 0; break;
    case 10: joint->absent = !joint->absent; break;
    case 11: (void)brace_fake_fail_next(&fake, dice(BRACE_FAKE_ENTRY_COUNT), 1u + dice(20), BRACE_HAL_E_DEVICE); break;
    case 12: joint->keeps_taken_us = !joint->keeps_taken_us; break;
    default: joint->sample.taken_us = fake.now_us + dice(0x7fffffff); break;
    }
}

static void calm(void)
{
    fake.failure_count = 0;
    for (int i = 0; i < BRACE_FAKE_JOINTS; i++) {
        fake.joint[i].not_newer = fake.joint[i].absent = fake.joint[i].keeps_taken_us = false;
        fake.joint[i].sample = (brace_hal_joint_t){.motor_rad = 0.3f, .link_rad = NAN, .temp_degc = NAN};
    }
    fake.force_x_n = fake.force_z_n = 0.0f;
    fake.force_not_newer = false;
    fake.can_health.bus_off = false;
    fake.nvm_stuck = 0;
}

static void request(void)
{
    brace_parameters_t p;
    const brace_loading_setup_t setup = {.axis = dice(2) == 0u ? BRACE_AXIS_X : BRACE_AXIS_Z,
                                         .steps_per_side = 2u + dice(10),
                                         .step_mm = real(0.001f, 3.0f),
                                         .dwell_us = 20000u + dice(100000),
                                         .rate_mm_per_s = real(0.5f, 1000.0f),
                                         .force_max_n = 1e6f,
                                         .torque_max_n_mm = 1e6f,
                                         .source = dice(2) == 0u ? BRACE_LOADING_ENCODED : BRACE_LOADING_COMMANDED};
    switch (dice(12)) {
    case 0:
    case 1: (void)brace_app_take_up(&app, (int32_t)(1u + dice(2)), dice(2) == 0u ? 1 : -1); break;
    case 2: (void)brace_app_let_go(&app); break;
    case 3:
    case 4:
    case 5: (void)brace_app_loading_start(&app, &setup); break;
    case 6: (void)brace_app_loading_stop(&app); break;
    case 7: (void)brace_app_configuration_enter(&app); break;
    case 8: (void)brace_app_configuration_leave(&app); break;
    case 9:
        p = any_parameters();
        p.controller.tick_us = app.controller.parameters.in_force.controller.tick_us;
        (void)brace_app_parameters_commit(&app, &p);
        break;
    case 10: (void)brace_app_parameters_rollback(&app); break;
    default:
        (void)brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED | BRACE_FAULT_ENCODER_STUCK |
                                        BRACE_FAULT_OLD_PARAMETERS | BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR |
                                        BRACE_FAULT_JUMP_TIBIA);
        break;
    }
}

static void ask_something(void)
{
    brace_can_frame_t frame = {.id = 0x600u + NODE, .length = 8};
    for (uint32_t i = 0; i < 8u; i++) {
        frame.data[i] = (uint8_t)dice(256);
    }
    frame.data[0] = (uint8_t)(1u + dice(22));
    (void)brace_fake_frame_arrives(&fake, &frame);
}

/* ------------------------------------------------------------------------------------------------ judging -- */

static void broken(const char *what)
{
    const brace_snapshot_t *s = brace_app_snapshot(&app);
    const brace_stiffness_t *k = &s->stiffness.now;
    const brace_stiffness_t *engaged = &s->stiffness.engaged;
    printf("mode %d, faults %x, flags %x and %x engaged, K %g %g %g, eigenvalues %g %g, %g %g engaged, theta %g %g\n",
           s->mode, s->faults, k->flags, engaged->flags, (double)k->k_xx_n_per_mm, (double)k->k_xz_n_per_mm,
           (double)k->k_zz_n_per_mm, (double)k->lambda_min_n_per_mm, (double)k->lambda_max_n_per_mm,
           (double)engaged->lambda_min_n_per_mm, (double)engaged->lambda_max_n_per_mm, (double)s->theta_rad[1],
           (double)s->theta_rad[2]);
    fail(what, NULL, 0);
}

static bool is_stiffness(const brace_stiffness_t *k)
{
    const double xx = k->k_xx_n_per_mm, xz = k->k_xz_n_per_mm, zz = k->k_zz_n_per_mm;
    const double low = k->lambda_min_n_per_mm, high = k->lambda_max_n_per_mm, room = 1e-5 * high;
    const bool numbers = isfinite(xx) && isfinite(xz) && isfinite(zz) && isfinite(high) && isfinite(k->stiff_axis_rad);
    return numbers && low >= 0.0 && high >= low && fabs(xx + zz - low - high) <= room && xx >= -room && zz >= -room &&
           fabs(xz) <= high + room;
}

static void judge(void)
{
    const brace_snapshot_t *s = brace_app_snapshot(&app);
    const brace_stiffness_t *now_k = &s->stiffness.now, *engaged = &s->stiffness.engaged;
    modes[s->mode]++;
    bool open = false;
    for (int i = 0; i < 2; i++) {
        const flank_joint_t *joint = &app.controller.flank.joint[BRACE_FEMUR + i];
        open |= joint->has_play && !s->play[BRACE_FEMUR + i].valid && !joint->is_assumed;
        if (!isfinite(fake.joint[1 + i].command.offset_rad) || !(fake.joint[1 + i].command.torque_limit_n_mm >= 0.0f)) {
            broken("no number for a drive");
        }
    }
    if (!s->k_is_valid) {
        const uint32_t why = BRACE_FLAG_STALE | BRACE_FLAG_OUT_OF_RANGE | BRACE_FLAG_NEAR_SINGULAR;
        if ((now_k->flags & engaged->flags & why) == 0u) {
            broken("invalid, and no flag says why");
        }
        return;
    }
    valid++;
    with_play += open;
    if (s->mode != BRACE_MODE_MONITOR && s->mode != BRACE_MODE_TAKING_UP && s->mode != BRACE_MODE_LOADING_TEST) {
        broken("valid in a mode that has no K");
    }
    if ((s->faults & BRACE_FAULTS_NO_K) != 0u) {
        broken("valid with a fault that has no K");
    }
    const bool is_fresh = s->taken_us == fake.now_us; /* else a joint may have moved since, and K says so */
    if (is_fresh && ((now_k->flags | engaged->flags) & BRACE_FLAG_STALE) != 0u) { /* a temperature sets OUT_OF_RANGE */
        broken("valid, flagged otherwise");
    }
    if ((now_k->flags & BRACE_FLAG_GAP_OPEN) != 0u ? !open : open) {
        broken("GAP_OPEN is not what the joints' play says");
    }
    if (!is_stiffness(now_k) || !is_stiffness(engaged) || !(engaged->lambda_min_n_per_mm > 0.0f)) {
        broken("valid, and no stiffness");
    }
    if (now_k->lambda_max_n_per_mm > engaged->lambda_max_n_per_mm * 1.0001f) {
        broken("stiffer with a gap open");
    }
    const int32_t age_us = (int32_t)(fake.now_us - s->taken_us);
    if (in_time > 0u && age_us > (int32_t)app.controller.parameters.in_force.controller.age_limit_us) {
        broken("valid of old samples");
    }
}

static void step(uint32_t late_us)
{
    brace_can_frame_t frame;
    tick_us = app.controller.parameters.in_force.controller.tick_us;
    fake.now_us += tick_us + late_us;
    in_time = fake.now_us - app.controller.now_us <= 2u * tick_us ? in_time + 1u : 0u;
    brace_app_tick(&app, fake.now_us);
    while (brace_fake_frame_take(&fake, &frame)) {
    }
    judge();
}

/* Left alone, whatever it was at, it comes back. */
static void recover(void)
{
    calm();
    fake.can_received.count = 0;
    if (app.controller.loading.phase != LOADING_IDLE) {
        (void)brace_app_loading_stop(&app);
    }
    (void)brace_app_let_go(&app);
    for (uint32_t us = 0; us < 1000000u * RECOVERY_S; us += tick_us) {
        fake.joint[BRACE_FEMUR].sample.motor_rad = dice(2) == 0u ? 0.3f : 0.32f;
        fake.joint[BRACE_TIBIA].sample.motor_rad = dice(2) == 0u ? 0.3f : 0.32f;
        step(0);
        if (app.controller.ownership.is_held) {
            (void)brace_app_let_go(&app); /* somebody has stopped it, or has asked and gone */
        }
        (void)brace_app_clear(&app, BRACE_FAULT_JUMP_COXA | BRACE_FAULT_JUMP_FEMUR | BRACE_FAULT_JUMP_TIBIA);
        if (app.controller.mode.now == BRACE_MODE_MONITOR && us > 300000u) {
            recovered++;
            return;
        }
    }
    broken("it does not come back");
}

int main(int count, char **arguments)
{
    const unsigned long wanted = count > 1 ? strtoul(arguments[1], NULL, 10) : 1000000ul;
    fuzz_seed(count > 2 ? arguments[2] : NULL);
    for (fed = 0; fed < wanted; fed++) {
        if (fed % LIMB_TICKS == 0u) {
            start();
        }
        move();
        if (dice(150) == 0u) {
            disturb();
        }
        if (dice(60) == 0u) {
            request();
        }
        if (dice(20) == 0u) {
            ask_something();
        }
        step(dice(10) == 0u ? dice(20) : 0u);
        if (fed % QUIET_EVERY == QUIET_EVERY - 1u) {
            recover();
        }
    }
    printf("%lu ticks, %u limbs: %u with a valid K, %u of these with play open; %u times back from anything\n", wanted,
           limbs, valid, with_play, recovered);
    for (uint32_t mode = 0; mode < 6u && wanted >= 100000ul; mode++) {
        if (modes[mode] < 100u) {
            printf("mode %u in %u ticks only\n", mode, modes[mode]);
            return 1;
        }
    }
    return wanted < 10000ul || (valid > wanted / 10u && with_play > 0u && recovered > 0u) ? 0 : 1;
}
