/* Eigenvalues and eigenvectors of a symmetric matrix in space. */
#ifndef BRACE_CORE_EIGEN_H
#define BRACE_CORE_EIGEN_H

#include <float.h>
#include <math.h>

#include "base/fma.h"
#include "base/inline.h"
#include "brace/loaded_space_types.h"
#include "brace/vec.h"

/* A matrix on its way to diagonal form, and its axes so far. */
typedef struct {
    float xx, xy, xz, yy, yz, zz;
    brace_vec3_t x, y, z;
} brace_jacobi_t;

INLINE void brace_jacobi_pair(float *p, float *q, float c, float s)
{
    const float old = *p;
    *p = brace_fma(c, old, -(s * *q));
    *q = brace_fma(s, old, c * *q);
}

/* Turns two axes p and q, by at most an eighth of a turn, so that their entry pq vanishes. r: the third axis. */
INLINE void brace_jacobi_turn(float *pp, float *pq, float *qq, float *rp, float *rq, brace_vec3_t *p, brace_vec3_t *q)
{
    const float apart = *qq - *pp, twice = 2.0f * *pq;
    const float root = sqrtf(brace_fma(apart, apart, brace_fma(twice, twice, FLT_MIN)));
    const float tangent = twice / (apart + copysignf(root, apart));
    const float c = 1.0f / sqrtf(brace_fma(tangent, tangent, 1.0f)), s = tangent * c;
    *pp = brace_fma(-tangent, *pq, *pp);
    *qq = brace_fma(tangent, *pq, *qq);
    *pq = 0.0f;
    brace_jacobi_pair(rp, rq, c, s);
    brace_jacobi_pair(&p->x, &q->x, c, s);
    brace_jacobi_pair(&p->y, &q->y, c, s);
    brace_jacobi_pair(&p->z, &q->z, c, s);
}

/* Jacobi's method: three rounds of three turns. Writes m: its diagonal is the eigenvalues of k, in no order, each
 * within 3e-7 of the largest one's size, and its axes are the eigenvectors. The first turn leaves nothing off the
 * diagonal where only xz is off it. */
INLINE void brace_jacobi(const brace_k3_t *k, brace_jacobi_t *m)
{
    *m = (brace_jacobi_t){.xx = k->xx_n_per_mm,
                          .xy = k->xy_n_per_mm,
                          .xz = k->xz_n_per_mm,
                          .yy = k->yy_n_per_mm,
                          .yz = k->yz_n_per_mm,
                          .zz = k->zz_n_per_mm,
                          .x = {1.0f, 0.0f, 0.0f},
                          .y = {0.0f, 1.0f, 0.0f},
                          .z = {0.0f, 0.0f, 1.0f}};
    for (int i = 0; i < 3; i++) {
        brace_jacobi_turn(&m->xx, &m->xz, &m->zz, &m->xy, &m->yz, &m->x, &m->z);
        brace_jacobi_turn(&m->xx, &m->xy, &m->yy, &m->xz, &m->yz, &m->x, &m->y);
        brace_jacobi_turn(&m->yy, &m->yz, &m->zz, &m->xy, &m->xz, &m->y, &m->z);
    }
}

#endif
