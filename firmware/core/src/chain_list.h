/* The chain as a bare list, for those who need fewer elements than BRACE_CHAIN_MAX on their stack. */
#ifndef BRACE_CHAIN_LIST_H
#define BRACE_CHAIN_LIST_H

#include "brace/chain.h"

/* Elements of a planar limb that none of its base's translation adds to. */
enum { BRACE_CHAIN_FIRM = 5 };

/* Writes the limb's elements, those of the coxa and of the base last, and their number; returns iso.
 * limb has passed brace_limb_check. */
float brace_chain_list(const brace_limb_t *limb, int with_coxa, brace_element_t *element, uint32_t *count);

/* brace_harmonics of a bare list without base parts. */
brace_status_t brace_harmonics_list(float iso, const brace_element_t *element, uint32_t count,
                                    brace_harmonics_t *harmonics);

#endif
