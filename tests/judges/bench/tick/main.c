/* Random ticks of the controller, to be counted: limbs of every kind, in their plane and in space, every mode,
 * requests at any time and on every port, bad samples, late ticks, traffic. Prints one letter per tick, which says
 * what kind of tick it was. The plugin counts meanwhile.
 *
 *   M monitor  T taking up  L loading test  R the drift check takes a reading of it in  J its slopes
 *   K its slopes against the model
 *   C configuration  S storing parameters, the last of these puts them in force  A start  F fault
 *   W a piece of a record of what the drift check knows
 *   Q CAN, SLCAN and both Modbus ports are flooded with requests, whatever the tick does beside
 * A small letter: the same of a limb in space.
 */
#include <stdio.h>

#include "brace/app.h"
#include "brace/app_memory.h"
#include "brace/can_messages.h"
#include "brace/measured.h"
#include "world.h"

#ifndef TICKS
#define TICKS 20000
#endif

enum { EPISODE_TICKS = 2500, LINE = 100 };

static brace_app_t app;
static struct {
    uint8_t block[BRACE_BLOCK_BYTES];
    uint32_t next; /* 0: none under way; 1: begin; then the words; then the commit */
} upload;
static dice_t dice = {0x9e3779b97f4a7c15u};
static bool flooded; /* every port is asked in every tick */

static brace_parameters_t random_parameters(const world_manner_t *manner)
{
    brace_parameters_t p;
    brace_parameters_default(&p);
    brace_limb_t *limb = &p.limb;
    limb->femur_mm = dice_between(&dice, 80.0f, 300.0f);
    limb->tibia_mm = dice_between(&dice, 80.0f, 400.0f);
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        limb->link[i].axial_mm_per_n = dice_between(&dice, 5e-4f, 5e-3f);
        limb->link[i].bending_mm_per_n = dice_between(&dice, 0.01f, 0.3f);
        limb->link[i].lateral_mm_per_n = dice_between(&dice, 0.01f, 0.3f);
        limb->link[i].torsion_rad_per_n_mm = dice_between(&dice, 1e-7f, 1e-5f);
        limb->link[i].tilt_rad = dice_in(&dice, 2) ? 0.0f : dice_between(&dice, -0.5f, 0.5f);
        limb->link[i].moment_transfer = dice_in(&dice, 2) ? 0.0f : dice_between(&dice, 0.1f, 1.0f);
        limb->joint[i].compliance_rad_per_n_mm = dice_between(&dice, 2e-6f, 4e-5f);
        limb->joint[i].gap_rad = manner->gap_rad[i];
        limb->joint[i].zero_offset_rad = dice_between(&dice, -0.02f, 0.02f);
        p.drive[i].torque_range_n_mm = 10000.0f;
        p.drive[i].torque_noise_n_mm = dice_between(&dice, 10.0f, 100.0f);
        p.drive[i].torque_bias_n_mm = 10.0f;
        p.drive[i].motor_friction_n_mm = dice_between(&dice, 0.0f, 60.0f);
        p.drive[i].motor_friction_tolerance_ratio = 0.2f;
        p.drive[i].motor_friction_per_torque_ratio = 0.3f;
        p.drive[i].motor_friction_per_load_ratio = 0.1f;
        p.drive[i].angle_step_rad = 1e-5f;
        p.drive[i].takeup_torque_n_mm = 5000.0f;
        p.drive[i].angle_min_rad = -3.0f;
        p.drive[i].angle_max_rad = 3.0f;
        p.drive[i].coulomb_n_mm = dice_between(&dice, 0.0f, 50.0f);
    }
    const bool plain = dice_in(&dice, 2); /* what most limbs are: no spring that changes, a firm base */
    if (!plain && dice_in(&dice, 2)) { /* a base that yields, mostly unequally: the general path */
        limb->base.x_mm_per_n = dice_between(&dice, 0.0f, 0.05f);
        limb->base.z_mm_per_n = dice_in(&dice, 3) ? limb->base.x_mm_per_n : dice_between(&dice, 0.0f, 0.05f);
        limb->base.rotation_rad_per_n_mm = dice_between(&dice, 0.0f, 5e-6f);
    }
    p.slow.joint_compliance_per_degc = !plain && dice_in(&dice, 2) ? 0.004f : 0.0f;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        p.drive[i].hardening_n_mm_per_rad3 = !plain && dice_in(&dice, 2) ? dice_between(&dice, 1e6f, 1e9f) : 0.0f;
    }
    p.gravity.femur_n = dice_between(&dice, 0.0f, 10.0f);
    p.gravity.tibia_n = dice_between(&dice, 0.0f, 10.0f);
    p.gravity.knee_n = dice_between(&dice, 0.0f, 10.0f);
    p.sensor.noise_n = 0.05f;
    p.sensor.rotation_rad = dice_between(&dice, -0.1f, 0.1f);
    p.controller.node_id = dice_below(&dice, 128);
    p.controller.tick_us = 1000;
    return p;
}

