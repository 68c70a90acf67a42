/* Questions for K where the limb is not: one at a time, each asker in its turn.
 *
 * K under a load costs a fifth of the instructions that a tick may take, and in space a third. So the tick that takes a
 * question does not compute K; the job computes it in steps in the next ticks: two in the plane, nine in space. The
 * port that asks repeats its question in every tick until it gets the answer. A port that stops asking loses its place.
 * Other jobs give way, and have a tick for themselves after eight steps.
 */
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
    uint8_t steps_in_a_row; /* since another job has had a step */
    model_work_t work;
    bool is_to_turn;        /* `space` is there and has still to be turned into the robot's frame */
    brace_k3_t space;       /* K in the limb's plane's frame */
    uint32_t flags;         /* that posture and parameters give it */
    brace_status_t status;  /* how that ended */
    brace_k_answer_t answer;
} question_job_t;

/* What a step is given. */
typedef struct {
    model_t *model;
    const brace_parameters_t *parameters;
    bool is_calibrated; /* the parameters are of this limb as it was measured last */
    const joints_t *joints;    /* for their temperatures */
    brace_vec3_t down;
} question_inputs_t;

/* Asks, or asks again.
 * returns BRACE_APP_LATER, or how it ended: BRACE_OK with the answer, else why not */
int32_t question_job_ask(question_job_t *job, brace_asker_t asker, const brace_k_question_t *question,
                         brace_k_answer_t *answer);

/* Is the asker's question still being worked out? This keeps its place, as to ask again does. */
bool question_job_is_coming(question_job_t *job, brace_asker_t asker);

/* A tick passes: a question that is asked no longer is forgotten. */
void question_job_age(question_job_t *job);

/* Steps of what has been asked, at most so many [1, 2]. returns whether there was one. At most 1,900 instructions each,
 * in space 1,300. */
bool question_job_work(question_job_t *job, const question_inputs_t *inputs, uint32_t steps_most);

/* What was asked is forgotten, because it belongs to parameters that are in force no longer; who asks again begins
 * anew. */
void question_job_forget(question_job_t *job);

#endif
