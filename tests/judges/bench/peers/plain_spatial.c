/* The spatial K in plain C: chain in the limb's plane, compliance across it, turned by theta0, then the
 * trigonometric eigenvalues of a symmetric 3x3. */
#include <math.h>

#include "plain.h"

typedef struct {
    float xx, xz, zz;
} sym2_t;

typedef struct {
    float x, z;
} vec2_t;

static vec2_t turned(vec2_t v)
{
    const vec2_t r = {-v.z, v.x};
    return r;
}

/* c += s v v' */
static void add_outer(sym2_t *c, float s, vec2_t v)
{
    c->xx += s * v.x * v.x;
    c->xz += s * v.x * v.z;
    c->zz += s * v.z * v.z;
}

/* A link along u with the tip at arm from its far end. */
static void add_link(sym2_t *c, const plain_link_t *link, vec2_t u, vec2_t arm)
{
    const vec2_t n = turned(u);
    add_outer(c, link->axial, u);
    add_outer(c, link->bending, n);
    if (link->moment_transfer != 0.0f) {
        const float b = link->bending * link->moment_transfer;
        const float coupling = 1.5f * b / link->length;
        const vec2_t lever = turned(arm);
        c->xx += 2.0f * coupling * n.x * lever.x;
        c->xz += coupling * (n.x * lever.z + n.z * lever.x);
        c->zz += 2.0f * coupling * n.z * lever.z;
        add_outer(c, 3.0f * b / (link->length * link->length), lever);
    }
}

static float lateral(const plain_link_t *link, float reach)
{
    const float t = 3.0f * link->moment_transfer / link->length;
    return link->lateral * (1.0f + t * reach + t / link->length * reach * reach);
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void eigenvalues(const float k[3][3], float lambda[3])
{
    const float mean = (k[0][0] + k[1][1] + k[2][2]) / 3.0f;
    const float a = k[0][0] - mean, b = k[1][1] - mean, c = k[2][2] - mean;
    const float d = k[0][1], e = k[0][2], f = k[1][2];
    const float radius = sqrtf((a * a + b * b + c * c + 2.0f * (d * d + e * e + f * f)) / 6.0f);
    const float det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    const float cosine = fminf(1.0f, fmaxf(-1.0f, 0.5f * det / (radius * radius * radius)));
    const float angle = acosf(cosine) / 3.0f;
    lambda[2] = mean + 2.0f * radius * cosf(angle);
    lambda[0] = mean + 2.0f * radius * cosf(angle + 2.0943951f);
    lambda[1] = 3.0f * mean - lambda[0] - lambda[2];
}

/* Unit eigenvector: the longest cross product of two rows of k - lambda I. */
static void eigenvector(const float k[3][3], float lambda, float axis[3])
{
    const float rows[3][3] = {{k[0][0] - lambda, k[0][1], k[0][2]},
                              {k[1][0], k[1][1] - lambda, k[1][2]},
                              {k[2][0], k[2][1], k[2][2] - lambda}};
    float best = -1.0f, best_vector[3] = {1.0f, 0.0f, 0.0f};
    for (int i = 0; i < 3; i++) {
        float v[3];
        cross(rows[i], rows[(i + 1) % 3], v);
        const float length2 = dot(v, v);
        if (length2 > best) {
            best = length2;
            for (int j = 0; j < 3; j++) {
                best_vector[j] = v[j];
            }
        }
    }
    const float scale = 1.0f / sqrtf(best);
    for (int j = 0; j < 3; j++) {
        axis[j] = scale * best_vector[j];
    }
}

void plain_spatial_stiffness(const plain_limb_t *limb, float theta0, float theta1, float theta2, plain_spatial_t *out)
{
    const vec2_t u0 = {1.0f, 0.0f};
    const vec2_t u1 = {cosf(theta1), sinf(theta1)};
    const vec2_t u2 = {cosf(theta1 - theta2), sinf(theta1 - theta2)};
    const vec2_t shank = {limb->tibia.length * u2.x, limb->tibia.length * u2.z};
    const vec2_t tip = {limb->femur.length * u1.x + shank.x, limb->femur.length * u1.z + shank.z};
    const vec2_t none = {0.0f, 0.0f};

    sym2_t c = {0.0f, 0.0f, 0.0f};
    add_link(&c, &limb->coxa, u0, tip);
    add_link(&c, &limb->femur, u1, shank);
    add_link(&c, &limb->tibia, u2, none);
    add_outer(&c, limb->joint[1], turned(tip));
    add_outer(&c, limb->joint[2], turned(shank));

    const float along = shank.x * u1.x + shank.z * u1.z, across = shank.z * u1.x - shank.x * u1.z;
    const float reach = limb->coxa.length + tip.x;
    const float c_yy = limb->joint[0] * reach * reach + lateral(&limb->coxa, tip.x) +
                       limb->coxa.torsion * tip.z * tip.z + lateral(&limb->femur, along) +
                       limb->femur.torsion * across * across + limb->tibia.lateral;

    const float det = c.xx * c.zz - c.xz * c.xz;
    const float k_rr = c.zz / det, k_rz = -c.xz / det, k_yy = 1.0f / c_yy;
    const float c0 = cosf(theta0), s0 = sinf(theta0);
    out->k[0][0] = c0 * c0 * k_rr + s0 * s0 * k_yy;
    out->k[0][1] = out->k[1][0] = c0 * s0 * (k_rr - k_yy);
    out->k[1][1] = s0 * s0 * k_rr + c0 * c0 * k_yy;
    out->k[0][2] = out->k[2][0] = c0 * k_rz;
    out->k[1][2] = out->k[2][1] = s0 * k_rz;
    out->k[2][2] = c.xx / det;

    eigenvalues(out->k, out->lambda);
    eigenvector(out->k, out->lambda[2], out->stiff_axis);
}
