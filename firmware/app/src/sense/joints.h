/* Samples of the joints: which are sound, and how old they are. */
#ifndef BRACE_SENSE_JOINTS_H
#define BRACE_SENSE_JOINTS_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/parameters.h"
#include "brace/snapshot.h"
#include "brace_hal.h"

enum { JOINTS_CARRIED = 3 };

typedef struct {
    bool fitted;              /* the limb has this joint */
    bool is_link_only;        /* its one encoder is behind the gear: sample.motor_rad is the link's angle */
    brace_hal_joint_t sample; /* the newest sound one; NaN before the first */
    float torque_n_mm;        /* mean over 20 ms; a single wild sample does not move it */
    float speed_rad_per_us;   /* of the motor, between the newest two samples */
    float carries_n_mm[JOINTS_CARRIED]; /* by the newest samples, newest first: the torque less what accelerates the
                                           motor; NaN: not known, because three samples in a row tell one of them */
    bool sound;               /* the sample is no older than controller.age_limit_us */
    bool is_new_enough_to_prove_a_flank; /* no older than four ticks, which the backlash machine's filters bear */
    uint8_t samples_seen;     /* in a row; counts to 3 */
    bool has_wild;            /* no joint could have moved to where the sample before told, */
    brace_hal_joint_t wild;   /* which is this one */
} joint_t;

typedef struct {
    joint_t joint[BRACE_LINK_COUNT]; /* by BRACE_COXA, BRACE_FEMUR, BRACE_TIBIA */
} joints_t;

/* Forgets every sample, and asks the door which joints are fitted: femur and tibia always, the coxa joint unless
 * joint_read answers E_UNSUPPORTED. */
void joints_start(joints_t *joints, const brace_hal_t *hal);

/* Reads the fitted joints. A sample that is refused, not finite or absurd (a torque of more than twice the motor's
 * greatest) is counted, and the sound one before stays until it is older than controller.age_limit_us. So is an angle
 * that no joint could have reached since the sample before: 50 rad/s. Where the next sample agrees, it is believed.
 *   samples_bad: of brace_app_counters_t
 * At most 190 instructions a joint. */
void joints_read(joints_t *joints, const brace_hal_t *hal, const brace_parameters_t *parameters,
                 uint32_t now_us, uint32_t *samples_bad);

/* Are femur and tibia joint sound, so that there may be a K in the limb's plane? */
static inline bool joints_plane_is_sound(const joints_t *joints)
{
    return joints->joint[BRACE_FEMUR].sound && joints->joint[BRACE_TIBIA].sound;
}

/* True angles by the encoders behind the gears; NaN: there is none, or what it reads is absurd. */
void joints_link_angles(const joints_t *joints, float link_rad[BRACE_LINK_COUNT]);

/* When the samples were taken: the oldest of the femur joint's, without which there is no K, and of the others that are
 * sound. */
uint32_t joints_taken_us(const joints_t *joints);

/* Each joint's temperature [degC]. Femur and tibia joint take the other's where they have no sensor; NaN: not
 * measured. */
void joints_temperatures(const joints_t *joints, float temp_degc[BRACE_LINK_COUNT]);

/* Temperature of femur and tibia joint, the warmer one [degC], by their newest samples however old; the coxa joint is
 * left out. NaN: not measured. */
float joints_warmest_degc(const joints_t *joints);

#endif
