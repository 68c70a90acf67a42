#include "jobs/question/question_job.h"

#include <stddef.h>
#include <string.h>

#define PATIENCE_TICKS 6u /* nobody asks in a tick of a dear step, and two of them may follow one another */

enum { NONE = 0, TAKEN, DONE };

int32_t question_job_ask(question_job_t *job, brace_asker_t asker, const brace_k_question_t *question,
                         brace_k_answer_t *answer)
{
    question_slot_t *slot = &job->slot[asker];
    slot->ticks_unasked = 0;
    if (slot->phase == NONE || memcmp(&slot->question, question, sizeof *question) != 0) {
        slot->phase = TAKEN;
        slot->question = *question;
    }
    if (slot->phase == TAKEN) {
        return BRACE_APP_LATER;
    }
    slot->phase = NONE;
    if (job->status == BRACE_OK) {
        *answer = job->answer;
    }
    return job->status;
}

void question_job_forget(question_job_t *job)
{
    memset(job->slot, 0, sizeof job->slot);
}

static brace_status_t find_posture(const brace_k_question_t *asked, const brace_limb_t *limb,
                                   float unbent_rad[BRACE_LINK_COUNT])
{
    if (asked->where == BRACE_K_AT_TIP) {
        unbent_rad[BRACE_COXA] = 0.0f;
        return brace_kinematics_inverse(limb, asked->tip, asked->knee, &unbent_rad[BRACE_FEMUR],
                                        &unbent_rad[BRACE_TIBIA]);
    }
    memcpy(unbent_rad, asked->theta_rad, sizeof asked->theta_rad);
    return BRACE_OK;
}

/* Flags that posture and parameters give. */
static uint32_t flags_there(const question_inputs_t *inputs, const float unbent_rad[BRACE_LINK_COUNT])
{
    const brace_drive_t *drive = inputs->parameters->drive;
    const bool inside = posture_is_inside_travel(&drive[BRACE_FEMUR], unbent_rad[BRACE_FEMUR]) &&
                        posture_is_inside_travel(&drive[BRACE_TIBIA], unbent_rad[BRACE_TIBIA]);
    return (inside ? 0u : (uint32_t)BRACE_FLAG_OUT_OF_RANGE) |
           (inputs->origin == BRACE_PARAMETERS_DEFAULT ? (uint32_t)BRACE_FLAG_UNCALIBRATED : 0u);
}

static brace_status_t under_load(const brace_k_question_t *asked, const question_inputs_t *inputs,
                                 const float *unbent_rad, const brace_loaded_joint_t *springs, brace_k_answer_t *answer)
{
    brace_loaded_stiffness_t loaded;
    float joint_turn_rad[BRACE_LINK_COUNT];
    const brace_status_t status = model_loaded(inputs->model, &inputs->parameters->limb, unbent_rad, springs,
                                               asked->tip_force, inputs->down, &loaded, joint_turn_rad);
    if (status == BRACE_OK) {
        answer->k = loaded.stiffness;
        answer->k.flags |= flags_there(inputs, unbent_rad);
        answer->moved_mm = loaded.displacement;
        answer->buckling_factor = loaded.buckling_factor;
    }
    return status;
}

static brace_status_t without_load(const brace_k_question_t *asked, const question_inputs_t *inputs,
                                   const float *unbent_rad, const brace_loaded_joint_t *springs,
                                   brace_k_answer_t *answer)
{
    const float unknown = __builtin_nanf("");
    float across_n_per_mm;
    const brace_status_t status = model_stiffness(inputs->model, inputs->parameters, unbent_rad[BRACE_FEMUR],
                                                  unbent_rad[BRACE_TIBIA], springs, &answer->k, &across_n_per_mm);
    if (status != BRACE_OK) {
        return status;
    }
    answer->k.flags |= flags_there(inputs, unbent_rad) | BRACE_FLAG_LOAD_UNKNOWN;
    answer->moved_mm = (brace_displacement_t){unknown, unknown};
    answer->buckling_factor = unknown;
    return asked->where == BRACE_K_IN_SPACE
               ? brace_spatial_turn(unbent_rad[BRACE_COXA], &answer->k, across_n_per_mm, &answer->in_space)
               : BRACE_OK;
}

static brace_status_t work_out(const brace_k_question_t *asked, const question_inputs_t *inputs,
                               brace_k_answer_t *answer)
{
    brace_loaded_joint_t springs[BRACE_LINK_COUNT];
    float temp_degc[BRACE_LINK_COUNT], unbent_rad[BRACE_LINK_COUNT];
    const brace_status_t status = find_posture(asked, &inputs->parameters->limb, unbent_rad);
    if (status != BRACE_OK) {
        return status;
    }
    if (asked->where == BRACE_K_IN_SPACE && !inputs->model->is_spatial) {
        return BRACE_E_UNSUPPORTED;
    }
    joints_temperatures(inputs->joints, temp_degc);
    model_springs_at_rest(inputs->parameters, temp_degc, springs);
    return model_counts_loads(inputs->model) ? under_load(asked, inputs, unbent_rad, springs, answer)
                                             : without_load(asked, inputs, unbent_rad, springs, answer);
}

/* The slot that is worked out next: the first one behind the last that is taken. returns null: none */
static question_slot_t *next_slot(question_job_t *job)
{
    for (uint32_t i = 1; i <= (uint32_t)BRACE_ASKER_COUNT; i++) {
        const uint32_t asker = (job->answered + i) % (uint32_t)BRACE_ASKER_COUNT;
        if (job->slot[asker].phase == TAKEN) {
            job->answered = (uint8_t)asker;
            return &job->slot[asker];
        }
    }
    return NULL;
}

void question_job_step(question_job_t *job, const question_inputs_t *inputs)
{
    question_slot_t *before = &job->slot[job->answered];
    for (uint32_t i = 0; i < (uint32_t)BRACE_ASKER_COUNT; i++) {
        question_slot_t *slot = &job->slot[i];
        slot->ticks_unasked++;
        slot->phase = slot->ticks_unasked > PATIENCE_TICKS ? (uint8_t)NONE : slot->phase;
    }
    question_slot_t *slot = inputs->may_work ? next_slot(job) : NULL;
    job->has_worked = slot != NULL;
    if (slot != NULL) {
        before->phase = before->phase == DONE ? (uint8_t)NONE : before->phase; /* its answer goes */
        job->status = work_out(&slot->question, inputs, &job->answer);
        slot->phase = DONE;
    }
}
