/* Types of a loaded link in the limb's plane; brace/loaded.h says what they are for. */
#ifndef BRACE_LOADED_TYPES_H
#define BRACE_LOADED_TYPES_H

#include "brace/vec.h"

/* A link in the femur's frame, as it is loaded. */
typedef struct {
    brace_vec_t to_beam_mm, beam_mm, root_root, end_root;
    brace_vec_t rigid_mm; /* to_beam_mm, and as far as the root's spring moves the beam before anything turns */
    float end_mm_per_n, bend_rad_per_n_mm;
    brace_vec_t beyond_n;       /* the force that the link's end carries: the ground's and the weights beyond */
    brace_vec_t own_n;          /* the link's own weight */
    brace_vec_t on_rigid_n;     /* the force at the root of the beam. The weight lies along the straight link, so that
                                   of a tilted link acts half along its rigid part. */
} brace_loaded_seen_t;

/* The coordinates of a link: how far its root has turned from the commanded direction, and its two curvatures, each as
 * the turn at one of the Gauss points 1/2 -+ 1/(2 sqrt 3). The curvature is linear between and beyond them. */
typedef struct {
    float root, a, b;
} brace_loaded_shape_t;

#endif
