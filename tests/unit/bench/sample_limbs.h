/* Limbs that between them use every term of the planar model. */
#ifndef SAMPLE_LIMBS_H
#define SAMPLE_LIMBS_H

#include "brace/limb.h"

#define SAMPLE_TRUST \
    { \
        0.5f, 0.003f, 0.05f, 0.005f \
    }
#define SAMPLE_COXA \
    { \
        0.0005f, 0.004f, 0.1f, 0.005f, 1.0e-6f, 0.7f \
    }
#define SAMPLE_NO_BASE \
    { \
        0.0f, 0.0f, 0.0f \
    }

enum {
    SAMPLE_PAPER = 0,
    SAMPLE_BEAM,
    SAMPLE_TILTED,
    SAMPLE_EQUAL,
    SAMPLE_SLENDER,
    SAMPLE_ROUND,
    SAMPLE_APART,
    SAMPLE_COUNT
};

static const brace_limb_t sample_limb[SAMPLE_COUNT] = {
    [SAMPLE_PAPER] = {57.0f,
                      185.0f,
                      313.5f,
                      {SAMPLE_COXA, {0.001f, 0.06f, 0, 0.06f, 2e-6f, 0}, {0.002f, 0.25f, 0, 0.25f, 0, 0}},
                      {{1.2e-5f, 0, 0}, {1.0e-5f, 0, 0}, {1.6e-5f, 0, 0}},
                      SAMPLE_NO_BASE,
                      SAMPLE_TRUST},
    [SAMPLE_BEAM] = {57.0f,
                     185.0f,
                     313.5f,
                     {SAMPLE_COXA, {0.001f, 0.06f, 0, 0.06f, 2e-6f, 1.0f}, {0.002f, 0.25f, 0, 0.25f, 0, 0}},
                     {{0, 0, 0}, {1.0e-5f, 0, 0}, {1.6e-5f, 0, 0}},
                     {0.01f, 0.01f, 2e-6f},
                     SAMPLE_TRUST},
    [SAMPLE_TILTED] = {57.0f,
                       150.0f,
                       240.0f,
                       {SAMPLE_COXA, {0.003f, 0.09f, -0.5f, 0.09f, 0, 0.4f}, {0.004f, 0.2f, 0.45f, 0.2f, 0, 0}},
                       {{1e-5f, 0, 0}, {6e-6f, 0, 0}, {9e-6f, 0, 0}},
                       SAMPLE_NO_BASE,
                       SAMPLE_TRUST},
    [SAMPLE_EQUAL] = {57.0f,
                      250.0f,
                      250.0f,
                      {SAMPLE_COXA, {0.001f, 0.06f, 0, 0.06f, 0, 0}, {0.002f, 0.25f, 0, 0.25f, 0, 0}},
                      {{0, 0, 0}, {4.0e-5f, 0, 0}, {0, 0, 0}},
                      SAMPLE_NO_BASE,
                      SAMPLE_TRUST},
    [SAMPLE_SLENDER] = {57.0f,
                        185.0f,
                        313.5f,
                        {SAMPLE_COXA, {6e-5f, 0.06f, 0.2f, 0.06f, 0, 0}, {2.5e-4f, 0.25f, -0.5f, 0.25f, 0, 0}},
                        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                        SAMPLE_NO_BASE,
                        SAMPLE_TRUST},
    [SAMPLE_ROUND] = {57.0f,
                      185.0f,
                      313.5f,
                      {SAMPLE_COXA, {0.05f, 0.05f, 0, 0.05f, 0, 0}, {0.1f, 0.1f, 0.2f, 0.1f, 0, 0}},
                      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},
                      SAMPLE_NO_BASE,
                      SAMPLE_TRUST},
    /* its two softest directions are never parallel */
    [SAMPLE_APART] = {57.0f,
                      111.9f,
                      355.7f,
                      {SAMPLE_COXA, {0.00067f, 0.0035f, 0, 0.0035f, 0, 1.0f}, {0.0043f, 0.194f, -0.364f, 0.194f, 0, 0}},
                      {{0, 0, 0}, {2.36e-5f, 0, 0}, {0, 0, 0}},
                      SAMPLE_NO_BASE,
                      SAMPLE_TRUST},
};

#endif
