/* Controllers and limbs as in brace_node.h, the limbs under one body: a simulated robot that stands on its feet.
 *
 * The body is rigid, with six degrees of freedom, and quasi-static: weight, payload and limbs take it to its
 * equilibrium with a time constant of 4 ms, without swinging. Each foot is held by its ground as Coulomb's law has it,
 * with history: it sticks, slides, leaves the ground and comes down again, and grips up to grip_n, then lets go. When
 * no equilibrium is left, the body falls: every foot is then gone, and the limbs and their controllers go on. The
 * statics of tools/stance take no part in this: this robot judges them.
 *
 * All calls of brace_node.h serve such a node too, except brace_node_contact. The limbs must have a coxa joint.
 * hold_n_per_mm and press of the limbs, and gravity's direction in their plants, are not used: footholds and body say
 * them. The fault tip_lost makes a foot bear nothing while it lasts.
 *
 * Vectors are in the body's frame (x forward, y left, z up) where it stands without load; that frame is the world's,
 * with the ground at rest in it.
 */
#ifndef BRACE_ROBOT_H
#define BRACE_ROBOT_H

#include "brace_node.h"

enum { BRACE_ROBOT_LIMBS = 8 };

typedef struct {
    double mount_mm[3]; /* where the limb's first axis stands, at the height of its femur joint [-1e4, 1e4] */
    double mount_turn[9]; /* a rotation, rows: the limb's frame (x outwards at theta0 = 0, z up) into the body's */
    double foothold_mm[3]; /* where the ground holds the foot when the body has been put down, before it slides */
    double normal[3]; /* out of the ground; not zero */
    double friction_ratio; /* [0, 10] */
    double grip_n; /* how hard the foot may be pulled [0, 1e6]; 0: it only presses */
} brace_robot_foot_t;

typedef struct {
    double weight_n; /* of the body without its limbs [0, 1e6] */
    double com_mm[3]; /* where it acts [-1e4, 1e4] */
    double down[3]; /* where weights pull; not zero */
    double payload_n[3], payload_at_mm[3]; /* force on the body at the factor 1, and where */
    brace_robot_foot_t foot[BRACE_ROBOT_LIMBS]; /* of each limb */
} brace_robot_t;

/* Makes limbs and body, lets the weight come in a straight line from nothing while the footholds go from the unloaded
 * tips to where they are, and starts the controllers on the standing robot. The payload does not act yet.
 *   limbs, count: 1 to BRACE_ROBOT_LIMBS; the rest is as for brace_node_create */
brace_node_t *brace_robot_create(const brace_node_limb_t *limbs, int32_t count, const brace_robot_t *robot,
                                 const char *can, uint64_t seed, brace_node_failure_t *failure);

/* The calls below return 0, or -3: no robot, no such limb, or a number out of its range. */

/* From at_s on the payload's factor [-1e3, 1e3] goes to this one within ramp_s [0, 1e6]. */
int32_t brace_robot_payload(brace_node_t *node, double at_s, double factor, double ramp_s);

/* From a time on, a limb's set-points [-7.9, 7.9 rad] move to these at the drives' rate; as brace_node_posture. */
int32_t brace_robot_set_points(brace_node_t *node, int32_t limb, double at_s, const double theta_rad[3]);

/* From at_s on, for a while (inf: for good), a foot only presses, so that it can be lifted; then it grips again where
 * it stands. */
int32_t brace_robot_release(brace_node_t *node, int32_t limb, double at_s, double for_s);

typedef enum {
    BRACE_ROBOT_STICKS = 0,
    BRACE_ROBOT_SLIDES = 1,
    BRACE_ROBOT_OPEN = 2, /* off the ground; it bears again where it comes down */
    BRACE_ROBOT_GONE = 3 /* its grip was pulled off, or the body has fallen: it bears nothing */
} brace_robot_contact_t;

/* What no controller sees. */
typedef struct {
    double force_n[3]; /* of the ground on the foot, in the frame of the body as it stands now */
    double foot_mm[3]; /* where the foot is, in the world */
    double torque_n_mm[3]; /* what coxa, femur and tibia bear as their motors' currents show it, friction of motor and
                            * gears included, in the sense of the joints' angles */
    int32_t contact; /* a brace_robot_contact_t */
    int32_t contact_before_fall; /* the last one before the body fell */
} brace_robot_foot_truth_t;

typedef struct {
    double time_s;
    double payload_factor;
    double displacement_mm[3], rotation_rad[3]; /* of the body; a rotation vector */
    double unbalanced_ratio; /* forces without balance in all that act; falls to rounding at rest */
    double fallen_s; /* when the body fell; negative: it stands */
    int32_t limb_count;
    brace_robot_foot_truth_t foot[BRACE_ROBOT_LIMBS];
} brace_robot_truth_t;

int32_t brace_robot_truth(brace_node_t *node, brace_robot_truth_t *truth);

/* The truth each 10 ms, oldest first, of the last 20 s at most. Reads up to `most` rows and forgets them.
 * returns how many, or -3. */
int32_t brace_robot_log(brace_node_t *node, brace_robot_truth_t *rows, int32_t most);

#endif
