#include "fixed/fixed_det.h"

/* Least det over mean^2. */
#define SLENDER_TILTED 6e-5
#define SLENDER 2e-6
#define TOO_SLENDER 2.5e-7

/* From the float's root by one step of Newton's: no double-precision root is linked in for this. */
static double root(double value)
{
    const double guess = (double)__builtin_sqrtf((float)value);
    return guess > 0.0 ? 0.5 * (guess + value / guess) : 0.0;
}

static double dot(brace_vec_t a, brace_vec_t b)
{
    return (double)a.x * (double)b.x + (double)a.z * (double)b.z;
}

static double cross(brace_vec_t a, brace_vec_t b)
{
    return (double)a.x * (double)b.z - (double)a.z * (double)b.x;
}

static void add(brace_det_harmonic_t *sum, double factor, brace_det_harmonic_t h)
{
    sum->constant += factor * h.constant;
    sum->per_cos += factor * h.per_cos;
    sum->per_sin += factor * h.per_sin;
}

/* Unit vector along which the quadratic form [[cc, cs], [cs, ss]] is largest, and by how much it is larger
 * there. */
typedef struct {
    double cos, sin, more;
} crest_t;

static crest_t crest_of(double cc, double cs, double ss)
{
    const double half = 0.5 * (cc - ss), radius = root(half * half + cs * cs);
    const double x = half > 0.0 ? half + radius : cs, z = half > 0.0 ? cs : radius - half;
    const double length = root(x * x + z * z);
    return length > 0.0 ? (crest_t){x / length, z / length, 2.0 * radius} : (crest_t){0.0, 1.0, 0.0};
}

/* With u = (cos, sin) of the knee angle each pair's v x v is k + p.u, and the sum of their squares is
 * sum k^2 + 2 (sum k p).u + u' P u, P = sum p p' = more s s' + least I with its crest s. Of it
 * more (c + s.u)^2 is the cross, c = sum k p.s / sum (p.s)^2, and what remains is linear in u. */
brace_det_t brace_det_of(float iso, const brace_swing_t *element, uint32_t count)
{
    brace_det_harmonic_t trace = {iso, 0.0, 0.0}, rest = {0.0, 0.0, 0.0};
    double cc = 0.0, cs = 0.0, ss = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const brace_vec_t p = element[i].straight, q = element[i].folded;
        add(&trace, 0.5, (brace_det_harmonic_t){dot(p, p) + dot(q, q), dot(p, p) - dot(q, q), 2.0 * dot(p, q)});
        for (uint32_t j = 0; j < i; j++) {
            const brace_vec_t pj = element[j].straight, qj = element[j].folded;
            const double straight = 0.5 * cross(pj, p), folded = 0.5 * cross(qj, q);
            const brace_det_harmonic_t pair = {straight + folded, straight - folded,
                                               0.5 * (cross(pj, q) - cross(p, qj))};
            add(&rest, pair.constant,
                (brace_det_harmonic_t){pair.constant, 2.0 * pair.per_cos, 2.0 * pair.per_sin});
            cc += pair.per_cos * pair.per_cos;
            cs += pair.per_cos * pair.per_sin;
            ss += pair.per_sin * pair.per_sin;
        }
    }
    const crest_t s = crest_of(cc, cs, ss);
    const double most = 0.5 * (cc + ss + s.more), least = 0.5 * (cc + ss - s.more);
    const double c = most > 0.0 ? 0.5 * (rest.per_cos * s.cos + rest.per_sin * s.sin) / most : 0.0;
    const double amplitude = root(s.more);
    add(&rest, -c * s.more, (brace_det_harmonic_t){c, 2.0 * s.cos, 2.0 * s.sin});
    add(&rest, iso, trace);
    rest.constant += least;
    return (brace_det_t){rest, {c * amplitude, s.cos * amplitude, s.sin * amplitude}};
}

brace_det_extent_t brace_det_extent(const brace_det_harmonic_t *harmonic)
{
    const double swing = root(harmonic->per_cos * harmonic->per_cos + harmonic->per_sin * harmonic->per_sin);
    return (brace_det_extent_t){harmonic->constant - swing, harmonic->constant + swing, swing};
}

brace_status_t brace_det_judge(const brace_det_t *det, double mean_most_mm_per_n, uint32_t *flags)
{
    const double ratio = brace_det_extent(&det->rest).least / (mean_most_mm_per_n * mean_most_mm_per_n);
    if (!(ratio > TOO_SLENDER)) {
        return BRACE_E_UNSUPPORTED;
    }
    const int tilted = det->cross.constant != 0.0 || det->cross.per_cos != 0.0;
    *flags = ratio < (tilted ? SLENDER_TILTED : SLENDER) ? BRACE_FLAG_NEAR_SINGULAR : 0u;
    return BRACE_OK;
}
