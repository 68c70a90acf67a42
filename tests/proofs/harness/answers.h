/* What the rest of the controller tells a request, over CAN or Modbus: anything that the header in question allows. */
#ifndef BRACE_PROOF_ANSWERS_H
#define BRACE_PROOF_ANSWERS_H

#include "configure/staging.h"
#include "configure/storing.h"
#include "measure/hypothetical.h"
#include "measure/questions.h"
#include "proof.h"

static brace_status_t any_status(void)
{
    const int32_t status = any_i32();
    ASSUME(status <= 0 && status >= BRACE_E_MODE);
    return (brace_status_t)status;
}

uint32_t staging_read(const brace_app_t *app, uint32_t index)
{
    (void)app;
    PROVE(index < BRACE_PARAMETER_COUNT, "a member that there is");
    return any_u32();
}

bool storing_busy(const brace_app_t *app) { (void)app; return any_bool(); }

void brace_store_status(const brace_store_t *store, brace_store_status_t *status)
{
    (void)store;
    brace_store_status_t any;
    *status = any;
}

static brace_snapshot_t snapshot;
const brace_snapshot_t *brace_app_snapshot(const brace_app_t *app) { (void)app; return &snapshot; }

brace_status_t hypothetical_stiffness(brace_app_t *app, float theta1_rad, float theta2_rad,
                                      brace_stiffness_t *stiffness)
{
    (void)app;
    (void)theta1_rad;
    (void)theta2_rad;
    brace_stiffness_t any;
    *stiffness = any;
    return any_status();
}

brace_status_t question_k_at_tip(brace_app_t *app, brace_point_t tip, brace_knee_t knee, brace_stiffness_t *stiffness)
{
    PROVE(knee == BRACE_KNEE_UP || knee == BRACE_KNEE_DOWN, "a knee that there is");
    return hypothetical_stiffness(app, tip.x_mm, tip.z_mm, stiffness);
}

brace_status_t question_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                      brace_contact_force_t *contact)
{
    (void)app;
    (void)displacement;
    brace_contact_force_t any;
    *contact = any;
    return any_status();
}

brace_status_t question_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag)
{
    (void)app;
    (void)load;
    brace_displacement_t any;
    *sag = any;
    return any_status();
}

brace_status_t question_grip(const brace_app_t *app, float normal_rad, float friction_ratio, brace_contact_grip_t *grip)
{
    (void)app;
    (void)normal_rad;
    (void)friction_ratio;
    brace_contact_grip_t any;
    *grip = any;
    return any_status();
}

#endif
