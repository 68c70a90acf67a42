/* Samples of the joints: which are sound, how old they are, and whether a joint can be where its encoders say. */
#ifndef BRACE_SENSE_JOINTS_H
#define BRACE_SENSE_JOINTS_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace_hal.h"

enum { JOINTS_CARRIED = 3 };
enum { JOINT_MOTOR = 0, JOINT_LINK = 1, JOINT_ENCODERS = 2 };

/* Where an encoder stood when it was last believed. */
typedef struct {
    float rad;         /* NaN: it has not been, since the start or since somebody cleared the joint's fault */
    uint32_t taken_us;
    bool is_old;       /* longer ago than controller.age_limit_us */
} joint_place_t;

typedef struct {
    bool fitted;              /* the limb has this joint */
    bool is_link_only;        /* its one encoder is behind the gear: sample.motor_rad is the link's angle */
    brace_hal_joint_t sample; /* the newest sound one; NaN before the first */
    float torque_n_mm;        /* mean over 20 ms; a single wild sample does not move it */
    float speed_rad_per_us;   /* of the motor, between the newest two samples */
    float lately_rad_per_us;  /* the greatest of the last 50 samples or so, without its sign */
    float carries_n_mm[JOINTS_CARRIED]; /* by the newest samples, newest first: the torque less what accelerates the
                                           motor; NaN: not known, because it takes three samples in a row to find one */
    bool sound;               /* the sample is no older than controller.age_limit_us */
    bool may_have_moved;      /* since that sample, further than K's uncertainty covers */
    bool is_new_enough_to_prove_a_flank; /* no older than four ticks, which the backlash machine's filters bear */
    uint8_t samples_seen;     /* in a row; counts to 3 */
    joint_place_t place[JOINT_ENCODERS];
    bool has_wild;            /* no joint could have moved to where the sample before said, */
    joint_place_t wild[JOINT_ENCODERS]; /* which is this one */
    uint8_t wildness;         /* 10 for each wild sample, less 1 for each good one */
    bool has_jumped;          /* an encoder has said what cannot be, until joints_believe: BRACE_FAULT_JUMP_... */
    bool contradicts;         /* its two encoders are further apart than play and spring let them */
    uint32_t contradicts_us;  /* for how long */
} joint_t;

typedef struct {
    joint_t joint[BRACE_LINK_COUNT]; /* by BRACE_COXA, BRACE_FEMUR, BRACE_TIBIA */
} joints_t;

/* Forgets every sample, and asks the door which joints are fitted: femur and tibia always, the coxa joint unless
 * joint_read answers E_UNSUPPORTED. */
void joints_start(joints_t *joints, const brace_hal_t *hal);

/* Reads the fitted joints. A sample that is refused, not finite or absurd (a torque beyond the motor's greatest, bias
 * and six sigmas of noise) is counted, and the sound one before stays until it is older than controller.age_limit_us.
 * So is one with an angle, of the motor or of the link, that no joint could have reached since that encoder was last
 * believed:
 *   50 rad/s, and 0.25 rad whatever the time stamps say; 0.06 rad where the last angle is older than the age limit
 * Where the next sample agrees with it, the encoder has jumped: has_jumped stands until joints_believe, and the samples
 * are taken as they come, so that whoever looks sees them. So it does where both encoders have been further apart for
 * 50 ms than play, spring and calibration let them.
 * After such a sample, only what goes on as before is believed; after several, nothing, until good ones have come.
 * The first angle of an encoder is believed: there is nothing to hold it against but the other encoder.
 *   samples_bad: of brace_app_counters_t
 * At most 260 instructions a joint. */
void joints_read(joints_t *joints, const brace_hal_t *hal, const brace_parameters_t *parameters, uint32_t now_us,
                 uint32_t *samples_bad);

/* Somebody has looked at the joint: what its encoders say next is believed, and counts from there. */
void joints_believe(joints_t *joints, int index);

/* Are femur and tibia joint sound, so that there may be a K in the limb's plane? */
static inline bool joints_plane_is_sound(const joints_t *joints)
{
    return joints->joint[BRACE_FEMUR].sound && joints->joint[BRACE_TIBIA].sound;
}

/* May one of them stand elsewhere by now, so that a K of its last sample is not K of now? */
static inline bool joints_plane_may_have_moved(const joints_t *joints)
{
    return joints->joint[BRACE_FEMUR].may_have_moved || joints->joint[BRACE_TIBIA].may_have_moved;
}

/* True angles by the encoders behind the gears; NaN: there is none, or what it reads is absurd. */
void joints_link_angles(const joints_t *joints, float link_rad[BRACE_LINK_COUNT]);

/* When the samples were taken: the oldest of the femur joint's, without which there is no K, and of the others that are
 * sound. */
uint32_t joints_taken_us(const joints_t *joints);

/* Each joint's temperature [degC]. Femur and tibia joint take the other's where they have no sensor, or one that says
 * less than -60 or more than 150; NaN: not measured. */
void joints_temperatures(const joints_t *joints, float temp_degc[BRACE_LINK_COUNT]);

/* Temperature of femur and tibia joint, the warmer one [degC], by their newest samples however old; the coxa joint is
 * left out. NaN: not measured. */
float joints_warmest_degc(const joints_t *joints);

#endif
