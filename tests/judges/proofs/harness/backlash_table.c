/* For every state, every combination of facts and any time: what the tables say. */
#include "backlash/backlash_table.h"
#include "brace/backlash.h"
#include "proof.h"

int main(void)
{
    const uint32_t state = any_u32(), phase = any_u32(), facts = any_u32(), in_state_us = any_u32();
    ASSUME(state < BRACE_BACKLASH_STATE_COUNT && phase < BRACE_TAKEUP_PHASE_COUNT);
    const bool bad = (facts & FACT_BAD_SAMPLE) != 0u;

    const transition_t *row = transition_find(&backlash_states[state], facts, in_state_us);
    const uint32_t next = row != NULL ? row->to : state;
    PROVE(row == transition_find(&backlash_states[state], facts, in_state_us), "the same facts, the same next state");
    PROVE(next < BRACE_BACKLASH_STATE_COUNT, "the next state is one");
    PROVE(!bad || next == BRACE_BACKLASH_FAULT, "a bad sample leads to FAULT from everywhere");
    PROVE(bad || next != BRACE_BACKLASH_FAULT || state == BRACE_BACKLASH_FAULT, "nothing else does");
    if (state == BRACE_BACKLASH_FAULT && !bad) {
        PROVE(next == (in_state_us >= 20000u ? BRACE_BACKLASH_UNKNOWN : BRACE_BACKLASH_FAULT),
              "FAULT is left after 20 ms of good samples, to UNKNOWN");
    }
    if (state == BRACE_BACKLASH_CROSSING && in_state_us >= 2000000u) {
        PROVE(next != BRACE_BACKLASH_CROSSING, "CROSSING ends within 2 s");
    }
    if (state == BRACE_BACKLASH_TAKING_UP && (in_state_us >= 70000000u || (facts & FACT_NOT_TAKING_UP) != 0u)) {
        PROVE(next != BRACE_BACKLASH_TAKING_UP, "TAKING_UP ends with the take-up, or within 70 s");
    }
    if (next == BRACE_BACKLASH_ENGAGED_POSITIVE && next != state) {
        PROVE((facts & FACT_POSITIVE) != 0u, "the positive flank only where the load says so");
    }
    if (next == BRACE_BACKLASH_ENGAGED_NEGATIVE && next != state) {
        PROVE((facts & FACT_NEGATIVE) != 0u, "the negative flank only where the load says so");
    }

    const transition_t *step = transition_find(&takeup_phases[phase], facts, any_u32());
    const uint32_t then = step != NULL ? step->to : phase;
    const bool at_work = phase != BRACE_TAKEUP_IDLE && phase != BRACE_TAKEUP_LET_GO;
    PROVE(then < BRACE_TAKEUP_PHASE_COUNT, "the next phase is one");
    if (at_work && (bad || (facts & FACT_LET_GO) != 0u)) {
        PROVE(then == BRACE_TAKEUP_LET_GO, "a bad sample and a wish to let go end a take-up in every phase");
    }
    if (at_work && bad && phase != BRACE_TAKEUP_HOLD) {
        PROVE(step->result == BRACE_TAKEUP_E_FAULT, "a bad sample is reported");
    }
    if ((phase == BRACE_TAKEUP_APPROACH || phase == BRACE_TAKEUP_VERIFY) && (facts & FACT_TIME) != 0u) {
        PROVE(then != phase, "a take-up does not outlast its time");
    }
    if (phase == BRACE_TAKEUP_APPROACH && (facts & (FACT_TORQUE | FACT_TRAVEL | FACT_REACH)) != 0u) {
        PROVE(then != BRACE_TAKEUP_APPROACH, "an approach ends at each of its bounds");
    }
    if (then == BRACE_TAKEUP_HOLD && phase != BRACE_TAKEUP_HOLD) {
        PROVE(phase == BRACE_TAKEUP_VERIFY && (facts & FACT_VERIFIED) != 0u && step->result == BRACE_TAKEUP_DONE &&
                  (facts & (FACT_BAD_SAMPLE | FACT_TORQUE | FACT_UNLOADED | FACT_MOVED)) == 0u,
              "HOLD only from VERIFY, verified, with nothing wrong");
    }
    if (then == BRACE_TAKEUP_IDLE && phase != BRACE_TAKEUP_IDLE) {
        PROVE(phase == BRACE_TAKEUP_LET_GO && (facts & FACT_BACK) != 0u, "IDLE only once the command is back");
    }
    if (phase == BRACE_TAKEUP_IDLE && then != BRACE_TAKEUP_IDLE) {
        PROVE((facts & FACT_REQUESTED) != 0u && then == BRACE_TAKEUP_APPROACH, "nothing begins unasked");
    }
    return 0;
}
