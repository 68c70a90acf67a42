#include "brace/chain.h"

#include <stddef.h>

#include "chain/chain_list.h"
#include "base/off_tick.h"
#include "base/vec.h"

/* Half the trace and deviator of sum v v': of folded folded', straight straight' and straight folded' in turn, which
 * come with sin^2 h, cos^2 h and sin theta2. */
static void sum_squares(const brace_swing_t element[BRACE_CHAIN_FIRM], brace_harmonic_t *harmonic)
{
    float *to = &harmonic->at_fold;
    for (int term = 0; term < 3; term++) {
        const int first = term == 0, second = term != 1;
        float xx = 0.0f, xz = 0.0f, zz = 0.0f;
        for (const brace_swing_t *e = element; e < element + BRACE_CHAIN_FIRM; e++) {
            const brace_vec_t a = e->part[first], b = e->part[second];
            xx = __builtin_fmaf(a.x, b.x, xx);
            zz = __builtin_fmaf(a.z, b.z, zz);
            xz = __builtin_fmaf(a.x, b.z, xz);
            xz = __builtin_fmaf(a.z, b.x, xz);
        }
        to[term] = 0.5f * (xx + zz);
        to[term + 3] = 0.5f * (xx - zz);
        to[term + 6] = 0.5f * xz;
    }
    for (int i = 0; i < 3; i++) {
        harmonic[i].per_cos = 0.5f * (harmonic[i].per_cos - harmonic[i].at_fold);
    }
}

/* Sums over all pairs of elements of what their crosses are along and across a direction of (1 + cos, sin)/2. */
typedef struct {
    float aa, ab, bb, rb, rr, ra;
} crosses_t;

/* Next to nothing [(mm/N)^2]: it keeps the quotients of sums finite where there is nothing to sum. */
#define NEARLY_NOTHING 1e-30f

/* With u = (1 + cos, sin)/2 each cross is k + a n.u + b s.u, n = s turned clockwise; r = c b - k. */
static crosses_t sum_crosses(const brace_swing_t element[BRACE_CHAIN_FIRM], brace_vec_t s, float c)
{
    crosses_t sum = {.bb = NEARLY_NOTHING};
    for (const brace_swing_t *e = element + 1; e < element + BRACE_CHAIN_FIRM; e++) { /* at most BRACE_CHAIN_FIRM */
        for (const brace_swing_t *o = element; o < e; o++) {
            const brace_vec_t p = o->straight, q = o->folded, ep = e->straight, eq = e->folded;
            /* In this order of factors what must vanish does so exactly. */
            const float minus_fold = vec_cross(eq, q);
            const brace_vec_t slope = {vec_cross(p, ep) + minus_fold, vec_cross(p, eq) - vec_cross(ep, q)};
            const float a = vec_cross(slope, s), b = vec_dot(slope, s);
            const float r = __builtin_fmaf(c, b, minus_fold);
            sum.aa = __builtin_fmaf(a, a, sum.aa);
            sum.ab = __builtin_fmaf(a, b, sum.ab);
            sum.bb = __builtin_fmaf(b, b, sum.bb);
            sum.rb = __builtin_fmaf(r, b, sum.rb);
            sum.rr = __builtin_fmaf(r, r, sum.rr);
            sum.ra = __builtin_fmaf(r, a, sum.ra);
        }
    }
    return sum;
}

/* The squares of all crosses gather into one square of c + s.u and a remainder that is linear in u because
 * |u|^2 = (1 + cos)/2:
 *     sum cross^2 = (B (c + s.u))^2 + sum a^2 (c^2 + 2 c s.u + (1 + cos)/2) + sum r^2 - 2 (sum r a) n.u
 * with s, of length one, the direction in which the sum varies most, c = sum k b / sum b^2, B^2 = sum b^2 - sum a^2.
 * Only squares are added, each pass along the s and c that the one before has found: the sums as differences of
 * larger ones would lose the digits that matter. */
enum { PASSES = 4 };

static void gather_crosses(const brace_swing_t element[BRACE_CHAIN_FIRM], brace_harmonics_t *harmonics)
{
    brace_vec_t s = {0.0f, 1.0f};
    float c = 0.0f, amplitude;
    crosses_t sum;
    for (int pass = 1;; pass++) {
        sum = sum_crosses(element, s, c);
        const float half = 0.5f * (sum.bb - sum.aa);
        const float radius = __builtin_sqrtf(__builtin_fmaf(half, half, sum.ab * sum.ab));
        if (pass == PASSES) {
            amplitude = __builtin_sqrtf(__builtin_fabsf(half) + radius);
            break;
        }
        if (half < 0.0f) {
            s = (brace_vec_t){s.z, -s.x};
        } else {
            const float tangent = sum.ab / (half + radius);
            s = (brace_vec_t){__builtin_fmaf(tangent, s.z, s.x), __builtin_fmaf(-tangent, s.x, s.z)};
            c -= __builtin_fmaf(tangent, sum.ra, sum.rb) / sum.bb; /* sum k b as it is along the new s */
        }
    }
    /* The length of s has grown, and with it a and b. */
    const float square = vec_dot(s, s), c_a = c * sum.aa;
    const brace_vec_t per_b = vec_scaled(s, 0.5f * amplitude / square);
    harmonics->cross = (brace_harmonic_t){c * amplitude, per_b.x, per_b.z};
    harmonics->rest = (brace_harmonic_t){sum.rr + c * c_a, (0.5f * sum.aa + c_a * s.x - sum.ra * s.z) / square,
                                         (c_a * s.z + sum.ra * s.x) / square};
}

BRACE_OFF_TICK void brace_harmonics_sum(const brace_swing_t element[BRACE_CHAIN_FIRM], brace_harmonics_t *harmonics)
{
    sum_squares(element, &harmonics->mean);
    gather_crosses(element, harmonics);
}

/* det (A + iso I) = det A + iso trace A + iso^2 */
static inline void add_iso(brace_harmonics_t *harmonics, float iso_mm_per_n)
{
    const float twice = 2.0f * iso_mm_per_n;
    harmonics->rest.at_fold += iso_mm_per_n * iso_mm_per_n + twice * harmonics->mean.at_fold;
    harmonics->rest.per_cos += twice * harmonics->mean.per_cos;
    harmonics->rest.per_sin += twice * harmonics->mean.per_sin;
    harmonics->mean.at_fold += iso_mm_per_n;
    harmonics->iso_mm_per_n = iso_mm_per_n;
}

BRACE_OFF_TICK brace_status_t brace_harmonics(const brace_chain_t *chain, brace_harmonics_t *harmonics)
{
    if (chain == NULL || harmonics == NULL) {
        return BRACE_E_NULL;
    }
    if (chain->count > BRACE_CHAIN_FIRM) {
        return BRACE_E_UNSUPPORTED;
    }
    brace_swing_t element[BRACE_CHAIN_FIRM] = {0};
    for (uint32_t i = 0; i < chain->count; i++) {
        if (vec_dot(chain->element[i].base, chain->element[i].base) > 0.0f) {
            return BRACE_E_UNSUPPORTED;
        }
        element[i] = brace_halved(chain->element[i].femur, chain->element[i].tibia);
    }
    brace_harmonics_sum(element, harmonics);
    add_iso(harmonics, chain->iso_mm_per_n);
    return BRACE_OK;
}
