/* Eigenvalues of a symmetric matrix in space. */
#ifndef BRACE_CORE_EIGEN_H
#define BRACE_CORE_EIGEN_H

#include <float.h>
#include <math.h>

#include "base/fma.h"
#include "base/inline.h"

/* A matrix on its way to diagonal form, and its axes so far: x, y and z, each as three numbers. */
typedef struct {
    float xx, xy, xz, yy, yz, zz;
    float x[3], y[3], z[3];
} brace_jacobi_t;

/* Turns axes p and q so that their off-diagonal entry vanishes, by at most an eighth of a turn. r: the third axis. */
INLINE void brace_jacobi_turn(float *pp, float *pq, float *qq, float *rp, float *rq, float p[3], float q[3])
{
    const float apart = *qq - *pp, twice = 2.0f * *pq;
    const float root = sqrtf(brace_fma(apart, apart, brace_fma(twice, twice, FLT_MIN)));
    const float tangent = twice / (apart + (apart < 0.0f ? -root : root));
    const float c = 1.0f / sqrtf(brace_fma(tangent, tangent, 1.0f)), s = tangent * c;
    const float old_rp = *rp;
    *pp = brace_fma(-tangent, *pq, *pp);
    *qq = brace_fma(tangent, *pq, *qq);
    *pq = 0.0f;
    *rp = brace_fma(c, old_rp, -(s * *rq));
    *rq = brace_fma(s, old_rp, c * *rq);
    for (int i = 0; i < 3; i++) {
        const float old = p[i];
        p[i] = brace_fma(c, old, -(s * q[i]));
        q[i] = brace_fma(s, old, c * q[i]);
    }
}

/* Jacobi's method: each turn makes one entry vanish; two rounds of three and one more turn leave off the diagonal what
 * rounding does. m: its axes need not be set; its diagonal is then the eigenvalues, in no order, and its axes are the
 * eigenvectors. */
INLINE void brace_jacobi(brace_jacobi_t *m)
{
    *m = (brace_jacobi_t){m->xx, m->xy, m->xz, m->yy, m->yz, m->zz, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f},
                          {0.0f, 0.0f, 1.0f}};
    for (int round = 0; round < 3; round++) {
        brace_jacobi_turn(&m->xx, &m->xy, &m->yy, &m->xz, &m->yz, m->x, m->y);
        brace_jacobi_turn(&m->yy, &m->yz, &m->zz, &m->xy, &m->xz, m->y, m->z);
        brace_jacobi_turn(&m->xx, &m->xz, &m->zz, &m->xy, &m->yz, m->x, m->z);
    }
}

#endif
