/* Written by tools/interface from dictionary.toml; do not edit. */
#include "brace/code_names.h"

#include <stddef.h>

#include "brace/backlash.h"
#include "brace/contact.h"
#include "brace/drift.h"
#include "brace/parameters.h"
#include "brace/status.h"

typedef struct {
    int32_t number;
    const char *name, *text;
} meaning_t;

static const meaning_t *find(const meaning_t *meanings, size_t count, int32_t number)
{
    static const meaning_t unknown = {0, "?", "?"};
    for (size_t i = 0; i < count; i++) { /* the numbers of one table */
        if (meanings[i].number == number) {
            return &meanings[i];
        }
    }
    return &unknown;
}

static const meaning_t mode_meanings[] = {
    {0, "START",
     "The controller has started and waits for sound samples of its joints."},
    {1, "MONITOR",
     "The controller computes K in every tick; others move the limb."},
    {2, "CONFIGURATION",
     "Parameters may be written; nothing moves the limb, and K is not reported."},
    {3, "TAKING_UP",
     "The controller takes up the play of joints, holds it, or lets it go."},
    {4, "LOADING_TEST",
     "The controller runs a loading test."},
    {5, "FAULT",
     "A fault makes every K invalid; the mode ends by itself when the fault is over."},
};

const char *brace_mode_name(int32_t number)
{
    enum { COUNT = sizeof mode_meanings / sizeof *mode_meanings };
    return find(mode_meanings, COUNT, number)->name;
}

const char *brace_mode_text(int32_t number)
{
    enum { COUNT = sizeof mode_meanings / sizeof *mode_meanings };
    return find(mode_meanings, COUNT, number)->text;
}

static const meaning_t setting_meanings[] = {
    {1, "BENCH",
     "Everybody on the buses: for simulators, emulated boards and a board on a desk."},
    {2, "GUARDED",
     "Whoever has the controller's key, one at a time."},
    {3, "NO_KEY",
     "Nobody: the board is guarded and has no key yet."},
};

const char *brace_setting_name(int32_t number)
{
    enum { COUNT = sizeof setting_meanings / sizeof *setting_meanings };
    return find(setting_meanings, COUNT, number)->name;
}

const char *brace_setting_text(int32_t number)
{
    enum { COUNT = sizeof setting_meanings / sizeof *setting_meanings };
    return find(setting_meanings, COUNT, number)->text;
}

static const meaning_t owner_meanings[] = {
    {0, "NONE",
     "No session is open."},
    {1, "PROGRAM",
     "The program around the controller."},
    {2, "CAN",
     "A master on CAN."},
    {3, "SLCAN",
     "The other end of the SLCAN port."},
    {4, "MODBUS_LINE",
     "The master of the Modbus line."},
    {5, "MODBUS_TCP",
     "A master over Modbus TCP."},
};

const char *brace_owner_name(int32_t number)
{
    enum { COUNT = sizeof owner_meanings / sizeof *owner_meanings };
    return find(owner_meanings, COUNT, number)->name;
}

