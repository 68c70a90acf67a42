/* A question for K where the limb need not be, and its answer (brace_app_ask_k). */
#ifndef BRACE_K_QUESTION_H
#define BRACE_K_QUESTION_H

#include "brace/contact.h"
#include "brace/kinematics.h"
#include "brace/stiffness.h"

enum { BRACE_APP_LATER = 1 }; /* the answer is being worked out: ask again */

/* Who asks for a K: each has one question at a time. */
typedef enum {
    BRACE_ASKER_PROGRAM = 0, /* the program around the controller */
    BRACE_ASKER_CAN,
    BRACE_ASKER_SLCAN,
    BRACE_ASKER_MODBUS_LINE,
    BRACE_ASKER_MODBUS_TCP,
    BRACE_ASKER_COUNT
} brace_asker_t;

typedef enum { BRACE_K_AT_POSTURE = 0, BRACE_K_AT_TIP, BRACE_K_IN_SPACE } brace_k_where_t;

/* K with every gap closed, where the limb need not be, with the joints' temperatures of now. Set what is not used to
 * zero: the controller compares every member to see that the same question is asked again. Members are words of 32
 * bits, because an enumeration is a byte on some processors, with bytes behind it that nobody sets. A number outside
 * its range is refused with BRACE_E_RANGE. */
typedef struct {
    uint32_t where;                    /* brace_k_where_t; any other number means a posture */
    float theta_rad[BRACE_LINK_COUNT]; /* of a posture: true angles before the load turns the joints; of femur and tibia
                                          theta1^2 + theta2^2 <= BRACE_REACH_RAD2; of the coxa +-7.9, in space only */
    brace_point_t tip; /* of a tip: where it is before the load moves it [+-1e6 mm] */
    uint32_t knee; /* brace_knee_t */
    brace_force_t tip_force; /* of the ground, in the limb's plane; counted together with the weight. The sum
                                          of all components' magnitudes is at most 1e4 N */
    float force_across_n; /* the same across that plane, to the left; in space only */
} brace_k_question_t;

typedef struct {
    brace_stiffness_t k; /* in the limb's plane; flags: UNCALIBRATED, OUT_OF_RANGE (outside the drives'
                                          travel), and the model's own */
    brace_stiffness_spatial_t in_space; /* in the robot's frame; only after a question in space, else not to be used */
    brace_displacement_t moved_mm; /* by force and weight, in the limb's plane */
    float moved_across_mm; /* the same across that plane; NaN: limb in its plane */
    float buckling_factor; /* infinity: none; NaN: not counted, or limb in space */
} brace_k_answer_t;

#endif