static void begin_episode(bool tests)
{
    world_manner_t manner = {.cooperative = dice_in(&dice, 2),
                             .restless = dice_in(&dice, 2),
                             .drives_fail = dice_in(&dice, 4),
                             .slcan = dice_in(&dice, 3) || flooded,
                             .flooded = flooded,
                             .coxa = dice_in(&dice, 3),
                             .spring_n_mm_per_rad = dice_between(&dice, 2e4f, 1e5f)};
    static const uint32_t bad_in[] = {0, 1000, 50, 5};
    manner.bad_in = bad_in[dice_below(&dice, manner.cooperative ? 2 : 4)];
    if (tests) {
        manner.cooperative = true;
        manner.restless = manner.drives_fail = false;
        manner.bad_in = 0;
    }
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        manner.gap_rad[i] = dice_in(&dice, 3) ? 0.0f : dice_between(&dice, 0.002f, 0.025f);
    }
    const brace_parameters_t p = random_parameters(&manner);
    static brace_store_t store;
    brace_parameters_t before;
    world_erase();
    (void)brace_store_start(&store, &world_door, &before);
    if (!dice_in(&dice, 10) && brace_store_begin(&store, &p, NULL) == BRACE_OK) {
        while (brace_store_step(&store) == BRACE_STORE_BUSY) {
        }
    }
    world_begin(&dice, &manner);
    upload.next = 0;
    (void)brace_app_start(&app, &world_door);
}

static brace_loading_setup_t random_setup(void)
{
    return (brace_loading_setup_t){.axis = dice_in(&dice, 2) ? BRACE_AXIS_X : BRACE_AXIS_Z,
                                   .steps_per_side = 2 + dice_below(&dice, 4),
                                   .step_mm = dice_between(&dice, 0.1f, 0.7f),
                                   .dwell_us = 20000,
                                   .rate_mm_per_s = 100.0f,
                                   .force_max_n = dice_in(&dice, 5) ? 0.1f : 1000.0f,
                                   .torque_max_n_mm = 8000.0f,
                                   .source = dice_in(&dice, 4) ? BRACE_LOADING_COMMANDED : BRACE_LOADING_ENCODED};
}

static void random_request(void)
{
    const brace_loading_setup_t setup = random_setup();
    switch (dice_below(&dice, 16)) {
    case 0:
    case 1:
    case 2: (void)brace_app_take_up(&app, BRACE_FEMUR, dice_in(&dice, 2) ? 1 : -1); break;
    case 3:
    case 4: (void)brace_app_take_up(&app, BRACE_COXA, dice_in(&dice, 2) ? 1 : -1); break;
    case 5: (void)brace_app_take_up(&app, BRACE_TIBIA, dice_in(&dice, 2) ? 1 : -1); break;
    case 6: (void)brace_app_let_go(&app); break;
    case 7:
    case 8:
    case 9:
    case 10: (void)brace_app_loading_start(&app, &setup); break;
    case 11: (void)(dice_in(&dice, 8) ? brace_app_loading_stop(&app) : 0); break;
    case 12:
        (void)brace_app_clear(&app, BRACE_FAULT_MODEL_DRIFT | BRACE_FAULT_CRASHED);
        /* As if the state of the check had changed: a record is due. */
        app.controller.drift.kept_state = (uint8_t)dice_below(&dice, 4);
        break;
    case 13: (void)(dice_in(&dice, 4) ? brace_app_configuration_enter(&app) : 0); break;
    default: (void)(dice_in(&dice, 2) ? brace_app_configuration_leave(&app) : 0); break;
    }
    if (app.controller.mode.now == BRACE_MODE_CONFIGURATION && dice_in(&dice, 3)) {
        const brace_parameters_t p = random_parameters(&(world_manner_t){.gap_rad = {0.01f, 0.01f, 0.005f}});
        (void)(dice_in(&dice, 3) ? brace_app_parameters_rollback(&app) : brace_app_parameters_commit(&app, &p));
    }
}

