"""What numbers on the wire mean. Written by tools/interface from dictionary.toml; do not edit."""

from __future__ import annotations

from brace.wire.code import Code, CodeTable

# What the controller is doing.
MODE = CodeTable("mode", False, (
    Code(0, "START", "The controller has started and waits for sound samples of its joints."),
    Code(1, "MONITOR", "The controller computes K in every tick; others move the limb."),
    Code(2, "CONFIGURATION", "Parameters may be written; nothing moves the limb, and K is not reported."),
    Code(3, "TAKING_UP", "The controller takes up the play of joints, holds it, or lets it go."),
    Code(4, "LOADING_TEST", "The controller runs a loading test."),
    Code(5, "FAULT", "A fault makes every K invalid; the mode ends by itself when the fault is over."),
))

# Who may move the limb and write to its controller: docs/security.md.
SETTING = CodeTable("setting", False, (
    Code(1, "BENCH", "Everybody on the buses: for simulators, emulated boards and a board on a desk."),
    Code(2, "GUARDED", "Whoever has the controller's key, one at a time."),
    Code(3, "NO_KEY", "Nobody: the board is guarded and has no key yet."),
))

# The port of the one whose session is open.
OWNER = CodeTable("owner", False, (
    Code(0, "NONE", "No session is open."),
    Code(1, "PROGRAM", "The program around the controller."),
    Code(2, "CAN", "A master on CAN."),
    Code(3, "SLCAN", "The other end of the SLCAN port."),
    Code(4, "MODBUS_LINE", "The master of the Modbus line."),
    Code(5, "MODBUS_TCP", "A master over Modbus TCP."),
))

# Which side of a joint's backlash is loaded.
PLAY = CodeTable("play", False, (
    Code(0, "UNKNOWN", "It is not known which side of the backlash is loaded: no load has shown it, or none for 250 ms."),
    Code(1, "TAKING_UP", "A take-up moves the motor through the gap."),
    Code(2, "ENGAGED_POSITIVE", "The positive side of the backlash is loaded."),
    Code(3, "ENGAGED_NEGATIVE", "The negative side of the backlash is loaded."),
    Code(4, "CROSSING", "The load has left one side of the backlash, and it is not known yet which side comes next."),
    Code(5, "FAULT", "The joint's samples were bad or late."),
))

# Where a joint's take-up stands.
TAKE_UP_PHASE = CodeTable("take_up_phase", False, (
    Code(0, "IDLE", "No take-up is under way."),
    Code(1, "APPROACH", "The command moves the motor to the chosen side of the backlash."),
    Code(2, "VERIFY", "The command stands, and the load has to stay."),
    Code(3, "HOLD", "The chosen side is verified and held loaded: measure now."),
    Code(4, "LET_GO", "The command goes back the way it came."),
))

# How a joint's last take-up went.
TAKE_UP_OUTCOME = CodeTable("take_up_outcome", False, (
    Code(0, "NONE", "Nobody has asked for a take-up since start."),
    Code(1, "RUNNING", "The take-up is under way."),
    Code(2, "HELD", "The chosen side of the backlash is loaded: this was verified."),
    Code(-1, "TORQUE", "The motor's torque passed its bound: the joint is blocked, or its take-up torque is set too low."),
    Code(-2, "TRAVEL", "The motor went further than the gap allows: nothing holds the link, or the gap is larger than believed."),
    Code(-3, "REACH", "The command went to its end and no load came: the motor does not follow its command."),
    Code(-4, "TIME", "The chosen side was not verified as loaded in time: ask again while the limb stands still."),
    Code(-5, "VERIFY", "The load or the motor did not stay while the chosen side was verified: ask again while the limb stands still."),
    Code(-6, "LOST", "The chosen side was verified as loaded, and later its load went away."),
    Code(-7, "FAULT", "The joint's samples were bad or late during the take-up."),
))

