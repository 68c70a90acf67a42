#include "fixed/fixed_det.h"

/* Least det C over mean^2: below each limit a promise ends. */
#define SLENDER_TILTED 6e-5
#define SLENDER 2e-6
#define TOO_SLENDER 2.5e-7

/* The square root, from the float's root by one step of Newton's method. So no double-precision root is linked in. */
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

/* The unit vector along which the quadratic form [[cc, cs], [cs, ss]] is largest, and how much larger the form is along
 * it than across it. */
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

/* With u = (cos, sin) of the knee angle each pair's v x v is k + p.u. The sum of their squares is
 * sum k^2 + 2 (sum k p).u + u' P u, with P = sum p p' = more s s' + least I and s the direction of its crest. The part
 * more (c + s.u)^2 is the cross, with c = sum k p.s / sum (p.s)^2. The rest is linear in u. */
brace_det_t brace_det_of(float iso, const brace_element_t element[BRACE_ELEMENT_COUNT])
{
    brace_det_harmonic_t trace = {(double)iso, 0.0, 0.0}, rest = {0.0, 0.0, 0.0};
    double cc = 0.0, cs = 0.0, ss = 0.0;
    for (int i = 0; i < BRACE_ELEMENT_COUNT; i++) {
        const brace_vec_t p = element[i].straight, q = element[i].folded;
        add(&trace, 0.5, (brace_det_harmonic_t){dot(p, p) + dot(q, q), dot(p, p) - dot(q, q), 2.0 * dot(p, q)});
        for (int j = 0; j < i; j++) {
            const brace_vec_t pj = element[j].straight, qj = element[j].folded;
            const double straight = 0.5 * cross(pj, p), folded = 0.5 * cross(qj, q);
            const brace_det_harmonic_t pair = {straight + folded, straight - folded,
                                               0.5 * (cross(pj, q) - cross(p, qj))};
            add(&rest, pair.constant, (brace_det_harmonic_t){pair.constant, 2.0 * pair.per_cos, 2.0 * pair.per_sin});
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
    add(&rest, (double)iso, trace);
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
