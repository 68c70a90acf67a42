#include "stiffness/softening.h"

#define EVERY_TICKS 2u
#define STEPS_A_ROUND 4u  /* K without load, and three of the search */
#define PATIENCE_TICKS 7u /* in which requests go first */
#define FACTOR_AGE_TICKS_MOST 240u /* two searches, and ticks in which requests or other jobs went first */

static void forget_unloaded(softening_t *softening)
{
    const float unknown = __builtin_nanf("");
    softening->unloaded = (brace_stiffness_t){unknown, unknown, unknown, unknown, unknown, unknown, 0u};
    softening->unloaded_across_n_per_mm = unknown;
}

void softening_start(softening_t *softening)
{
    *softening = (softening_t){.ticks_since_step = EVERY_TICKS - 1u, .factor = __builtin_nanf("")};
    forget_unloaded(softening);
}

static void grow_old(softening_t *softening, bool is_counted)
{
    if (softening->factor_age_ticks < FACTOR_AGE_TICKS_MOST) {
        softening->factor_age_ticks++;
    }
    if (!is_counted || softening->factor_age_ticks >= FACTOR_AGE_TICKS_MOST) {
        softening->factor = __builtin_nanf("");
    }
}

static void find_unloaded(softening_t *softening, model_t *model, const brace_limb_t *limb,
                          const float unbent_rad[BRACE_LINK_COUNT])
{
    if (model_stiffness(model, limb, unbent_rad[BRACE_FEMUR], unbent_rad[BRACE_TIBIA], softening->now.springs,
                        &softening->unloaded, &softening->unloaded_across_n_per_mm) != BRACE_OK) {
        forget_unloaded(softening);
    }
}

void softening_age(softening_t *softening, bool is_counted)
{
    grow_old(softening, is_counted);
    softening->runs = softening->runs && is_counted;
    softening->is_needed = is_counted;
    if (softening->ticks_since_step < UINT8_MAX) {
        softening->ticks_since_step++;
    }
}

bool softening_is_due(const softening_t *softening)
{
    return softening->is_needed && softening->ticks_since_step % EVERY_TICKS == 0u;
}

bool softening_is_overdue(const softening_t *softening)
{
    return softening->is_needed && softening->ticks_since_step >= EVERY_TICKS + PATIENCE_TICKS;
}

void softening_work(softening_t *softening, model_t *model, const brace_limb_t *limb,
                    const float unbent_rad[BRACE_LINK_COUNT])
{
    softening->ticks_since_step = 0;
    const bool is_rounds_first = softening->step_of_round == 0u;
    softening->step_of_round = (uint8_t)((softening->step_of_round + 1u) % STEPS_A_ROUND);
    if (is_rounds_first) {
        find_unloaded(softening, model, limb, unbent_rad);
    } else if (!softening->runs) {
        softening->runs = true;
        brace_loaded_space_buckling_begin(&model->loaded_space, &softening->now.at.space, &softening->shape,
                                          &softening->search);
    } else if (brace_loaded_space_buckling_step(&model->loaded_space, &softening->shape, &softening->search,
                                                &softening->factor)) {
        softening->runs = false;
        softening->factor_age_ticks = 0;
    }
}

uint32_t softening_flags(const softening_t *softening)
{
    const float factor = softening->factor;
    return factor == factor ? brace_loaded_flags(factor, 0.0f, 1.0f) : 0u;
}
