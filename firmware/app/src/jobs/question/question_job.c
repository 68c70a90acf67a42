#include "jobs/question/question_job.h"

#include <stddef.h>
#include <string.h>

#include "brace/words.h"

#define PATIENCE_TICKS 6u /* whoever waits asks again in each tick */
#define STEPS_IN_A_ROW 8u /* as four questions take in the plane; then other jobs have a tick */

enum { NONE = 0, TAKEN, DONE };

_Static_assert(sizeof(brace_k_question_t) == 10u * 4u, "no bytes between the members: they are compared as words");

static bool is_under_way(const question_job_t *job)
{
    return job->work.is_under_way || job->is_to_turn;
}

static void drop(question_job_t *job)
{
    job->work.is_under_way = job->is_to_turn = false;
}

static bool is_same(const brace_k_question_t *a, const brace_k_question_t *b)
{
    bool same = true;
    for (uint32_t i = 0; i < sizeof *a / 4u; i++) {
        same = same && brace_word_at(a, i) == brace_word_at(b, i);
    }
    return same;
}

int32_t question_job_ask(question_job_t *job, brace_asker_t asker, const brace_k_question_t *question,
                         brace_k_answer_t *answer)
{
    question_slot_t *slot = &job->slot[asker];
    slot->ticks_unasked = 0;
    if (slot->phase == NONE || !is_same(&slot->question, question)) {
        if (asker == (brace_asker_t)job->answered) {
            drop(job);
        }
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

bool question_job_is_coming(question_job_t *job, brace_asker_t asker)
{
    question_slot_t *slot = &job->slot[asker];
    const bool is_coming = slot->phase == TAKEN;
    slot->ticks_unasked = is_coming ? 0u : slot->ticks_unasked;
    return is_coming;
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
        return brace_kinematics_inverse(limb, asked->tip, (brace_knee_t)asked->knee, &unbent_rad[BRACE_FEMUR],
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
           (inputs->is_calibrated ? 0u : (uint32_t)BRACE_FLAG_UNCALIBRATED);
}

/* The first step. What the posture says goes into the answer's flags. */
static int32_t begin(question_job_t *job, const brace_k_question_t *asked, const question_inputs_t *inputs)
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
    job->flags = flags_there(inputs, unbent_rad);
    const brace_vec3_t tip_n = {asked->tip_force.x_n, asked->force_across_n, asked->tip_force.z_n};
    return model_loaded_begin(inputs->model, unbent_rad, springs, tip_n, inputs->down, &job->work);
}

/* The last step of a K in space: from the limb's plane's frame into the robot's. */
static brace_status_t turn(question_job_t *job, const brace_k_question_t *asked)
{
    const brace_status_t status =
        brace_loaded_space_turn(asked->theta_rad[BRACE_COXA], &job->space, &job->answer.in_space);
    job->answer.in_space.flags |= job->answer.k.flags;
    job->is_to_turn = false;
    return status;
}

static int32_t work_out(question_job_t *job, const brace_k_question_t *asked, const question_inputs_t *inputs)
{
    if (job->is_to_turn) {
        return turn(job, asked);
    }
    model_rest_t rest;
    const int32_t status = job->work.is_under_way
                               ? model_loaded_go_on(inputs->model, &inputs->parameters->limb, &job->work, &rest)
                               : begin(job, asked, inputs);
    if (status != BRACE_OK) {
        return status;
    }
    job->answer.k = rest.plane;
    job->answer.k.flags |= job->flags;
    job->answer.moved_mm = (brace_displacement_t){rest.bend.tip_mm.x, rest.bend.tip_mm.z};
    job->answer.moved_across_mm = rest.moved_across_mm;
    job->answer.buckling_factor = rest.buckling_factor;
    job->space = rest.space;
    job->is_to_turn = asked->where == BRACE_K_IN_SPACE;
    return job->is_to_turn ? (int32_t)MODEL_LATER : BRACE_OK;
}

/* The slot that is worked out next: the one whose K is under way, else the first one behind the last that is taken.
 * returns null: none */
static question_slot_t *next_slot(question_job_t *job)
{
    if (is_under_way(job) && job->slot[job->answered].phase == TAKEN) {
        return &job->slot[job->answered];
    }
    drop(job);
    for (uint32_t i = 1; i <= (uint32_t)BRACE_ASKER_COUNT; i++) {
        const uint32_t asker = (job->answered + i) % (uint32_t)BRACE_ASKER_COUNT;
        if (job->slot[asker].phase == TAKEN) {
            job->answered = (uint8_t)asker;
            return &job->slot[asker];
        }
    }
    return NULL;
}

/* The answer before goes, if nobody has taken it. */
static void forget_answer(question_job_t *job)
{
    for (uint32_t i = 0; i < (uint32_t)BRACE_ASKER_COUNT; i++) {
        job->slot[i].phase = job->slot[i].phase == DONE ? (uint8_t)NONE : job->slot[i].phase;
    }
}

void question_job_age(question_job_t *job)
{
    for (uint32_t i = 0; i < (uint32_t)BRACE_ASKER_COUNT; i++) {
        question_slot_t *slot = &job->slot[i];
        slot->ticks_unasked++;
        slot->phase = slot->ticks_unasked > PATIENCE_TICKS ? (uint8_t)NONE : slot->phase;
    }
}

static void finish(question_job_t *job, question_slot_t *slot, brace_status_t status)
{
    forget_answer(job);
    job->status = status;
    slot->phase = DONE;
}

bool question_job_work(question_job_t *job, const question_inputs_t *inputs, uint32_t steps_most)
{
    int32_t status = MODEL_LATER;
    bool has_worked = false;
    /* One step, or at most two. None follows an answer: its asker takes it in the next tick, before another one's takes
     * its place. */
    for (uint32_t i = 0; i < steps_most && status == MODEL_LATER; i++) {
        const bool may_begin = job->steps_in_a_row < STEPS_IN_A_ROW;
        question_slot_t *slot = may_begin || is_under_way(job) ? next_slot(job) : NULL;
        if (slot == NULL) {
            break;
        }
        status = work_out(job, &slot->question, inputs);
        if (status != MODEL_LATER) {
            finish(job, slot, (brace_status_t)status);
        }
        job->steps_in_a_row++;
        has_worked = true;
    }
    job->steps_in_a_row = has_worked ? job->steps_in_a_row : 0u;
    return has_worked;
}
