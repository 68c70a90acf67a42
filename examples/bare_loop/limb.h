/* The limb 'paper-limb' as const data, for a program that has Brace's core.
 *
 *     limb_check()    once, at the start; use the limb only where it returns BRACE_OK
 *     brace_planar_stiffness(&limb_planar, theta1_rad, theta2_rad, &k)    in every tick
 *
 * Angles are true ones: brace_limb_true_angle adds a joint's zero offset to what is commanded. All data are const and
 * may stay in flash. With -fdata-sections and -Wl,--gc-sections only what is used is linked.
 *
 * Written by brace export --c from a limb.toml; do not edit: change the limb.toml and export it again. */
#ifndef LIMB_H
#define LIMB_H

#if defined(__has_include)
#if __has_include("brace_core.h")
#define BRACE_IS_TWO_FILES 1
#endif
#endif
#ifdef BRACE_IS_TWO_FILES
#include "brace_core.h"
#elif defined(__cplusplus)
#include <cfloat> // the headers' own, outside of extern "C"
#include <cmath>
#include <cstddef>
#include <cstdint>
extern "C" {
#include "brace/brace.h"
}
#else
#include "brace/brace.h"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What a controller with these parameters reports as its parameter_crc, and brace params pack prints. */
#define LIMB_PARAMETER_CRC 0xb35ecd30u

/* Lengths [mm], compliances, zero offsets, trust; members are named as the keys of limb.toml. */
extern const brace_limb_t limb;
/* Weights of its parts [N], and where they pull. */
extern const brace_gravity_t limb_weights;

/* The limb collapsed for the tick, each to be read by its function alone. */
extern const brace_planar_t limb_planar; /* K at no load: brace_planar_stiffness */
extern const brace_loaded_t limb_loaded; /* K under a load: brace_loaded_stiffness */

/* Are these the numbers that were exported, and are the constants those that the linked core makes of them?
 * returns BRACE_OK; BRACE_E_CHECKSUM: a number of the limb has changed since it was exported;
 *         BRACE_E_SCHEMA: a constant has changed, or the core is of another version: export the limb again;
 *         or what brace_limb_check says.
 * Cost: as much as collapsing the limb. */
brace_status_t limb_check(void);

#ifdef __cplusplus
}
#endif

#endif