# How the last loading test went.
LOADING_OUTCOME = CodeTable("loading_outcome", False, (
    Code(0, "NONE", "Nobody has asked for a loading test since start."),
    Code(1, "RUNNING", "The test is under way."),
    Code(2, "DONE", "The test is done, and its results hold."),
    Code(3, "STOPPED", "Somebody stopped the test, or its owner fell silent."),
    Code(-1, "FORCE", "The force at the tip passed its bound."),
    Code(-2, "TORQUE", "A motor's torque passed its bound."),
    Code(-3, "TRAVEL", "A joint came to the end of its travel."),
    Code(-4, "TIME", "The test was not done in time."),
    Code(-5, "NO_FORCE", "No force at the tip is known."),
    Code(-6, "FAULT", "A fault came, or backlash that was taken up has opened again."),
    Code(-7, "NOT_FOLLOWING", "The motors do not follow their commands."),
))

# What the check of model against measurement is doing.
DRIFT_STATE = CodeTable("drift_state", False, (
    Code(0, "LEARNING", "The check learns the limb's own baseline from loading tests."),
    Code(1, "WATCHING", "The check holds its baseline and watches for a change."),
    Code(2, "DRIFTED", "The limb has changed: MODEL_DRIFT is set until somebody clears it."),
))

# The likeliest cause of a drift. The core's number of the same cause is one less.
DRIFT_CAUSE = CodeTable("drift_cause", False, (
    Code(0, "NONE", "No change has shown."),
    Code(1, "FEMUR_LINK", "The femur's bending has changed."),
    Code(2, "TIBIA_LINK_OR_KNEE_JOINT", "The tibia's bending or the knee joint's spring has changed; forces at the tip cannot tell these two apart."),
    Code(3, "FEMUR_JOINT_OR_BASE", "The femur joint's spring or the base's rotation has changed; forces at the tip cannot tell these two apart."),
    Code(4, "UNEXPLAINED", "The readings scatter more than their noise, and no change of a part explains it."),
))

# What to do next about a drift.
DRIFT_NEXT_STEP = CodeTable("drift_next_step", False, (
    Code(0, "NOTHING", "There is nothing to do."),
    Code(1, "LEARN", "Go on learning: run loading tests at other postures."),
    Code(2, "REPEAT_TEST", "Repeat the loading test at this posture."),
    Code(3, "TEST_ANOTHER_POSTURE", "Run a loading test at another posture: it tells apart the causes that are left."),
    Code(4, "INSPECT_FEMUR_LINK", "Inspect the femur link."),
    Code(5, "INSPECT_TIBIA_LINK_AND_KNEE_JOINT", "Inspect the tibia link and the knee joint."),
    Code(6, "INSPECT_FEMUR_JOINT_AND_BASE", "Inspect the femur joint and the base."),
    Code(7, "CHECK_SENSOR_AND_MOUNTING", "Check the force sensor and how the limb is mounted."),
))

# The controller's state, as CANopen numbers it.
HEARTBEAT_STATE = CodeTable("heartbeat_state", False, (
    Code(0, "BOOT", "The controller has started."),
    Code(4, "STOPPED", "The controller is in the mode FAULT."),
    Code(5, "OPERATIONAL", "The controller works."),
    Code(127, "PRE_OPERATIONAL", "The controller is in the mode CONFIGURATION."),
))

# Where the parameters in force come from.
PARAMETER_ORIGIN = CodeTable("parameter_origin", False, (
    Code(0, "DEFAULT", "No valid set is kept: the controller uses safe defaults."),
    Code(1, "SLOT_A", "The first slot of the non-volatile memory."),
    Code(2, "SLOT_B", "The second slot of the non-volatile memory."),
))

# What the foot does on a surface.
CONTACT = CodeTable("contact", False, (
    Code(0, "HOLDS", "The force lies inside the friction cone: the foot stands."),
    Code(1, "SLIDES", "The force lies outside the friction cone: the foot slides."),
    Code(2, "LIFTS", "The force pulls the foot off the surface."),
))

