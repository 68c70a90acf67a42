/* The clock goes round every 71.6 minutes, at any moment of whatever the controller is at. One scene with all of that
 * in it is played far from that moment, and then across it at many places: whatever the controller reports, commands or
 * answers has to be the same, tick by tick, but for the clock itself. A board shows that at few places. The sanitized
 * build looks for faults of memory, which lie in the same code at each place: it plays every tenth of the host's. */
#include "can_bench.h"
#include "loading_bench.h"

#ifdef __SANITIZE_ADDRESS__
enum { PLACES = 25 };
#else
enum { PLACES = ON_BOARD ? 5 : 250 };
#endif
enum { UNIT = 17, SCENE_TICKS = 5000, FAR_US = 1000000000 };

static uint32_t reported[SCENE_TICKS]; /* of each tick, as a sum of all that it reported */

void setUp(void) {}
void tearDown(void) {}

static uint32_t with(uint32_t sum, const void *bytes, size_t count)
{
    return brace_crc32(sum, bytes, (uint32_t)count);
}

/* What a tick reported: the snapshot, the drives' commands, frames, bytes. */
static uint32_t sum_of_tick(uint32_t start_us)
{
    const brace_snapshot_t *s = now();
    const brace_stiffness_t *k = &s->stiffness.now;
    const uint32_t words[] = {s->sequence,
                              s->taken_us - start_us,
                              s->mode,
                              s->faults,
                              s->k_is_valid,
                              k->flags,
                              s->play[1].state,
                              s->play[2].state,
                              s->play[1].phase,
                              s->play[2].phase,
                              s->force_is_sensed,
                              app.controller.loading.phase,
                              app.controller.loading.step,
                              app.controller.parameters.crc};
    const float numbers[] = {k->k_xx_n_per_mm,
                             k->k_zz_n_per_mm,
                             s->theta_rad[1],
                             s->theta_rad[2],
                             s->force_x_n,
                             fake.joint[1].command.offset_rad,
                             fake.joint[2].command.offset_rad,
                             fake.joint[1].command.torque_limit_n_mm,
                             s->play[1].load_n_mm};
    uint32_t sum = with(with(0, words, sizeof words), numbers, sizeof numbers);
    brace_can_frame_t frame;
    while (brace_fake_frame_take(&fake, &frame)) {
        sum = with(with(sum, &frame.id, sizeof frame.id), frame.data, frame.length);
    }
    for (int port = BRACE_SERIAL_MODBUS; port <= BRACE_SERIAL_MODBUS_TCP; port++) {
        uint8_t bytes[512];
        sum = with(sum, bytes, brace_fake_bytes_take(&fake, (brace_serial_port_t)port, bytes, sizeof bytes));
    }
    return sum;
}

static void line_asks_in_two_pieces(int tick)
{
    static const uint8_t reads[] = {UNIT, 4, 0, 10, 0, 4, 0xd3, 0x5b}; /* registers 10 to 13 */
    const uint32_t at = (uint32_t)tick % 25u;
    if (at == 0u || at == 8u) { /* a gap longer than the line's silence: an adapter that holds bytes back */
        (void)brace_fake_bytes_arrive(&fake, BRACE_SERIAL_MODBUS, reads + (at == 0u ? 0 : 5), at == 0u ? 5 : 3);
    }
}

/* What happens before a tick: samples that stay away, a bus that is off, a loading test, play taken up and let go, a
 * set stored, a CONFIGURATION that nobody feeds, questions all along. */
