#include "brace/chain.h"

#include <stdbool.h>

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

static void halve(brace_harmonic_t *harmonic)
{
    harmonic->at_fold *= 0.5f;
    harmonic->per_cos *= 0.5f;
    harmonic->per_sin *= 0.5f;
}

/* The direction in (1 + cos theta2, sin theta2) along which the sum of all cross^2 varies most: larger
 * eigenvector of its quadratic part. */
static brace_vec_t steepest(const brace_element_t *element, uint32_t count)
{
    float cc = 0.0f, cs = 0.0f, ss = 0.0f;
    for (uint32_t i = 1; i < count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            const brace_harmonic_t c = cross_of(&element[j], &element[i]);
            cc = __builtin_fmaf(c.per_cos, c.per_cos, cc);
            cs = __builtin_fmaf(c.per_cos, c.per_sin, cs);
            ss = __builtin_fmaf(c.per_sin, c.per_sin, ss);
        }
    }
    const float half = 0.5f * (ss - cc);
    const float radius = __builtin_sqrtf(__builtin_fmaf(half, half, cs * cs));
    if (!(radius > 0.0f)) {
        return (brace_vec_t){0.0f, 1.0f};
    }
    const brace_vec_t along =
        half >= 0.0f ? (brace_vec_t){cs, half + radius} : (brace_vec_t){radius - half, cs};
    return vec_scaled(along, 1.0f / __builtin_sqrtf(vec_dot(along, along)));
}

/* det C = iso (2 mean - iso) + sum of cross^2. With u = (1 + cos, sin) turned into the steepest direction and
 * its normal, each pair's cross is k + a n.u + b s.u; the squares gather into one square of c + s.u and a
 * remainder that is linear in u because |u|^2 = 2 (1 + cos):
 *     sum cross^2 = (B (c + s.u))^2 + mu (c^2 + 2 c s.u + 2 (1 + cos)) + sum r^2 + 2 (sum r a) n.u
 * with c = sum k b / sum b^2, r = k - c b, mu = sum a^2, B^2 = sum b^2 - mu: only squares are added. */
static void gather_crosses(const brace_element_t *element, uint32_t count, brace_harmonics_t *harmonics)
{
    const brace_vec_t s = steepest(element, count);
    float aa = 0.0f, bb = 0.0f, kb = 0.0f, rr = 0.0f, ra = 0.0f;
    float c = 0.0f;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 1; i < count; i++) {
            for (uint32_t j = 0; j < i; j++) {
                const brace_harmonic_t cross = cross_of(&element[j], &element[i]);
                const brace_vec_t slope = {cross.per_cos, cross.per_sin};
                const float a = -vec_cross(s, slope), b = vec_dot(s, slope);
                if (pass == 0) {
                    aa = __builtin_fmaf(a, a, aa);
                    bb = __builtin_fmaf(b, b, bb);
                    kb = __builtin_fmaf(cross.at_fold, b, kb);
                } else {
                    const float r = cross.at_fold - c * b;
                    rr = __builtin_fmaf(r, r, rr);
                    ra = __builtin_fmaf(r, a, ra);
                }
            }
        }
        c = bb > 0.0f ? kb / bb : 0.0f;
    }
    const float amplitude = bb > aa ? __builtin_sqrtf(bb - aa) : 0.0f;
    harmonics->cross = (brace_harmonic_t){c * amplitude, s.x * amplitude, s.z * amplitude};
    harmonics->rest = (brace_harmonic_t){rr + c * c * aa, 2.0f * (aa + c * aa * s.x + ra * s.z),
                                         2.0f * (c * aa * s.z - ra * s.x)};
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
    halve(&sum.mean);
    halve(&sum.dev_x);
    halve(&sum.dev_y);
    sum.mean.at_fold += iso;
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