# What is wrong with the controller or the limb; a bit stays set while its cause does.
FAULT = CodeTable("fault", True, (
    Code(0, "SENSOR_FEMUR", "The femur joint's drive gives no sound sample."),
    Code(1, "SENSOR_TIBIA", "The tibia joint's drive gives no sound sample."),
    Code(2, "ENCODER_STUCK", "A motor's torque works and its angle does not follow, or a joint's sensor reports the same whatever the limb does."),
    Code(3, "TICK_LATE", "A tick came more than two periods late."),
    Code(4, "PARAMETERS", "Neither slot holds a valid parameter set: the controller uses safe defaults, and K is UNCALIBRATED."),
    Code(5, "STORE", "The non-volatile memory does not keep what is written to it."),
    Code(6, "CAN_BUS_OFF", "The CAN controller has left the bus after too many errors, or does not come onto it."),
    Code(7, "MODEL_DRIFT", "Measurement and model have drifted apart; drift_cause names the likeliest cause."),
    Code(8, "CRASHED", "The last start came after a crash; the record says more."),
    Code(9, "SENSOR_COXA", "The coxa joint's drive gives no sound sample."),
    Code(10, "DRIVE_REFUSES", "A drive has refused its commands for 50 ms; what moved the limb was ended."),
    Code(11, "MEMORY", "Parameters or constants in RAM have changed by themselves; they are taken from the store again."),
    Code(12, "OLD_PARAMETERS", "A parameter set was stored and is not whole any more: the set before it is in force, and K is UNCALIBRATED."),
    Code(13, "JUMP_COXA", "An encoder of the coxa joint says what cannot be: it has jumped further than the joint can turn, or contradicts the other one."),
    Code(14, "JUMP_FEMUR", "An encoder of the femur joint says what cannot be: it has jumped further than the joint can turn, or contradicts the other one."),
    Code(15, "JUMP_TIBIA", "An encoder of the tibia joint says what cannot be: it has jumped further than the joint can turn, or contradicts the other one."),
))

# Quality of a K that is reported all the same.
FLAG = CodeTable("flag", True, (
    Code(0, "UNCALIBRATED", "The parameters are defaults, not this limb's."),
    Code(1, "NEAR_SINGULAR", "The stated accuracy is not promised for this limb at this posture."),
    Code(2, "SATURATED", "A value was limited to what its frame can say."),
    Code(3, "GAP_OPEN", "A joint's play may be open: that joint carries nothing until the gap has closed."),
    Code(4, "STALE", "K is older than its age limit, a joint may have moved since its last sample, or the mode is one without K."),
    Code(5, "OUT_OF_RANGE", "The posture lies outside the range in which the model was identified."),
    Code(6, "LOAD_UNKNOWN", "The load is not counted, because it is not known: K is the one without load."),
    Code(7, "SOFTENED", "The load has softened the limb: the buckling factor is below 3, or no stable equilibrium is near."),
    Code(8, "MOVED_FAR", "The load moves the tip further than the accuracy is promised for: by more than a fifth of the reach."),
    Code(9, "PLAY_ASSUMED", "A joint with play counts as engaged because the load says so. Nothing has proven it."),
))

# Every cause that is nearly as likely as the likeliest, itself included.
DRIFT_COULD_BE = CodeTable("drift_could_be", True, (
    Code(0, "FEMUR_LINK", "The femur's bending."),
    Code(1, "TIBIA_LINK_OR_KNEE_JOINT", "The tibia's bending or the knee joint's spring."),
    Code(2, "FEMUR_JOINT_OR_BASE", "The femur joint's spring or the base's rotation."),
    Code(3, "UNEXPLAINED", "None of these."),
))

TABLES = {table.name: table for table in (
    MODE,
    SETTING,
    OWNER,
    PLAY,
    TAKE_UP_PHASE,
    TAKE_UP_OUTCOME,
    LOADING_OUTCOME,
    DRIFT_STATE,
    DRIFT_CAUSE,
    DRIFT_NEXT_STEP,
    HEARTBEAT_STATE,
    PARAMETER_ORIGIN,
    CONTACT,
    FAULT,
    FLAG,
    DRIFT_COULD_BE,
)}