const char *brace_owner_text(int32_t number)
{
    enum { COUNT = sizeof owner_meanings / sizeof *owner_meanings };
    return find(owner_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_BACKLASH_UNKNOWN == (uint32_t)(0), "play");
_Static_assert((uint32_t)BRACE_BACKLASH_TAKING_UP == (uint32_t)(1), "play");
_Static_assert((uint32_t)BRACE_BACKLASH_ENGAGED_POSITIVE == (uint32_t)(2), "play");
_Static_assert((uint32_t)BRACE_BACKLASH_ENGAGED_NEGATIVE == (uint32_t)(3), "play");
_Static_assert((uint32_t)BRACE_BACKLASH_CROSSING == (uint32_t)(4), "play");
_Static_assert((uint32_t)BRACE_BACKLASH_FAULT == (uint32_t)(5), "play");
static const meaning_t play_meanings[] = {
    {0, "UNKNOWN",
     "It is not known which side of the backlash is loaded: no load has shown it, or none for 250 ms."},
    {1, "TAKING_UP",
     "A take-up moves the motor through the gap."},
    {2, "ENGAGED_POSITIVE",
     "The positive side of the backlash is loaded."},
    {3, "ENGAGED_NEGATIVE",
     "The negative side of the backlash is loaded."},
    {4, "CROSSING",
     "The load has left one side of the backlash, and it is not known yet which side comes next."},
    {5, "FAULT",
     "The joint's samples were bad or late."},
};

const char *brace_play_name(int32_t number)
{
    enum { COUNT = sizeof play_meanings / sizeof *play_meanings };
    return find(play_meanings, COUNT, number)->name;
}

const char *brace_play_text(int32_t number)
{
    enum { COUNT = sizeof play_meanings / sizeof *play_meanings };
    return find(play_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_TAKEUP_IDLE == (uint32_t)(0), "take_up_phase");
_Static_assert((uint32_t)BRACE_TAKEUP_APPROACH == (uint32_t)(1), "take_up_phase");
_Static_assert((uint32_t)BRACE_TAKEUP_VERIFY == (uint32_t)(2), "take_up_phase");
_Static_assert((uint32_t)BRACE_TAKEUP_HOLD == (uint32_t)(3), "take_up_phase");
_Static_assert((uint32_t)BRACE_TAKEUP_LET_GO == (uint32_t)(4), "take_up_phase");
static const meaning_t take_up_phase_meanings[] = {
    {0, "IDLE",
     "No take-up is under way."},
    {1, "APPROACH",
     "The command moves the motor to the chosen side of the backlash."},
    {2, "VERIFY",
     "The command stands, and the load has to stay."},
    {3, "HOLD",
     "The chosen side is verified and held loaded: measure now."},
    {4, "LET_GO",
     "The command goes back the way it came."},
};

const char *brace_take_up_phase_name(int32_t number)
{
    enum { COUNT = sizeof take_up_phase_meanings / sizeof *take_up_phase_meanings };
    return find(take_up_phase_meanings, COUNT, number)->name;
}

const char *brace_take_up_phase_text(int32_t number)
{
    enum { COUNT = sizeof take_up_phase_meanings / sizeof *take_up_phase_meanings };
    return find(take_up_phase_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_TAKEUP_NONE == (uint32_t)(0), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_RUNNING == (uint32_t)(1), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_DONE == (uint32_t)(2), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_TORQUE == (uint32_t)(-1), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_TRAVEL == (uint32_t)(-2), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_REACH == (uint32_t)(-3), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_TIME == (uint32_t)(-4), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_VERIFY == (uint32_t)(-5), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_LOST == (uint32_t)(-6), "take_up_outcome");
_Static_assert((uint32_t)BRACE_TAKEUP_E_FAULT == (uint32_t)(-7), "take_up_outcome");
static const meaning_t take_up_outcome_meanings[] = {
    {0, "NONE",
     "Nobody has asked for a take-up since start."},
    {1, "RUNNING",
     "The take-up is under way."},
    {2, "HELD",
     "The chosen side of the backlash is loaded: this was verified."},
    {-1, "TORQUE",
     "The motor's torque passed its bound: the joint is blocked, or its take-up torque is set too low."},
    {-2, "TRAVEL",
     "The motor went further than the gap allows: nothing holds the link, or the gap is larger than believed."},
    {-3, "REACH",
     "The command went to its end and no load came: the motor does not follow its command."},
    {-4, "TIME",
     "The chosen side was not verified as loaded in time: ask again while the limb stands still."},
    {-5, "VERIFY",
     "The load or the motor did not stay while the chosen side was verified: ask again while the limb stands "
     "still."},
    {-6, "LOST",
     "The chosen side was verified as loaded, and later its load went away."},
    {-7, "FAULT",
     "The joint's samples were bad or late during the take-up."},
};

const char *brace_take_up_outcome_name(int32_t number)
{
    enum { COUNT = sizeof take_up_outcome_meanings / sizeof *take_up_outcome_meanings };
    return find(take_up_outcome_meanings, COUNT, number)->name;
}

const char *brace_take_up_outcome_text(int32_t number)
{
    enum { COUNT = sizeof take_up_outcome_meanings / sizeof *take_up_outcome_meanings };
    return find(take_up_outcome_meanings, COUNT, number)->text;
}

static const meaning_t loading_outcome_meanings[] = {
    {0, "NONE",
     "Nobody has asked for a loading test since start."},
    {1, "RUNNING",
     "The test is under way."},
    {2, "DONE",
     "The test is done, and its results hold."},
    {3, "STOPPED",
     "Somebody stopped the test, or its owner fell silent."},
    {-1, "FORCE",
     "The force at the tip passed its bound."},
    {-2, "TORQUE",
     "A motor's torque passed its bound."},
    {-3, "TRAVEL",
     "A joint came to the end of its travel."},
    {-4, "TIME",
     "The test was not done in time."},
    {-5, "NO_FORCE",
     "No force at the tip is known."},
    {-6, "FAULT",
     "A fault came, or backlash that was taken up has opened again."},
    {-7, "NOT_FOLLOWING",
     "The motors do not follow their commands."},
};

const char *brace_loading_outcome_name(int32_t number)
{
    enum { COUNT = sizeof loading_outcome_meanings / sizeof *loading_outcome_meanings };
    return find(loading_outcome_meanings, COUNT, number)->name;
}

const char *brace_loading_outcome_text(int32_t number)
{
    enum { COUNT = sizeof loading_outcome_meanings / sizeof *loading_outcome_meanings };
    return find(loading_outcome_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_DRIFT_LEARNING == (uint32_t)(0), "drift_state");
_Static_assert((uint32_t)BRACE_DRIFT_WATCHING == (uint32_t)(1), "drift_state");
_Static_assert((uint32_t)BRACE_DRIFT_DRIFTED == (uint32_t)(2), "drift_state");
static const meaning_t drift_state_meanings[] = {
    {0, "LEARNING",
     "The check learns the limb's own baseline from loading tests."},
    {1, "WATCHING",
     "The check holds its baseline and watches for a change."},
    {2, "DRIFTED",
     "The limb has changed: MODEL_DRIFT is set until somebody clears it."},
};

const char *brace_drift_state_name(int32_t number)
{
    enum { COUNT = sizeof drift_state_meanings / sizeof *drift_state_meanings };
    return find(drift_state_meanings, COUNT, number)->name;
}

const char *brace_drift_state_text(int32_t number)
{
    enum { COUNT = sizeof drift_state_meanings / sizeof *drift_state_meanings };
    return find(drift_state_meanings, COUNT, number)->text;
}

static const meaning_t drift_cause_meanings[] = {
    {0, "NONE",
     "No change has shown."},
    {1, "FEMUR_LINK",
     "The femur's bending has changed."},
    {2, "TIBIA_LINK_OR_KNEE_JOINT",
     "The tibia's bending or the knee joint's spring has changed; forces at the tip cannot tell these two apart."},
    {3, "FEMUR_JOINT_OR_BASE",
     "The femur joint's spring or the base's rotation has changed; forces at the tip cannot tell these two apart."},
    {4, "UNEXPLAINED",
     "The readings scatter more than their noise, and no change of a part explains it."},
};

const char *brace_drift_cause_name(int32_t number)
{
    enum { COUNT = sizeof drift_cause_meanings / sizeof *drift_cause_meanings };
    return find(drift_cause_meanings, COUNT, number)->name;
}

const char *brace_drift_cause_text(int32_t number)
{
    enum { COUNT = sizeof drift_cause_meanings / sizeof *drift_cause_meanings };
    return find(drift_cause_meanings, COUNT, number)->text;
}

static const meaning_t drift_next_step_meanings[] = {
    {0, "NOTHING",
     "There is nothing to do."},
    {1, "LEARN",
     "Go on learning: run loading tests at other postures."},
    {2, "REPEAT_TEST",
     "Repeat the loading test at this posture."},
    {3, "TEST_ANOTHER_POSTURE",
     "Run a loading test at another posture: it tells apart the causes that are left."},
    {4, "INSPECT_FEMUR_LINK",
     "Inspect the femur link."},
    {5, "INSPECT_TIBIA_LINK_AND_KNEE_JOINT",
     "Inspect the tibia link and the knee joint."},
    {6, "INSPECT_FEMUR_JOINT_AND_BASE",
     "Inspect the femur joint and the base."},
    {7, "CHECK_SENSOR_AND_MOUNTING",
     "Check the force sensor and how the limb is mounted."},
};

const char *brace_drift_next_step_name(int32_t number)
{
    enum { COUNT = sizeof drift_next_step_meanings / sizeof *drift_next_step_meanings };
    return find(drift_next_step_meanings, COUNT, number)->name;
}

const char *brace_drift_next_step_text(int32_t number)
{
    enum { COUNT = sizeof drift_next_step_meanings / sizeof *drift_next_step_meanings };
    return find(drift_next_step_meanings, COUNT, number)->text;
}

static const meaning_t heartbeat_state_meanings[] = {
    {0, "BOOT",
     "The controller has started."},
    {4, "STOPPED",
     "The controller is in the mode FAULT."},
    {5, "OPERATIONAL",
     "The controller works."},
    {127, "PRE_OPERATIONAL",
     "The controller is in the mode CONFIGURATION."},
};

const char *brace_heartbeat_state_name(int32_t number)
{
    enum { COUNT = sizeof heartbeat_state_meanings / sizeof *heartbeat_state_meanings };
    return find(heartbeat_state_meanings, COUNT, number)->name;
}

const char *brace_heartbeat_state_text(int32_t number)
{
    enum { COUNT = sizeof heartbeat_state_meanings / sizeof *heartbeat_state_meanings };
    return find(heartbeat_state_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_PARAMETERS_DEFAULT == (uint32_t)(0), "parameter_origin");
_Static_assert((uint32_t)BRACE_PARAMETERS_SLOT_A == (uint32_t)(1), "parameter_origin");
_Static_assert((uint32_t)BRACE_PARAMETERS_SLOT_B == (uint32_t)(2), "parameter_origin");
static const meaning_t parameter_origin_meanings[] = {
    {0, "DEFAULT",
     "No valid set is kept: the controller uses safe defaults."},
    {1, "SLOT_A",
     "The first slot of the non-volatile memory."},
    {2, "SLOT_B",
     "The second slot of the non-volatile memory."},
};

const char *brace_parameter_origin_name(int32_t number)
{
    enum { COUNT = sizeof parameter_origin_meanings / sizeof *parameter_origin_meanings };
    return find(parameter_origin_meanings, COUNT, number)->name;
}

const char *brace_parameter_origin_text(int32_t number)
{
    enum { COUNT = sizeof parameter_origin_meanings / sizeof *parameter_origin_meanings };
    return find(parameter_origin_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_CONTACT_HOLDS == (uint32_t)(0), "contact");
_Static_assert((uint32_t)BRACE_CONTACT_SLIDES == (uint32_t)(1), "contact");
_Static_assert((uint32_t)BRACE_CONTACT_LIFTS == (uint32_t)(2), "contact");
static const meaning_t contact_meanings[] = {
    {0, "HOLDS",
     "The force lies inside the friction cone: the foot stands."},
    {1, "SLIDES",
     "The force lies outside the friction cone: the foot slides."},
    {2, "LIFTS",
     "The force pulls the foot off the surface."},
};

const char *brace_contact_name(int32_t number)
{
    enum { COUNT = sizeof contact_meanings / sizeof *contact_meanings };
    return find(contact_meanings, COUNT, number)->name;
}

const char *brace_contact_text(int32_t number)
{
    enum { COUNT = sizeof contact_meanings / sizeof *contact_meanings };
    return find(contact_meanings, COUNT, number)->text;
}

static const meaning_t fault_meanings[] = {
    {0, "SENSOR_FEMUR",
     "The femur joint's drive gives no sound sample."},
    {1, "SENSOR_TIBIA",
     "The tibia joint's drive gives no sound sample."},
    {2, "ENCODER_STUCK",
     "A motor's torque works and its angle does not follow, or a joint's sensor reports the same whatever the limb"
     " does."},
    {3, "TICK_LATE",
     "A tick came more than two periods late."},
    {4, "PARAMETERS",
     "Neither slot holds a valid parameter set: the controller uses safe defaults, and K is UNCALIBRATED."},
    {5, "STORE",
     "The non-volatile memory does not keep what is written to it."},
    {6, "CAN_BUS_OFF",
     "The CAN controller has left the bus after too many errors, or does not come onto it."},
    {7, "MODEL_DRIFT",
     "Measurement and model have drifted apart; drift_cause names the likeliest cause."},
    {8, "CRASHED",
     "The last start came after a crash; the record says more."},
    {9, "SENSOR_COXA",
     "The coxa joint's drive gives no sound sample."},
    {10, "DRIVE_REFUSES",
     "A drive has refused its commands for 50 ms; what moved the limb was ended."},
    {11, "MEMORY",
     "Parameters or constants in RAM have changed by themselves; they are taken from the store again."},
    {12, "OLD_PARAMETERS",
     "A parameter set was stored and is not whole any more: the set before it is in force, and K is UNCALIBRATED."},
    {13, "JUMP_COXA",
     "An encoder of the coxa joint says what cannot be: it has jumped further than the joint can turn, or "
     "contradicts the other one."},
    {14, "JUMP_FEMUR",
     "An encoder of the femur joint says what cannot be: it has jumped further than the joint can turn, or "
     "contradicts the other one."},
    {15, "JUMP_TIBIA",
     "An encoder of the tibia joint says what cannot be: it has jumped further than the joint can turn, or "
     "contradicts the other one."},
};

const char *brace_fault_name(int32_t number)
{
    enum { COUNT = sizeof fault_meanings / sizeof *fault_meanings };
    return find(fault_meanings, COUNT, number)->name;
}

const char *brace_fault_text(int32_t number)
{
    enum { COUNT = sizeof fault_meanings / sizeof *fault_meanings };
    return find(fault_meanings, COUNT, number)->text;
}

_Static_assert((uint32_t)BRACE_FLAG_UNCALIBRATED == (uint32_t)(1u << 0), "flag");
_Static_assert((uint32_t)BRACE_FLAG_NEAR_SINGULAR == (uint32_t)(1u << 1), "flag");
_Static_assert((uint32_t)BRACE_FLAG_SATURATED == (uint32_t)(1u << 2), "flag");
_Static_assert((uint32_t)BRACE_FLAG_GAP_OPEN == (uint32_t)(1u << 3), "flag");
_Static_assert((uint32_t)BRACE_FLAG_STALE == (uint32_t)(1u << 4), "flag");
_Static_assert((uint32_t)BRACE_FLAG_OUT_OF_RANGE == (uint32_t)(1u << 5), "flag");
_Static_assert((uint32_t)BRACE_FLAG_LOAD_UNKNOWN == (uint32_t)(1u << 6), "flag");
_Static_assert((uint32_t)BRACE_FLAG_SOFTENED == (uint32_t)(1u << 7), "flag");
_Static_assert((uint32_t)BRACE_FLAG_MOVED_FAR == (uint32_t)(1u << 8), "flag");
_Static_assert((uint32_t)BRACE_FLAG_PLAY_ASSUMED == (uint32_t)(1u << 9), "flag");
static const meaning_t flag_meanings[] = {
    {0, "UNCALIBRATED",
     "The parameters are defaults, not this limb's."},
    {1, "NEAR_SINGULAR",
     "The stated accuracy is not promised for this limb at this posture."},
    {2, "SATURATED",
     "A value was limited to what its frame can say."},
    {3, "GAP_OPEN",
     "A joint's play may be open: that joint carries nothing until the gap has closed."},
    {4, "STALE",
     "K is older than its age limit, a joint may have moved since its last sample, or the mode is one without K."},
    {5, "OUT_OF_RANGE",
     "The posture lies outside the range in which the model was identified."},
    {6, "LOAD_UNKNOWN",
     "The load is not counted, because it is not known: K is the one without load."},
    {7, "SOFTENED",
     "The load has softened the limb: the buckling factor is below 3, or no stable equilibrium is near."},
    {8, "MOVED_FAR",
     "The load moves the tip further than the accuracy is promised for: by more than a fifth of the reach."},
    {9, "PLAY_ASSUMED",
     "A joint with play counts as engaged because the load says so. Nothing has proven it."},
};

const char *brace_flag_name(int32_t number)
{
    enum { COUNT = sizeof flag_meanings / sizeof *flag_meanings };
    return find(flag_meanings, COUNT, number)->name;
}

const char *brace_flag_text(int32_t number)
{
    enum { COUNT = sizeof flag_meanings / sizeof *flag_meanings };
    return find(flag_meanings, COUNT, number)->text;
}

static const meaning_t drift_could_be_meanings[] = {
    {0, "FEMUR_LINK",
     "The femur's bending."},
    {1, "TIBIA_LINK_OR_KNEE_JOINT",
     "The tibia's bending or the knee joint's spring."},
    {2, "FEMUR_JOINT_OR_BASE",
     "The femur joint's spring or the base's rotation."},
    {3, "UNEXPLAINED",
     "None of these."},
};

const char *brace_drift_could_be_name(int32_t number)
{
    enum { COUNT = sizeof drift_could_be_meanings / sizeof *drift_could_be_meanings };
    return find(drift_could_be_meanings, COUNT, number)->name;
}

const char *brace_drift_could_be_text(int32_t number)
{
    enum { COUNT = sizeof drift_could_be_meanings / sizeof *drift_could_be_meanings };
    return find(drift_could_be_meanings, COUNT, number)->text;
}
