/* The statics of a body that stands on several position-controlled limbs: what each foot bears, how the body moves,
 * which foot slides first.
 *
 * A limb is a spring with stiffness K (3 x 3) between the body and its foot, so a body on three limbs or more is
 * statically indeterminate: the limbs' stiffness decides who carries what. The ground holds a foot by Coulomb's law:
 * it presses, or grips up to a limit; the foot sticks while |tangential force| <= friction (normal force + grip), and
 * else slides against that force. What slid stays where it is: the same load has other forces after a slip, so a state
 * is kept and moved from load to load.
 *
 * The law is linear in displacements, with the turning of preloaded feet and loads to first order; who wants K under
 * load gives K and the tip's displacement at a force (docs/stance.md has formulas and sources).
 *
 * Units: mm, N, N mm, rad. Vectors are in the body's frame before it moves: x forward, y left, z up. No heap; pure
 * functions of their arguments; any thread. Plain C; the library is C++17 with Eigen.
 */
#ifndef BRACE_STANCE_H
#define BRACE_STANCE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BRACE_STANCE_LIMBS 8 /* at most */

typedef enum {
    BRACE_STANCE_OK = 0,
    BRACE_STANCE_E_INPUT = -1,      /* a number that is not finite, or outside its range */
    BRACE_STANCE_E_LOOSE = -2,      /* the limbs do not hold the body: it can turn or move without resistance */
    BRACE_STANCE_E_NO_REST = -3     /* no equilibrium: too many feet slide or are off the ground */
} brace_stance_status_t;

/* How the ground holds a foot. */
typedef enum {
    BRACE_FOOT_STICKS = 0,
    BRACE_FOOT_SLIDES = 1,
    BRACE_FOOT_OPEN = 2,   /* off the ground; it bears again where it comes down */
    BRACE_FOOT_LET_GO = 3  /* its grip was pulled off, or it was lifted: it bears nothing from then on */
} brace_foot_contact_t;

typedef struct {
    double foot_mm[3];    /* its tip at the commanded angles without load, from the body's origin */
    double k_n_per_mm[9]; /* K of the tip, body held, rows one after the other; positive definite */
    double force_n[3];    /* the ground's force on the foot that K belongs to: 0 for K without load */
    double moved_mm[3];   /* how far that force moves the tip from foot_mm, body held */
    double normal[3];     /* unit vector out of the ground */
    double friction_ratio; /* 0 to 10 */
    double grip_n;        /* how hard the foot may be pulled, 0 to 1e6; 0: it only presses */
} brace_stance_limb_t;

typedef struct {
    int32_t limb_count; /* 1 to BRACE_STANCE_LIMBS */
    brace_stance_limb_t limb[BRACE_STANCE_LIMBS];
} brace_stance_t;

/* Forces on the body together: brace_stance_load_add adds one. All zero: none. */
typedef struct {
    double force_n[3];
    double moment_n_mm[3]; /* about the body's origin */
    double turning_n_mm[9]; /* how the moment changes by each radian of rotation; rows one after the other */
} brace_stance_load_t;

typedef struct {
    double place_mm[3]; /* where the foot is, from foot_mm */
    double ground_mm; /* how high the ground is, from foot_mm along its normal */
    double force_n[3]; /* the ground's force on the foot */
    int32_t contact; /* brace_foot_contact_t */
} brace_stance_foot_t;

/* The body under a load, with its history. */
typedef struct {
    brace_stance_load_t load;
    double displacement_mm[3]; /* of the body's origin */
    double rotation_rad[3]; /* rotation vector */
    brace_stance_foot_t foot[BRACE_STANCE_LIMBS];
} brace_stance_state_t;

typedef struct {
    double factor; /* of the further load; infinity: none of the feet moves up to the bound */
    int32_t limb; /* the foot that moves first; -1: none */
    int32_t contact; /* what it does then: BRACE_FOOT_SLIDES, BRACE_FOOT_OPEN or BRACE_FOOT_LET_GO */
} brace_stance_slip_t;

/* Adds a force that acts on the body at a place. The force keeps its direction when the body turns. */
void brace_stance_load_add(brace_stance_load_t *load, const double force_n[3], const double at_mm[3]);

/* The body before any load: every foot stands where its tip is, further by its offset, and sticks.
 * offset_mm: limb_count x 3, where the footholds are from where the limbs put them; null: there.
 * state: written on success only. returns OK or E_INPUT. */
int32_t brace_stance_place(const brace_stance_t *stance, const double *offset_mm, brace_stance_state_t *state);

/* Moves the body from the state's load to another one in a straight line. Feet that slide do so in steps.
 * slide_steps: 1 to 1000, steps in which the rest of the way is taken once a foot slides: 1 is an implicit step, 8
 *              follow the turning of a sliding foot's path to about 1 % of its way.
 * state (in, out): after OK under `load`; after E_NO_REST at the share of the way that is borne; else untouched.
 * share: of the way that was gone, 0 to 1; null: not wanted.
 * Cost on an x86 core for six limbs: some 1.2 microseconds where all feet stick; a step in which four slide
 * some 5. */
int32_t brace_stance_settle(const brace_stance_t *stance, const brace_stance_load_t *load, int32_t slide_steps,
                            brace_stance_state_t *state, double *share);

/* The first foot that slides, opens or lets go when a further load grows in a straight line, the feet that do not
 * slide sticking until then. A foot that slid on the way to this state bears its whole friction; it slides on at once
 * where the further load pushes it so.
 * further: the load at factor 1, added to the state's. most: the largest factor of interest, 0 to 1e9.
 * slip: written on success only. returns OK, E_INPUT, E_LOOSE. */
int32_t brace_stance_first_slip(const brace_stance_t *stance, const brace_stance_load_t *further, double most,
                                const brace_stance_state_t *state, brace_stance_slip_t *slip);

/* Takes a foot off the ground: it bears nothing from the next settle on, which the caller asks for.
 * limb: 0 to limb_count - 1, not checked. */
void brace_stance_lift(brace_stance_state_t *state, int32_t limb);

/* Smallest distance of a foot's force from what its ground can hold [N]: to the cone's side by less tangential force,
 * friction (normal + grip) - |tangential|. Negative: beyond. */
double brace_stance_margin_n(const brace_stance_limb_t *limb, const double force_n[3]);

/* The linear law at a load, for who computes with it: forces [N] of all feet, limb after limb, from their places [mm]:
 * force = at_rest + stiffness (place - state's place). stiffness: 3 n rows of 3 n, one after the other; at_rest: 3 n.
 * returns OK, E_INPUT, E_LOOSE. Feet that are off the ground are left out: rows and columns of zero. */
int32_t brace_stance_linear(const brace_stance_t *stance, const brace_stance_load_t *load,
                            const brace_stance_state_t *state, double *stiffness, double *at_rest);

/* One line of English; constant storage, never null. */
const char *brace_stance_status_text(int32_t status);

#ifdef __cplusplus
}
#endif
#endif
