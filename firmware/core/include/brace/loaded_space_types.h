/* Types of K in space under a load; brace/loaded_space.h says what they are for. */
#ifndef BRACE_LOADED_SPACE_TYPES_H
#define BRACE_LOADED_SPACE_TYPES_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/buckling_search.h"
#include "brace/loaded.h"
#include "brace/stiffness.h"
#include "brace/vec.h"

/* One link. Its own frame: x along it, y across it in the limb's plane, counter-clockwise, z = x cross y. */
typedef struct {
    float length_mm;
    brace_vec_t stretch_root;  /* axial spring: this vector v adds v v' [sqrt(mm/N)] */
    brace_vec_t across;        /* direction of the bending in the plane, turned by the tilt */
    float twist_rad_per_n_mm, sideways_rad_per_n_mm, bend_rad_per_n_mm; /* the link's own turns about x, y and z */
    float across_mm_per_n, sideways_mm_per_n; /* what moves its end and turns nothing */
    float end_share, stretch_end_share; /* the part of the link's turn that these springs, and the axial one, follow,
                                           less one half */
    float twist_share;         /* the part of the link's twist that its chord and those springs follow */
    float twist_end_half;      /* half the part of the twist that is at the link's end and follows its whole turn */
    float curl_per_mm;         /* twist for each mm of these springs and each radian of bending */
    float across_spread_per_n_mm, sideways_spread_per_n_mm; /* twist's compliance for each squared radian of bending */
    float shortens_per_mm; /* by those springs */
    brace_vec_t tilt_mm; /* how the end moves with the turn in the plane, */
    brace_vec_t bow_mm; /* and with its square */
    float twelfth_mm; /* of the length */
    float own_share; /* of the link's weight, on those springs */
    float weight_n;
} brace_space_link_t;

/* A collapsed limb. brace_loaded_space_collapse writes it; other code must not read its members. */
typedef struct {
    brace_space_link_t coxa, femur, tibia;
    float beyond_coxa_n, beyond_femur_n; /* weight that these links' ends carry */
    float base_x_mm_per_n, base_z_mm_per_n, base_rotation_rad_per_n_mm;
} brace_loaded_space_t;

/* In the limb's plane's frame: x outwards, y to the left, z up. */
typedef struct {
    float xx_n_per_mm, xy_n_per_mm, xz_n_per_mm, yy_n_per_mm, yz_n_per_mm, zz_n_per_mm;
} brace_k3_t;

typedef struct {
    brace_vec3_t tip_n; /* force of the ground on the tip, |x| + |y| + |z| at most 1e4 */
    brace_vec3_t down; /* direction of the weight, a unit vector */
    brace_loaded_joint_t yaw, hip, knee; /* without the base's rotation */
} brace_space_load_t;

/* Turns of a limb's links and joints from their commanded angles [rad]; a link's about its own axes. */
typedef struct {
    brace_vec3_t coxa, femur, tibia;
    float base, yaw, hip, knee;
} brace_space_pose_t;

/* Cosine and sine (x, z) of the turns from the base to the tip. A link turns half way, then its own half about y, which
 * leads to its frame, its twist about x, and the other half about y. */
typedef struct {
    brace_vec_t base, yaw, coxa_z, coxa_y, coxa_x, hip, femur_y, femur_x, knee, tibia_y;
} brace_space_turns_t;

/* A bent link in its frame. */
typedef struct {
    brace_vec3_t chord_mm; /* from its root to its end */
    brace_vec3_t across, sideways; /* how the end's springs move it */
    brace_vec_t by_bend_mm; /* how the chord changes with the turn about z, */
    float by_sideways_mm; /* and about y */
    float across_curl, sideways_curl; /* how far the axes of the turns about y and z lean to -x */
    brace_vec3_t beyond_n, own_n; /* the force that the end carries, and the link's own weight */
} brace_space_bent_t;

/* An equilibrium. Other code must not read its members. */
typedef struct {
    brace_vec_t hip_commanded, knee_commanded; /* directions of the femur, and of the tibia seen from it */
    brace_space_pose_t pose;
    brace_space_turns_t turns;
    brace_space_bent_t coxa, femur, tibia;
    brace_vec3_t tip_n, down, whole_n; /* the load, and the force on the base, in the limb's plane's frame */
    brace_loaded_joint_t yaw, hip, knee; /* as in the load */
    float left_rad2; /* square of what the last round of steps has left */
} brace_space_rest_t;

#define BRACE_SPACE_COXA_PARTS 2 /* parts of the coxa link, for the buckling factor (loaded/space_parts.h) */
#define BRACE_SPACE_PARTS 4 /* parts of the whole limb */

/* A part of a link in its frame. Other code must not read its members. */
typedef struct {
    brace_vec_t about_x, about_y, about_z; /* turns from its root: about y, x, y, then z to what is beyond */
    brace_vec3_t chord_mm, beyond_n, own_n;
    float across_curl, sideways_curl; /* as in brace_space_bent_t, these three too */
    float by_sideways_mm;
    brace_vec_t by_bend_mm;
    brace_vec_t bend_twice_mm; /* how the chord changes with the square of the turn about z */
    float third_y_rad, third_z_rad; /* a third of the part's turns about y and z */
} brace_space_part_t;

