/* Eigenvalues and eigenvectors of a symmetric matrix in space, in fixed point: base/eigen.h in integers. */
#ifndef BRACE_CORE_FIXED_SPACE_JACOBI_H
#define BRACE_CORE_FIXED_SPACE_JACOBI_H

#include "fixed/fixed_inverse.h"
#include "fixed_space/frame.h"

/* A matrix on its way to diagonal form, each entry below 2^28, and its axes so far (q30). */
typedef struct {
    fixed_sym3_t m;
    fixed3_t axis[3];
} fixed_jacobi_t;

/* p and q turned: the first to c p - s q, the second to s p + c q. */
INLINE void fixed_jacobi_pair(int32_t *p, int32_t *q, int32_t c_q30, int32_t s_q30)
{
    const int32_t old = *p;
    *p = shifted(sum2(c_q30, old, minus(s_q30), *q), 30);
    *q = shifted(sum2(s_q30, old, c_q30, *q), 30);
}

/* (qq - pp, 2 pq) as large as a word holds below 2^30, its first part not negative; either may be one unit off.
 * Magnitudes below 2^30. */
INLINE fixed_vec_t fixed_twice_turned(int32_t apart, int32_t twice_pq)
{
    const int32_t sign = apart >> 31;
    const uint32_t zeros = leading_zeros(magnitude_of(apart) | magnitude_of(twice_pq) | 1u) - 2u;
    return (fixed_vec_t){(int32_t)((magnitude_of(apart) | 1u) << zeros),
                         (int32_t)((uint32_t)((twice_pq ^ sign) - sign) << zeros)};
}

/* Turns two axes p and q, by at most an eighth of a turn, so that their entry pq vanishes. r: the third axis. The
 * vector (qq - pp, 2 pq) has twice the angle of the turn. */
INLINE void fixed_jacobi_turn(int32_t *pp, int32_t *pq, int32_t *qq, int32_t *rp, int32_t *rq, fixed3_t *p,
                              fixed3_t *q)
{
    const fixed_vec_t twice_turned = fixed_twice_turned(less(*qq, *pp), twice(*pq));
    const fixed_length_t length = fixed_length_of(twice_turned.x, twice_turned.z);
    const int32_t per = (int32_t)length.per_length_q27;
    const int32_t cosine_q26 = high_of((int32_t)((uint32_t)twice_turned.x << (length.shift - 1u)), per);
    const int32_t sine_q26 = high_of((int32_t)((uint32_t)twice_turned.z << (length.shift - 1u)), per);
    const uint32_t square_q32 = ((uint32_t)(ONE_Q27 / 2 + cosine_q26) << 5) - 1u; /* of the cosine of the turn */
    const uint32_t per_c_q27 = fixed_per_root_q27(square_q32);
    const int32_t c_q30 = (int32_t)(high_unsigned(square_q32, per_c_q27) << 3);
    const int32_t s_q30 = times(sine_q26, (int32_t)per_c_q27, 24);
    const int32_t by = times(times(s_q30, (int32_t)per_c_q27, 27), *pq, 30);
    *pp = less(*pp, by);
    *qq = plus(*qq, by);
    *pq = 0;
    fixed_jacobi_pair(rp, rq, c_q30, s_q30);
    fixed_jacobi_pair(&p->x, &q->x, c_q30, s_q30);
    fixed_jacobi_pair(&p->y, &q->y, c_q30, s_q30);
    fixed_jacobi_pair(&p->z, &q->z, c_q30, s_q30);
}

/* As brace_jacobi. */
static void fixed_jacobi(fixed_jacobi_t *j)
{
    fixed_sym3_t *m = &j->m;
    fixed3_t *const x = &j->axis[0], *const y = &j->axis[1], *const z = &j->axis[2];
    *x = fixed3(1 << 30, 0, 0);
    *y = fixed3(0, 1 << 30, 0);
    *z = fixed3(0, 0, 1 << 30);
    for (int i = 0; i < 3; i++) {
        fixed_jacobi_turn(&m->xx, &m->xz, &m->zz, &m->xy, &m->yz, x, z);
        fixed_jacobi_turn(&m->xx, &m->xy, &m->yy, &m->xz, &m->yz, x, y);
        fixed_jacobi_turn(&m->yy, &m->yz, &m->zz, &m->xy, &m->xz, y, z);
    }
}

#endif