static void begin_upload(void)
{
    brace_parameters_t p = random_parameters(&(world_manner_t){.gap_rad = {0.01f, 0.01f, 0.005f}});
    (void)brace_parameters_pack(&p, 1, upload.block, sizeof upload.block);
    if (dice_in(&dice, 4)) { /* one that is refused: sealed all the same */
        p.limb.femur_mm = -1.0f;
        brace_block_compose(&p, 1, upload.block);
        const uint32_t crc = brace_crc32(0, upload.block, BRACE_BLOCK_BYTES - 4);
        for (uint32_t i = 0; i < 4u; i++) {
            upload.block[BRACE_BLOCK_BYTES - 4 + i] = (uint8_t)(crc >> (8u * i));
        }
    }
    upload.next = 1;
}

/* The next request of a block that is uploaded whole. */
static void upload_on(void)
{
    const uint8_t *crc = upload.block + BRACE_BLOCK_BYTES - 4, *word = upload.block + 4u * (upload.next - 2u);
    uint8_t data[8] = {BRACE_REQUEST_UPLOAD_BEGIN,
                       (uint8_t)upload.next,
                       (uint8_t)BRACE_BLOCK_BYTES,
                       (uint8_t)(BRACE_BLOCK_BYTES >> 8),
                       crc[0],
                       crc[1],
                       crc[2],
                       crc[3]};
    if (upload.next > 1u + BRACE_BLOCK_BYTES / 4u) {
        data[0] = BRACE_REQUEST_COMMIT;
        for (uint32_t i = 0; i < 4u; i++) {
            data[2u + i] = crc[i];
        }
        upload.next = 0;
    } else if (upload.next > 1u) {
        data[0] = BRACE_REQUEST_UPLOAD_WORD;
        data[2] = (uint8_t)(upload.next - 2u);
        data[3] = (uint8_t)((upload.next - 2u) >> 8);
        for (uint32_t i = 0; i < 4u; i++) {
            data[4u + i] = word[i];
        }
    }
    upload.next += upload.next > 0u;
    world_asks(app.wires.can.node_id, data);
}

/* A request over CAN: of every code, mostly with sense in it. */
static void random_question(bool harmless)
{
    static const uint8_t questions[] = {BRACE_REQUEST_K_AT_POSTURE,
                                        BRACE_REQUEST_K_AT_TIP_KNEE_UP,
                                        BRACE_REQUEST_K_AT_TIP_KNEE_DOWN,
                                        BRACE_REQUEST_TIP_FORCE,
                                        BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE,
                                        BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP,
                                        BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN,
                                        BRACE_REQUEST_TIP_FORCE_IN_SPACE,
                                        BRACE_REQUEST_K_IN_SPACE_AT_POSTURE};
    static const uint32_t question_count = sizeof questions / sizeof *questions;
    uint8_t data[8];
    for (int i = 0; i < 8; i++) {
        data[i] = (uint8_t)dice_below(&dice, 256);
    }
    const uint32_t code = harmless             ? 1u + dice_below(&dice, 8)
                          : dice_in(&dice, 20) ? dice_below(&dice, 256)
                          : dice_in(&dice, 2)  ? questions[dice_below(&dice, question_count)]
                                               : 1u + dice_below(&dice, BRACE_REQUEST_CODE_MOST);
    const uint32_t token = data[1];
    data[0] = (uint8_t)code;
    if (code == BRACE_REQUEST_K_AT_POSTURE || code == BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE) {
        (void)brace_can_pack_k_at_posture_request(&(brace_can_k_at_posture_request_t){token,
                                                                                      dice_between(&dice, -3.0f, 3.0f),
                                                                                      dice_between(&dice, -3.0f, 3.0f)},
                                                  data);
        data[0] = (uint8_t)code;
    } else if (code == BRACE_REQUEST_TIP_FORCE) {
        data[4] = data[7] = (uint8_t)(dice_in(&dice, 2) ? 0 : 255); /* some ten newtons */
        data[3] &= 0x3fu;
        data[6] &= 0x3fu;
    } else if (code == BRACE_REQUEST_TIP_FORCE_IN_SPACE) {
        (void)brace_can_pack_tip_force_in_space_request(
            &(brace_can_tip_force_in_space_request_t){token, dice_between(&dice, -20.0f, 20.0f),
                                                      dice_between(&dice, -20.0f, 20.0f),
                                                      dice_between(&dice, -20.0f, 20.0f)},
            data);
    } else if (code == BRACE_REQUEST_K_AT_TIP_KNEE_UP || code == BRACE_REQUEST_K_AT_TIP_KNEE_DOWN ||
               code == BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_UP ||
               code == BRACE_REQUEST_K_UNDER_LOAD_AT_TIP_KNEE_DOWN) {
        (void)brace_can_pack_k_at_tip_knee_up_request(
            &(brace_can_k_at_tip_knee_up_request_t){token, dice_between(&dice, -300.0f, 300.0f),
                                                    dice_between(&dice, -300.0f, 300.0f)},
            data);
        data[0] = (uint8_t)code;
    } else if (code == BRACE_REQUEST_READ_ENTRY && !dice_in(&dice, 10)) {
        const uint32_t entry = dice_in(&dice, 4) ? dice_below(&dice, BRACE_PARAMETER_COUNT)
                                                 : BRACE_ENTRY_MEASURED + dice_below(&dice, BRACE_MEASURED_COUNT);
        data[2] = (uint8_t)entry;
        data[3] = (uint8_t)(entry >> 8);
    } else if (code == BRACE_REQUEST_CONTACT_FORCE || code == BRACE_REQUEST_SAG_FOR_LOAD) {
        data[4] = data[7] = 0;
    } else if (code == BRACE_REQUEST_FRICTION_MARGIN) {
        data[3] &= 0x3fu;
        data[5] = 2;
    } else if (code == BRACE_REQUEST_FETCH_ROW) {
        data[3] = 0;
        data[4] = (uint8_t)dice_below(&dice, 16);
    } else if (code == BRACE_REQUEST_WRITE_ENTRY || code == BRACE_REQUEST_DOWNLOAD_WORD) {
        data[2] = (uint8_t)dice_below(&dice, BRACE_PARAMETER_COUNT + 2u);
        data[3] = 0;
    } else if (code == BRACE_REQUEST_COMMIT) {
        data[2] = data[3] = data[4] = data[5] = 0;
    }
    world_asks(app.wires.can.node_id, data);
}