/* The shape that a limb has at an equilibrium, and the forces there; links: coxa, femur, tibia. Other code must not
 * read its members. */
typedef struct {
    brace_space_part_t part[BRACE_SPACE_PARTS];
    brace_vec3_t end_n[BRACE_LINK_COUNT], end_mm[BRACE_LINK_COUNT]; /* on the springs at a link's end; their move */
    brace_vec_t about_joint[BRACE_LINK_COUNT]; /* with the first part's turn before its chord */
    brace_vec_t base, yaw;
    brace_vec3_t whole_n;
    float joint_rad_per_n_mm[BRACE_LINK_COUNT];
} brace_space_shape_t;

/* K at the equilibrium and how the limb stands there, in the limb's plane's frame. */
typedef struct {
    brace_k3_t k;
    brace_vec3_t displacement_mm; /* of the tip, from where it is at these angles without load */
    brace_vec3_t tibia_mm; /* from the knee to the tip at the equilibrium */
    float yaw_turn_rad, hip_turn_rad, knee_turn_rad; /* how far the load has turned the joints, without the base */
    uint32_t flags; /* BRACE_FLAG_NEAR_SINGULAR: no accuracy is promised, see brace/loaded_space.h */
} brace_space_result_t;

/* --- between steps. Other code must not read their members. ---------------------------------------------------- */

/* Of the straight limb: an eliminated coordinate's row, its compliance with the load included, one over its pivot. */
typedef struct {
    brace_vec3_t row;
    float yields, per_pivot;
} brace_space_joint_factor_t;

/* The turns of a link about y and z, in this order; between: the matrix's entry for both. */
typedef struct {
    brace_space_joint_factor_t y, z;
    float between, twist_rad_per_n_mm;
} brace_space_link_factor_t;

typedef struct {
    brace_space_link_factor_t coxa, femur, tibia;
    brace_space_joint_factor_t yaw, hip, knee;
    float base_yields, base_per_pivot;
} brace_space_factors_t;

/* Twists of coxa and femur that bending and springs together make. */
typedef struct {
    float coxa, femur;
} brace_space_curls_t;

/* Of the bent limb: a coordinate's compliance, load included, and how all beyond follows when the places before it
 * turn: its row times that compliance, less. */
typedef struct {
    brace_vec3_t follows;
    float yields;
} brace_space_freedom_t;

/* A link's springs first, then its turns about x, y and z: each adds to those after it. */
typedef struct {
    brace_space_freedom_t across, sideways, x, y, z;
    brace_vec3_t stretch_follows; /* the axial spring: its vector is the link's stretch_root */
    brace_vec3_t by_across, by_sideways; /* to x, y and z */
    float y_by_stretch, z_by_stretch;
    float y_by_x, z_by_x, z_by_y;
} brace_space_link_freedoms_t;

typedef struct {
    brace_space_link_freedoms_t coxa, femur, tibia;
    brace_space_freedom_t yaw, hip, knee;
    float base_yields;
} brace_space_freedoms_t;

/* What all beyond a place resists when it is turned about the axes there, and its moment. */
typedef struct {
    brace_sym3_t resists;
    brace_vec3_t moment_n_mm;
} brace_space_held_t;

/* Of all coordinates: 1 without a load, 0 where the load has softened the limb to nothing. sign_bits: their IEEE bits,
 * or-ed. */
typedef struct {
    uint32_t sign_bits;
    float product;
} brace_space_pivots_t;

/* A search for the buckling factor. */
typedef struct {
    brace_buckling_search_t known;
    float at; /* the multiple of the load that is looked at next */
    uint8_t links_held; /* of the limb under it, from the tip */
    brace_space_held_t held;
    brace_space_pivots_t pivots;
} brace_space_search_t;

/* C so far, and how the tip moves when all beyond a place turns about the axes there; the tip from there and from the
 * knee. All in the limb's plane's frame. */
typedef struct {
    brace_axes_t by_turn;
    brace_sym3_t c;
    brace_vec3_t tip_mm, tibia_mm;
} brace_space_sum_t;

/* On the way to the equilibrium. */
typedef struct {
    brace_space_factors_t factors;
    brace_vec_t hip, knee; /* the joints' directions that the factors are of */
    brace_space_curls_t curls; /* of the shape that the limb is bent to */
    brace_space_pose_t drives; /* what it is still driven by there */
    brace_space_pose_t first; /* the first step of a round */
    float shrinks_ratio2; /* square of a round's second step over its first and second */
} brace_space_settling_t;

/* K that is being worked out. */
typedef struct {
    brace_space_rest_t rest;
    union {
        brace_space_settling_t settling;
        struct {
            brace_space_freedoms_t freedoms;
            brace_axes_t coxa;
            brace_space_sum_t sum;
        } summing;
    } of;
    uint8_t step, rounds; /* rounds: of steps towards the equilibrium that are done */
} brace_space_work_t;

#endif
