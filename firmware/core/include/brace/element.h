/* One source of compliance in the limb's plane, as a vector v of the posture: it adds v v' to C.
 *
 * Seen from the bisector of femur and tibia, with h = theta2/2: v = straight cos h + folded sin h. So `straight` is v
 * at the straight knee and `folded` is v at the folded knee. A v that vanishes there is stored as an exact zero.
 */
#ifndef BRACE_ELEMENT_H
#define BRACE_ELEMENT_H

#include "brace/vec.h"

typedef struct {
    brace_vec_t straight, folded; /* [sqrt(mm/N)] */
} brace_element_t;

/* The elements of a limb that turn with its links: first those of the links, then those of the joints. */
enum {
    BRACE_FEMUR_ELLIPSOID = 0, /* the femur's compliance along one axis beyond that along the other */
    BRACE_FEMUR_MOMENT = 1,    /* bending of the femur together with the moment that it passes on */
    BRACE_TIBIA_ELLIPSOID = 2,
    BRACE_LINK_ELEMENT_COUNT = 3,
    BRACE_HIP_SPRING = 3,  /* joint 1 and the base's rotation, which have one lever */
    BRACE_KNEE_SPRING = 4, /* joint 2 */
    BRACE_ELEMENT_COUNT = 5
};

#endif
