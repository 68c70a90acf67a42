#include "chain/harmonics.h"

#include "base/vec.h"

/* The sum of the symmetric part of a b' over all elements. */
typedef struct {
    float xx, xz, zz;
} products_t;

static inline void add_product(products_t *sum, brace_vec_t a, brace_vec_t b)
{
    sum->xx = brace_fma(a.x, b.x, sum->xx);
    sum->zz = brace_fma(a.z, b.z, sum->zz);
    sum->xz = brace_fma(0.5f * a.x, b.z, sum->xz);
    sum->xz = brace_fma(0.5f * a.z, b.x, sum->xz);
}

/* v v' is straight straight' cos^2 h + folded folded' sin^2 h + (straight folded' + folded straight') sin h cos h, and
 * sin^2 h is 1 - cos^2 h. */
static void sum_squares(const brace_element_t element[BRACE_ELEMENT_COUNT], brace_harmonics_t *harmonics)
{
    products_t straight = {0}, folded = {0}, mixed = {0};
    for (int i = 0; i < BRACE_ELEMENT_COUNT; i++) {
        add_product(&straight, element[i].straight, element[i].straight);
        add_product(&folded, element[i].folded, element[i].folded);
        add_product(&mixed, element[i].straight, element[i].folded);
    }
    const float mean_at_fold = 0.5f * (folded.xx + folded.zz), dev_x_at_fold = 0.5f * (folded.xx - folded.zz);
    harmonics->mean =
        (brace_harmonic_t){mean_at_fold, 0.5f * (straight.xx + straight.zz) - mean_at_fold, mixed.xx + mixed.zz};
    harmonics->dev_x =
        (brace_harmonic_t){dev_x_at_fold, 0.5f * (straight.xx - straight.zz) - dev_x_at_fold, mixed.xx - mixed.zz};
    harmonics->dev_z = (brace_harmonic_t){folded.xz, straight.xz - folded.xz, 2.0f * mixed.xz};
}

/* det (sum v v') is the sum of (v_i x v_j)^2 over all pairs. With u = (cos^2 h, sin h cos h) each cross product is
 *     v_i x v_j = fold + slope . u,    |u|^2 = cos^2 h = u_x.
 * This gathers all of them into one square and a remainder linear in u. Let s be a unit vector in the plane of u, n the
 * vector a quarter clockwise from it, a = slope . n and b = slope . s of a pair, and r = c b - fold. If sum a b = 0 and
 * sum r b = 0, then
 *     sum (v_i x v_j)^2 = (B (c + s.u))^2 + sum a^2 (c^2 + 2 c s.u + u_x) + sum r^2 - 2 (sum r a) n.u,
 * with B^2 = sum b^2 - sum a^2. The first condition makes s the direction in which the sum varies most; the second
 * makes c = sum fold b / sum b^2. A few passes find s and c. Each pass adds squares along the s and c of the pass
 * before. Found at once, as differences of larger sums, they would lose the digits that matter. */
typedef struct {
    float aa, ab, bb, rb, rr, ra;
} cross_sums_t;

enum { PASSES = 4 };

/* A negligible amount [(mm/N)^2]: it keeps quotients of sums finite when all terms are zero. */
#define NEARLY_NOTHING 1e-30f

/* i comes before j in the list. With the factors in this order, crosses that must vanish do so exactly. */
static void add_cross(cross_sums_t *sum, const brace_element_t *i, const brace_element_t *j, brace_vec_t s, float c)
{
    const float minus_fold = vec_cross(j->folded, i->folded);
    const brace_vec_t slope = {vec_cross(i->straight, j->straight) + minus_fold,
                               vec_cross(i->straight, j->folded) - vec_cross(j->straight, i->folded)};
    const float a = vec_cross(slope, s), b = vec_dot(slope, s);
    const float r = brace_fma(c, b, minus_fold);
    sum->aa = brace_fma(a, a, sum->aa);
    sum->ab = brace_fma(a, b, sum->ab);
    sum->bb = brace_fma(b, b, sum->bb);
    sum->rb = brace_fma(r, b, sum->rb);
    sum->rr = brace_fma(r, r, sum->rr);
    sum->ra = brace_fma(r, a, sum->ra);
}

static cross_sums_t sum_crosses(const brace_element_t element[BRACE_ELEMENT_COUNT], brace_vec_t s, float c)
{
    cross_sums_t sum = {.bb = NEARLY_NOTHING};
    for (int j = 1; j < BRACE_ELEMENT_COUNT; j++) {
        for (int i = 0; i < j; i++) {
            add_cross(&sum, &element[i], &element[j], s, c);
        }
    }
    return sum;
}

static void gather_crosses(const brace_element_t element[BRACE_ELEMENT_COUNT], brace_harmonics_t *harmonics)
{
    brace_vec_t s = {0.0f, 1.0f}; /* its length grows a little with each pass; the end divides by that */
    float c = 0.0f;
    cross_sums_t sum = sum_crosses(element, s, c);
    for (int pass = 1; pass < PASSES; pass++) {
        const float half = 0.5f * (sum.bb - sum.aa);
        if (half < 0.0f) { /* the sum varies more along n, so begin with n */
            s = (brace_vec_t){s.z, -s.x};
        } else {
            const float tangent = sum.ab / (half + sqrtf(brace_fma(half, half, sum.ab * sum.ab)));
            s = (brace_vec_t){brace_fma(tangent, s.z, s.x), brace_fma(-tangent, s.x, s.z)};
            c -= brace_fma(tangent, sum.ra, sum.rb) / sum.bb;
        }
        sum = sum_crosses(element, s, c);
    }
    const float half = 0.5f * (sum.bb - sum.aa);
    const float amplitude = sqrtf(fabsf(half) + sqrtf(brace_fma(half, half, sum.ab * sum.ab))); /* B */
    const float square = vec_dot(s, s);
    const brace_vec_t per_u = vec_scaled(s, amplitude / square);
    const float c_aa = c * sum.aa;
    harmonics->cross = (brace_harmonic_t){c * amplitude, per_u.x, per_u.z};
    harmonics->rest = (brace_harmonic_t){sum.rr + c * c_aa, (sum.aa + 2.0f * (c_aa * s.x - sum.ra * s.z)) / square,
                                         2.0f * (c_aa * s.z + sum.ra * s.x) / square};
}

void brace_harmonics_of(const brace_element_t element[BRACE_ELEMENT_COUNT], brace_harmonics_t *harmonics)
{
    sum_squares(element, harmonics);
    gather_crosses(element, harmonics);
}
