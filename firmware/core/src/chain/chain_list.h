/* The chain as a bare list, for those who have no room on their stack for a whole brace_chain_t. */
#ifndef BRACE_CHAIN_LIST_H
#define BRACE_CHAIN_LIST_H

#include "brace/chain.h"

/* Femur ellipsoid, femur moment transfer, tibia ellipsoid, joints 1 and 2: the elements without base part. */
enum { BRACE_CHAIN_FIRM = 5 };

/* Writes those five, zero where nothing yields, and returns their iso. limb has passed brace_limb_check. */
float brace_chain_firm(const brace_limb_t *limb, brace_element_t element[BRACE_CHAIN_FIRM]);

/* The coxa link's two, ellipsoid and moment transfer, and the base's one: what has a base part. The coxa lies along x,
 * its moment is that of the tip force about the hip. Each returns its iso. */
float brace_chain_coxa(const brace_limb_t *limb, brace_element_t element[2]);
float brace_chain_base(const brace_limb_t *limb, brace_element_t *element);

/* Writes the limb's elements that are not zero, those of the coxa and of the base last, and their number;
 * returns iso. element: room for BRACE_CHAIN_MAX. limb has passed brace_limb_check. */
float brace_chain_list(const brace_limb_t *limb, int with_coxa, brace_element_t *element, uint32_t *count);

/* brace_harmonics of a bare list; base parts are not looked at, femur and tibia parts are used up.
 * count: [0, BRACE_CHAIN_MAX] */
void brace_harmonics_list(float iso, brace_element_t *element, uint32_t count, brace_harmonics_t *harmonics);

/* The same of the elements alone, up to end, at most BRACE_CHAIN_MAX: iso is neither in nor written. */
void brace_harmonics_sum(brace_element_t *element, const brace_element_t *end, brace_harmonics_t *harmonics);

#endif
