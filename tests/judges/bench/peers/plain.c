/* The planar K in plain C. */
#include "plain.h"

#include <math.h>

/* A symmetric 2x2 matrix and a vector of the plane. */
typedef struct {
    float xx, xz, zz;
} sym2_t;

typedef struct {
    float x, z;
} vec2_t;

/* c += s v v' */
static void add_outer(sym2_t *c, float s, vec2_t v)
{
    c->xx += s * v.x * v.x;
    c->xz += s * v.x * v.z;
    c->zz += s * v.z * v.z;
}

/* c += s (v w' + w v') */
static void add_coupling(sym2_t *c, float s, vec2_t v, vec2_t w)
{
    c->xx += 2.0f * s * v.x * w.x;
    c->xz += s * (v.x * w.z + v.z * w.x);
    c->zz += 2.0f * s * v.z * w.z;
}

void plain_stiffness(const plain_limb_t *limb, float theta1, float theta2, plain_stiffness_t *out)
{
    const plain_link_t *femur = &limb->femur, *tibia = &limb->tibia;
    const float angle2 = theta1 - theta2;
    const vec2_t along1 = {cosf(theta1), sinf(theta1)}, across1 = {-along1.z, along1.x};
    const vec2_t along2 = {cosf(angle2), sinf(angle2)}, across2 = {-along2.z, along2.x};
    const vec2_t shank = {tibia->length * along2.x, tibia->length * along2.z};
    const vec2_t tip = {femur->length * along1.x + shank.x, femur->length * along1.z + shank.z};
    const vec2_t lever1 = {-tip.z, tip.x}, lever2 = {-shank.z, shank.x};

    sym2_t c = {0.0f, 0.0f, 0.0f};
    add_outer(&c, femur->axial, along1);
    add_outer(&c, femur->bending, across1);
    add_outer(&c, tibia->axial, along2);
    add_outer(&c, tibia->bending, across2);
    add_outer(&c, limb->joint[1], lever1);
    add_outer(&c, limb->joint[2], lever2);
    if (femur->moment_transfer != 0.0f) {
        const float b = femur->bending * femur->moment_transfer;
        add_coupling(&c, 1.5f * b / femur->length, across1, lever2);
        add_outer(&c, 3.0f * b / (femur->length * femur->length), lever2);
    }

    const float det = c.xx * c.zz - c.xz * c.xz;
    out->k_xx = c.zz / det;
    out->k_xz = -c.xz / det;
    out->k_zz = c.xx / det;
    const float half_trace = 0.5f * (out->k_xx + out->k_zz);
    const float half_difference = 0.5f * (out->k_xx - out->k_zz);
    const float radius = sqrtf(half_difference * half_difference + out->k_xz * out->k_xz);
    out->lambda_min = half_trace - radius;
    out->lambda_max = half_trace + radius;
    out->stiff_axis = 0.5f * atan2f(out->k_xz, half_difference);
}
