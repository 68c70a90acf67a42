/* Where down is. The parameters say it until the main computer says something else: a robot that climbs turns its
 * limbs' planes. What it says holds until the next start. */
#ifndef BRACE_POSTURE_GRAVITY_H
#define BRACE_POSTURE_GRAVITY_H

#include <stdbool.h>

#include "brace/parameters.h"
#include "brace/status.h"
#include "brace/vec.h"

typedef struct {
    bool is_sent;                   /* sent by the main computer; else it is the parameters' direction */
    float direction_rad, lean_rad;  /* as the parameters' members of these names */
    brace_vec3_t down;              /* in the limb's plane's frame: x outwards, y to the left, z up */
} gravity_t;

/* The parameters' direction, unless the main computer has sent another one. When parameters are put in force; 200
 * instructions. */
void gravity_configure(gravity_t *gravity, const brace_gravity_t *parameters);

/* Another direction, from now on. NaN for both: the parameters' own again.
 * returns BRACE_OK, BRACE_E_NOT_FINITE (one NaN alone), BRACE_E_RANGE (outside the range of the parameter of its
 * name) */
brace_status_t gravity_set(gravity_t *gravity, const brace_gravity_t *parameters, float direction_rad, float lean_rad);

#endif
