/* Questions for K where the limb is not: one at a time, in every other tick, each asker in its turn.
 *
 * K under a load costs a fifth of the instructions that a tick may take, and more in space. So the tick that takes a
 * question does not compute K; the job computes it in the next tick, for a limb in space in the next two. The port
 * that asks repeats its question in every tick until it gets the answer. A port that stops asking loses its place. A
 * tick in which the job computes K leaves all requests and process data to the next tick (wire/wire.h), and in that
 * next tick the job begins no K. Other jobs' dear steps give way, so four ports that ask at once all have their answers
 * within eight ticks; of a limb in space within twelve, and two more while the buckling factor is searched. A loading
 * test that works out its levers at the same time adds one tick, in space two.
 *
 * In space eight ticks are too few for four: a question takes 7,000 instructions and its answer 1,000 to 1,500, and a
 * tick of 16,000 leaves 3,700 of them where all else costs most. */
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
    model_work_t work;      /* of a limb in space, whose K takes two steps */
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
    bool may_work;             /* no job has worked out a K in the tick before */
} question_inputs_t;

/* Asks, or asks again.
 * returns BRACE_APP_LATER, or how it ended: BRACE_OK with the answer, else why not */
int32_t question_job_ask(question_job_t *job, brace_asker_t asker, const brace_k_question_t *question,
                         brace_k_answer_t *answer);

/* Works out what has been asked, if it may. At most 3,200 instructions; of a limb in space 4,600. */
void question_job_step(question_job_t *job, const question_inputs_t *inputs);

/* What was asked is forgotten, because it belongs to parameters that are in force no longer; who asks again begins
 * anew. */
void question_job_forget(question_job_t *job);

#endif
