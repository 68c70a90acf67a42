/* K with CMSIS-DSP's matrix and fast-math functions. */
#ifndef PEER_CMSIS_DSP_H
#define PEER_CMSIS_DSP_H

#include "plain.h"

void cmsis_dsp_stiffness(const plain_limb_t *limb, float theta1, float theta2, plain_stiffness_t *out);

#endif
