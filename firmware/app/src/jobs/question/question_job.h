/* Questions for K where the limb is not: one at a time, each asker in its turn.
 *
 * K under a load costs a fifth of the instructions that a tick may take, and more in space. So the tick that takes a
 * question does not compute K; the job computes it in two steps, in the next two ticks. The port that asks repeats its
 * question in every tick until it gets the answer. A port that stops asking loses its place. Other jobs' dear steps
 * give way, and have a tick for themselves now and then. So four ports that ask at once all have their answers within
 * eight ticks, and a tick that works on a K answers requests beside it (wire/wires.h).
 *
 * In space a tick that works out half of a K has no room for requests: they wait for the next tick, and between two K
 * the job leaves a tick to them. So four ports have their answers within twelve ticks, two more while the buckling
 * factor is searched, and one more where process data have waited for long: a question takes 7,000 instructions and its
 * answer 1,000 to 1,500, and a tick of 16,000 leaves 3,700 of them where all else costs most. */
#ifndef BRACE_JOBS_QUESTION_QUESTION_JOB_H
#define BRACE_JOBS_QUESTION_QUESTION_JOB_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/k_question.h"
#include "brace/parameters.h"
#include "posture/posture.h"
#include "sense/joints.h"
#include "stiffness/model.h"

/* The question of one asker. */
typedef struct {
    uint8_t phase;
    uint8_t ticks_unasked; /* since it was asked again */
    brace_k_question_t question;
} question_slot_t;

typedef struct {
    question_slot_t slot[BRACE_ASKER_COUNT];
    uint8_t answered;       /* the asker whose question was worked out last */
    bool has_worked;        /* in this tick */
    uint8_t ticks_in_a_row; /* in which it has worked */
    model_work_t work;
    uint32_t flags;         /* that posture and parameters give it */
    brace_status_t status;  /* how that ended */
    brace_k_answer_t answer;
} question_job_t;

/* What a step is given. */
typedef struct {
    model_t *model;
    const brace_parameters_t *parameters;
    brace_parameter_origin_t origin;
    const joints_t *joints;    /* for their temperatures */
    brace_vec3_t down;
    bool may_work;
    bool may_begin;            /* another K */
} question_inputs_t;

/* Asks, or asks again.
 * returns BRACE_APP_LATER, or how it ended: BRACE_OK with the answer, else why not */
int32_t question_job_ask(question_job_t *job, brace_asker_t asker, const brace_k_question_t *question,
                         brace_k_answer_t *answer);

/* Does somebody wait for a K? */
bool question_job_is_asked(const question_job_t *job);

/* One step of what has been asked, if it may. At most 1,900 instructions; of a limb in space 4,000. */
void question_job_step(question_job_t *job, const question_inputs_t *inputs);

/* What was asked is forgotten, because it belongs to parameters that are in force no longer; who asks again begins
 * anew. */
void question_job_forget(question_job_t *job);

#endif