/* What the coming tick is, in its plane. */
static char kind_in_plane(const controller_t *c)
{
    if (flooded) {
        return 'Q';
    }
    const bool keeps = c->drift.looks && c->drift.ticks_to_write <= 1u && !c->drift.has_reading && !c->drift.reports;
    switch (c->mode.now) {
    case BRACE_MODE_START: return 'A';
    case BRACE_MODE_MONITOR: return keeps ? 'W' : 'M';
    case BRACE_MODE_TAKING_UP: return 'T';
    case BRACE_MODE_FAULT: return 'F';
    case BRACE_MODE_CONFIGURATION: return parameter_job_is_busy(&c->parameters) ? 'S' : 'C';
    default: break;
    }
    return c->drift.has_reading                  ? 'R'
           : c->loading.phase == LOADING_JUDGE   ? 'J'
           : c->loading.phase == LOADING_COMPARE ? 'K'
                                                 : 'L';
}

static char kind(void)
{
    const controller_t *c = &app.controller;
    const char letter = kind_in_plane(c);
    return c->model.is_spatial ? (char)(letter + ('a' - 'A')) : letter;
}

int main(void)
{
    static char line[LINE + 1];
    bool tests = false;
    for (uint32_t tick = 0; tick < TICKS; tick++) {
        if (tick % EPISODE_TICKS == 0) {
            flooded = dice_in(&dice, 4);
            tests = dice_in(&dice, 6); /* nothing but loading tests, and nobody who stops them */
            begin_episode(tests);
        }
        world_now_us += dice_in(&dice, 2000) ? 1000u + dice_below(&dice, 30000) : 1000u;
        world_step(&dice);
        if (tests && dice_in(&dice, 20)) {
            const brace_loading_setup_t setup = random_setup();
            (void)brace_app_loading_start(&app, &setup);
        } else if (upload.next == 0u && !tests && dice_in(&dice, 20)) {
            random_request();
            const bool may_write = app.controller.mode.now == BRACE_MODE_CONFIGURATION &&
                                   !parameter_job_is_busy(&app.controller.parameters);
            if (may_write && app.wires.can.node_id != 0u && dice_in(&dice, 8)) {
                begin_upload();
            }
        }
        if (upload.next > 0u) {
            if (tick % 3u == 0u) { /* so that the answers go out in between */
                upload_on();
            }
        } else if (flooded || dice_in(&dice, 3)) {
            random_question(tests);
        }
        if (flooded) {
            random_question(tests); /* the first went out as text, this one over CAN */
        }
        line[tick % LINE] = kind();
        brace_app_tick(&app, world_now_us);
        if (tick % LINE == LINE - 1) {
            puts(line);
        }
    }
    return 0;
}