static void happens(int tick)
{
    static brace_parameters_t set;
    uint8_t data[8] = {BRACE_REQUEST_IDENTIFY, (uint8_t)tick};
    fake.joint[BRACE_TIBIA].not_newer = tick % 400 >= 365 && tick > 3000;
    fake.can_health.bus_off = tick >= 2400 && tick < 2700;
    if (tick % 7 == 0) {
        arrives(0x600u + NODE, data, 8);
    }
    line_asks_in_two_pieces(tick);
    switch (tick) {
    case 100: TEST_ASSERT_EQUAL(BRACE_OK, brace_app_take_up(&app, BRACE_FEMUR, -1)); break;
    case 700: TEST_ASSERT_EQUAL(BRACE_OK, brace_app_let_go(&app)); break;
    case 1100: {
        brace_loading_setup_t setup = along_x;
        setup.dwell_us = 20000, setup.steps_per_side = 2, setup.step_mm = 0.1f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_loading_start(&app, &setup));
        break;
    }
    case 2790: TEST_ASSERT_EQUAL(BRACE_LOADING_DONE, result()->outcome); break;
    case 2800:
        set = *brace_app_parameters(&app);
        set.limb.femur_mm += 1.0f;
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app));
        TEST_ASSERT_EQUAL(BRACE_OK, brace_app_parameters_commit(&app, &set));
        break;
    case 3000: TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_leave(&app)); break;
    case 4200: TEST_ASSERT_EQUAL(BRACE_OK, brace_app_configuration_enter(&app)); break; /* and is forgotten */
    default: break;
    }
}

/* The scene, from so far along the clock. Compares with the one before if there was one. */
static void scene(uint32_t start_us, bool compare)
{
    brace_parameters_t p = bench_parameters();
    p.limb.joint[BRACE_FEMUR].gap_rad = p.limb.joint[BRACE_TIBIA].gap_rad = 0.005f;
    p.drive[BRACE_FEMUR].takeup_torque_n_mm = p.drive[BRACE_TIBIA].takeup_torque_n_mm = 8000.0f;
    p.controller.modbus_address = UNIT;
    p.controller.heartbeat_hz = 5;
    stand(&p);
    weight_n = 20.0;
    preload_z_n = 25.0;
    fake.now_us = start_us;
    TEST_ASSERT_EQUAL(BRACE_OK, brace_app_start(&app, &fake.hal));
    for (int tick = 0; tick < SCENE_TICKS; tick++) {
        happens(tick);
        if (tick > 4200 && app.controller.mode.now == BRACE_MODE_CONFIGURATION && tick % 100 == 0) {
            fake.now_us += BRACE_CONFIGURATION_PATIENCE_US / 4; /* nobody waits for that tick by tick */
        }
        ticks(1);
        const uint32_t sum = sum_of_tick(start_us);
        if (compare && sum != reported[tick]) {
            printf("tick %d, the clock at %08x\n", tick, (unsigned)fake.now_us);
            TEST_ASSERT_EQUAL_HEX32(reported[tick], sum);
        }
        reported[tick] = sum;
    }
    TEST_ASSERT_EQUAL(BRACE_MODE_MONITOR, app.controller.mode.now); /* it has been left */
    TEST_ASSERT_EQUAL(0, now()->faults & BRACE_FAULTS_NO_K);
}

static void test_nothing_depends_on_where_the_clock_stands(void)
{
    scene(FAR_US, false);
    for (uint32_t i = 0; i < PLACES; i++) { /* around at a place of the scene, and within a tick */
        const uint32_t before_us = (i * (uint32_t)SCENE_TICKS / PLACES) * TICK_US + 137u * i;
        scene(0u - before_us, true);
    }
}

static uint32_t age_reported_us(void)
{
    return app.wires.measured.age_us;
}

/* A joint has fallen silent. Its sample grows old and stays old, also when the clock has gone round once and more. */
static void test_a_sample_that_is_old_stays_old(void)
{
    const brace_parameters_t p = bench_parameters();
    bench_start(&p);
    ticks(100);
    TEST_ASSERT_TRUE(age_reported_us() <= TICK_US);
    fake.joint[BRACE_FEMUR].not_newer = true;
    ticks(1);
    uint32_t last_us = age_reported_us();
    for (int second = 0; second < 10000; second++) { /* 2 3/4 hours; a tick a second */
        fake.now_us += 999000u;
        ticks(1);
        TEST_ASSERT_TRUE(age_reported_us() >= last_us);
        last_us = age_reported_us();
    }
    TEST_ASSERT_TRUE(last_us > 1000000000u);
    fake.joint[BRACE_FEMUR].not_newer = false;
    ticks(5);
    TEST_ASSERT_TRUE(age_reported_us() <= TICK_US);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_depends_on_where_the_clock_stands);
    RUN_TEST(test_a_sample_that_is_old_stays_old);
    return UNITY_END();
}
