#include "brace/chain.h"

#include "chain_list.h"
#include "vec.h"

/* v_a x v_b of two elements as a function of the knee angle. */
static brace_harmonic_t cross_of(const brace_element_t *a, const brace_element_t *b)
{
    const brace_harmonic_t cross = {
        .at_fold = vec_cross(vec_minus(a->femur, a->tibia), vec_minus(b->femur, b->tibia)),
        .per_cos = vec_cross(a->femur, b->tibia) + vec_cross(a->tibia, b->femur),
        .per_sin = vec_dot(a->tibia, b->femur) - vec_dot(a->femur, b->tibia),
    };
    return cross;
}

/* Adds v v' of one element to trace and deviator, all doubled. */
static void add_element(const brace_element_t *element, brace_harmonics_t *sum)
{
    const brace_vec_t f = element->femur, t = element->tibia, g = vec_minus(f, t);
    const float f_even = vec_cross((brace_vec_t){f.x, f.z}, (brace_vec_t){f.z, f.x});  /* fx^2 - fz^2 */
    const float t_even = vec_cross((brace_vec_t){t.x, t.z}, (brace_vec_t){t.z, t.x});
    const float f_odd = 2.0f * f.x * f.z, t_odd = 2.0f * t.x * t.z;
    sum->mean.at_fold += vec_dot(g, g);
    sum->mean.per_cos += 2.0f * vec_dot(f, t);
    sum->mean.per_sin += 2.0f * vec_cross(f, t);
    sum->dev_x.at_fold -= vec_cross((brace_vec_t){g.x, g.z}, (brace_vec_t){g.z, g.x});
    sum->dev_x.per_cos += f_even + t_even;
    sum->dev_x.per_sin -= f_odd - t_odd;
    sum->dev_y.at_fold -= 2.0f * g.x * g.z;
    sum->dev_y.per_cos += f_odd + t_odd;
    sum->dev_y.per_sin += f_even - t_even;
}

static void scale(brace_harmonic_t *harmonic, float by)
{
    harmonic->at_fold *= by;
    harmonic->per_cos *= by;
    harmonic->per_sin *= by;
}

/* Sums over all pairs of elements of what their crosses are along and across a direction of (1 + cos, sin). */
typedef struct {
    float aa, ab, bb, kb, rr, ra;
} crosses_t;

/* Each cross is k + a n.u + b s.u with u = (1 + cos, sin), n = s turned clockwise; r = k - c b. */
static void sum_crosses(const brace_element_t *element, uint32_t count, brace_vec_t s, float c, crosses_t *sum)
{
    *sum = (crosses_t){0};
    for (uint32_t i = 1; i < count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            const brace_harmonic_t cross = cross_of(&element[j], &element[i]);
            const brace_vec_t slope = {cross.per_cos, cross.per_sin};
            const float a = vec_cross(slope, s), b = vec_dot(slope, s);
            const float r = __builtin_fmaf(-c, b, cross.at_fold);
            sum->aa = __builtin_fmaf(a, a, sum->aa);
            sum->ab = __builtin_fmaf(a, b, sum->ab);
            sum->bb = __builtin_fmaf(b, b, sum->bb);
            sum->kb = __builtin_fmaf(cross.at_fold, b, sum->kb);
            sum->rr = __builtin_fmaf(r, r, sum->rr);
            sum->ra = __builtin_fmaf(r, a, sum->ra);
        }
    }
}

/* The direction along which the sum of all cross^2 varies most: larger eigenvector of its quadratic part, whose
 * sums were taken along (0, 1) and across it, (1, 0). */
static brace_vec_t steepest(const crosses_t *sum)
{
    const float half = 0.5f * (sum->bb - sum->aa);
    const float radius = __builtin_sqrtf(__builtin_fmaf(half, half, sum->ab * sum->ab));
    brace_vec_t along = {0.0f, 1.0f};
    if (radius > 0.0f) {
        along = half >= 0.0f ? (brace_vec_t){sum->ab, half + radius} : (brace_vec_t){radius - half, sum->ab};
    }
    return vec_scaled(along, 1.0f / __builtin_sqrtf(vec_dot(along, along)));
}

/* The squares of all crosses gather into one square of c + s.u and a remainder that is linear in u because
 * |u|^2 = 2 (1 + cos):
 *     sum cross^2 = (B (c + s.u))^2 + mu (c^2 + 2 c s.u + 2 (1 + cos)) + sum r^2 + 2 (sum r a) n.u
 * with s the steepest direction, c = sum k b / sum b^2, mu = sum a^2, B^2 = sum b^2 - mu. Only squares are added;
 * three passes, because the sums as differences of larger ones would lose the digits that matter. */
static void gather_crosses(const brace_element_t *element, uint32_t count, brace_harmonics_t *harmonics)
{
    brace_vec_t s = {0.0f, 1.0f};
    float c = 0.0f;
    crosses_t sum;
    for (int pass = 0; pass < 3; pass++) {
        sum_crosses(element, count, s, c, &sum);
        if (pass == 0) {
            s = steepest(&sum);
        } else if (pass == 1 && sum.bb > 0.0f) {
            c = sum.kb / sum.bb;
        }
    }
    const float mu = sum.aa, c_mu = c * mu;
    const float amplitude = sum.bb > mu ? __builtin_sqrtf(sum.bb - mu) : 0.0f;
    harmonics->cross = (brace_harmonic_t){c * amplitude, s.x * amplitude, s.z * amplitude};
    harmonics->rest = (brace_harmonic_t){sum.rr + c * c_mu, 2.0f * (mu + c_mu * s.x + sum.ra * s.z),
                                         2.0f * (c_mu * s.z - sum.ra * s.x)};
}

brace_status_t brace_harmonics_list(float iso, const brace_element_t *element, uint32_t count,
                                    brace_harmonics_t *harmonics)
{
    brace_harmonics_t sum = {0};
    gather_crosses(element, count, &sum);
    for (uint32_t i = 0; i < count; i++) {
        add_element(&element[i], &sum);
    }
    sum.rest.at_fold += iso * (iso + sum.mean.at_fold);
    sum.rest.per_cos += iso * sum.mean.per_cos;
    sum.rest.per_sin += iso * sum.mean.per_sin;
    scale(&sum.mean, 0.5f);
    scale(&sum.dev_x, 0.5f);
    scale(&sum.dev_y, 0.5f);
    sum.mean.at_fold += iso;
    sum.iso_mm_per_n = iso;
    *harmonics = sum;
    return BRACE_OK;
}

brace_status_t brace_harmonics(const brace_chain_t *chain, brace_harmonics_t *harmonics)
{
    if (chain == NULL || harmonics == NULL) {
        return BRACE_E_NULL;
    }
    for (uint32_t i = 0; i < chain->count; i++) {
        if (vec_dot(chain->element[i].base, chain->element[i].base) > 0.0f) {
            return BRACE_E_UNSUPPORTED;
        }
    }
    return brace_harmonics_list(chain->iso_mm_per_n, chain->element, chain->count, harmonics);
}
