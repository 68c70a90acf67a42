/* Questions of brace/requests.h: K where the limb is not, and what K and force of now mean at the contact. */
#include <stddef.h>

#include "brace/requests.h"
#include "controller.h"

int32_t brace_app_ask_k(brace_app_t *app, brace_asker_t asker, const brace_k_question_t *question,
                        brace_k_answer_t *answer)
{
    return app == NULL || question == NULL || answer == NULL
               ? (int32_t)BRACE_E_NULL
               : question_job_ask(&controller_of(app)->question, asker, question, answer);
}

bool brace_app_k_is_coming(brace_app_t *app, brace_asker_t asker)
{
    return app != NULL && question_job_is_coming(&controller_of(app)->question, asker);
}

brace_status_t brace_app_contact_force(const brace_app_t *app, brace_displacement_t displacement,
                                       brace_contact_force_t *contact)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_force(&now->stiffness.now, displacement, contact) : BRACE_E_MODE;
}

brace_status_t brace_app_sag(const brace_app_t *app, brace_force_t load, brace_displacement_t *sag)
{
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    return now->k_is_valid ? brace_contact_sag(&now->stiffness.now, load, sag) : BRACE_E_MODE;
}

brace_status_t brace_app_grip(const brace_app_t *app, float normal_rad, float friction_ratio,
                              brace_contact_grip_t *grip)
{
    brace_vec_t normal;
    if (app == NULL) {
        return BRACE_E_NULL;
    }
    const brace_snapshot_t *now = brace_app_snapshot(app);
    const brace_force_t force = {now->force_x_n, now->force_z_n};
    const brace_status_t status = brace_kinematics_direction(normal_rad, &normal);
    return status == BRACE_OK ? brace_contact_grip(force, normal.x, normal.z, friction_ratio, grip) : status;
}
