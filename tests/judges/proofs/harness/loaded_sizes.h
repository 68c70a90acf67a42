/* Sizes of K under load in fixed point, which one proof promises and another takes: lengths of vectors, magnitudes of
 * numbers, in the formats of loaded/fixed_vec.h. */
#ifndef BRACE_PROOF_LOADED_SIZES_H
#define BRACE_PROOF_LOADED_SIZES_H

#define PART_OF(format, number) ((long long)((number) * (double)(1LL << (format))))

/* Turns (loaded_turns). */
#define DIRECTION_MOST ((1LL << 30) + 2)
#define SMALL_TURN_LEAST PART_OF(30, 0.999)
#define SMALL_TURN_MOST PART_OF(30, 1.001)
#define LARGER_TURN_MOST PART_OF(30, 1.0036)
#define SMALL_SINE_MOST PART_OF(30, 0.986)
#define SMALL_ANGLE_MOST ((int)PART_OF(29, 1.045))
#define LARGER_ANGLE_MOST ((int)PART_OF(29, 1.39)) /* of a strongly bent link */

/* Angles of a shape as is_shape of fixed_solve.h keeps them (loaded_solve), and at points of it (loaded_words). */
#define ROOT_ANGLE_MOST (PART_OF(29, 3.1) + 4)
#define CURVATURE_MOST (PART_OF(29, 1.2) + 4)
#define IS_SHAPE(root, a, b) \
    ((root) <= ROOT_ANGLE_MOST && (a) <= CURVATURE_MOST && (b) <= CURVATURE_MOST && \
     (root) + (a) + ((a) >> 3) + (b) <= \
         PART_OF(29, 3.9) + 20) /* magnitudes; of four numbers in q27, and their ends */
#define FIRST_MOST PART_OF(29, 3.47)
#define SECOND_MOST PART_OF(29, 3.88)
#define NEAR_MOST PART_OF(29, 0.694) /* from the root to the first, from the second to the end */
#define FAR_MOST PART_OF(29, 1.387) /* from the first to the second */

/* A link: the unit of length is above the reach, the unit of force above the loads, springs move by a quarter. The
 * tilt is a quarter turn at most, so that the way to the beam is the root of two times as long. Of two links the
 * shorter one is half of the reach at most. */
#define LENGTH_OFF 96
#define BEAM_MOST (PART_OF(28, 1.0) + LENGTH_OFF)
#define TO_BEAM_MOST (PART_OF(28, 1.41422) + LENGTH_OFF)
#define HALF_BEAM_MOST (PART_OF(28, 0.5) + LENGTH_OFF)
#define HALF_TO_BEAM_MOST (PART_OF(28, 0.70711) + LENGTH_OFF)
#define SPRING_MOST (PART_OF(30, 0.5) + 300)
#define RIGID_MOST (TO_BEAM_MOST + PART_OF(28, 0.25) + 256)
#define FORCE_UNIT PART_OF(30, 1.0)
#define FORCE_MOST (FORCE_UNIT + 256)
#define DOWN_MOST_64THS 91 /* a direction whose parts are 1.001 is as long, and a little more */
#define FORCE_EXPONENT_LEAST (-6)
#define FORCE_MOST_EXPONENT 40
#define SPRING_GIVES_MOST PART_OF(30, 0.503) /* turned, along a force or across */
#define END_MOST PART_OF(30, 0.25)

/* What a link tells on the way (loaded_link), and at the equilibrium. */
#define RESISTS_MOST PART_OF(27, 2.7)
#define END_RESISTS_MOST PART_OF(27, 0.26)
#define ROOT_DRIVES_MOST PART_OF(27, 9.6)
#define DRIVES_MOST PART_OF(27, 4.0)
#define END_DRIVES_MOST PART_OF(27, 1.18)
#define REST_MOST PART_OF(27, 3.0)
#define SOFTENS_MOST PART_OF(27, 0.51)
#define TIP_MOST PART_OF(28, 3.2)
#define HALF_TIP_MOST PART_OF(28, 1.97)
#define LEVER_MOST PART_OF(28, 1.3)
#define ASIDE_MOST PART_OF(28, 0.77)

/* loaded_solve promises these sizes of ratios and compliances, loaded_levers of the levers behind C. */
#define RATIO_MOST PART_OF(27, 4.0)
#define BEYOND_MOST PART_OF(28, 4.0)

/* C, with its springs, and what rounding adds off the diagonal: 2^33 for each of six levers. */
#define C_MOST ((1ull << 62) + (1ull << 58))
#define C_ROUNDED (1LL << 36)

/* The search for the buckling factor: its units (loaded_search), and the limb under a multiple of its load
 * (loaded_softened). */
#define SEARCH_MOMENT_MOST (1LL << 27)
#define SEARCH_SOFTENS_MOST (1LL << 23)
#define SEARCH_COMPLIANCE_MOST ((1LL << 29) - 1)
#define SEARCH_UNITS_LEAST (-50)
#define SEARCH_UNITS_MOST 10
#define SEARCH_EXPONENT_MOST 128

#endif
