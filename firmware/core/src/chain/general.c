#include "brace/general.h"

#include "base/off_tick.h"
#include "base/trig.h"
#include "base/vec.h"
#include "brace/planar.h"
#include "chain/chain_list.h"
#include "chain/tensor.h"

/* On the tick: of every controller whose limb brace_planar_stiffness does not serve. tests/bench/tick_cost.py holds that
 * whole tick to 4,000 instructions. */

#define STRAIGHT femur
#define FOLDED tibia

enum { HIP = BRACE_GENERAL_FIRM, KNEE, ELEMENTS };

/* v = femur e^ih + tibia e^-ih = straight cos h + folded sin h. */
BRACE_OFF_TICK static brace_element_t halved(const brace_element_t *element)
{
    const brace_vec_t f = element->femur, t = element->tibia;
    return (brace_element_t){.STRAIGHT = {f.x + t.x, f.z + t.z}, .FOLDED = {t.z - f.z, f.x - t.x}};
}

static inline void add_square(brace_vec_t a, brace_vec_t b, float *mean, float *dev_x, float *dev_y)
{
    *mean += 0.5f * (a.x * b.x + a.z * b.z);
    *dev_x += 0.5f * (a.x * b.x - a.z * b.z);
    *dev_y += 0.5f * (a.x * b.z + a.z * b.x);
}

/* In this order of factors what must vanish does so exactly (harmonics.c). */
BRACE_OFF_TICK static brace_cross_t cross_of(const brace_element_t *a, const brace_element_t *b)
{
    const float minus_fold = vec_cross(b->FOLDED, a->FOLDED);
    return (brace_cross_t){-minus_fold, vec_cross(a->STRAIGHT, b->STRAIGHT) + minus_fold,
                           vec_cross(a->STRAIGHT, b->FOLDED) - vec_cross(b->STRAIGHT, a->FOLDED)};
}

BRACE_OFF_TICK void brace_general_collapse(const brace_limb_t *limb, brace_general_t *general)
{
    brace_element_t element[BRACE_CHAIN_FIRM];
    brace_cross_t *cross = general->cross;
    general->iso_mm_per_n = brace_chain_firm(limb, element);
    general->iso_mm_per_n += brace_chain_base(limb, &element[HIP]); /* the springs come anew below */
    general->base = element[HIP].base;
    general->femur_mm = limb->femur_mm;
    general->tibia_mm = limb->tibia_mm;
    general->mean = general->dev_x = general->dev_y = (brace_quadratic_t){0.0f, 0.0f, 0.0f};
    element[HIP] = (brace_element_t){.femur = {0.0f, limb->femur_mm}, .tibia = {0.0f, limb->tibia_mm}};
    element[KNEE] = (brace_element_t){.tibia = {0.0f, limb->tibia_mm}};
    for (int i = 0; i < ELEMENTS; i++) {
        element[i] = halved(&element[i]);
        for (int j = 0; j < i; j++) {
            *cross++ = cross_of(&element[j], &element[i]);
        }
    }
    for (int i = 0; i < BRACE_GENERAL_FIRM; i++) {
        const brace_element_t *e = &element[i];
        general->firm[i] = *e;
        add_square(e->STRAIGHT, e->STRAIGHT, &general->mean.straight, &general->dev_x.straight, &general->dev_y.straight);
        add_square(e->STRAIGHT, e->FOLDED, &general->mean.both, &general->dev_x.both, &general->dev_y.both);
        add_square(e->STRAIGHT, e->FOLDED, &general->mean.both, &general->dev_x.both, &general->dev_y.both);
        add_square(e->FOLDED, e->FOLDED, &general->mean.folded, &general->dev_x.folded, &general->dev_y.folded);
    }
}

/* cos^2 h, cos h sin h, sin^2 h */
typedef struct {
    float cc, cs, ss;
} half_knee_t;

static inline float quadratic(const brace_quadratic_t *q, half_knee_t h)
{
    return __builtin_fmaf(q->straight, h.cc, __builtin_fmaf(q->both, h.cs, q->folded * h.ss));
}

static inline float plus_square(float sum, const brace_cross_t *cross, half_knee_t h)
{
    const float value = __builtin_fmaf(cross->per_cos, h.cc, __builtin_fmaf(cross->per_sin, h.cs, cross->at_fold));
    return __builtin_fmaf(value, value, sum);
}

static inline float three_squares(const brace_cross_t *cross, half_knee_t h)
{
    return plus_square(plus_square(plus_square(0.0f, cross, h), cross + 1, h), cross + 2, h);
}

static inline float cross_square(brace_vec_t a, brace_vec_t b)
{
    const float cross = vec_cross(a, b);
    return cross * cross;
}

/* What the base adds to the squares of the crosses. */
static inline float base_squares(const brace_general_t *general, brace_vec_t knee, brace_vec_t base, float by_springs)
{
    float sum = by_springs;
    for (int i = 0; i < BRACE_GENERAL_FIRM; i++) {
        const brace_vec_t straight = general->firm[i].STRAIGHT, folded = general->firm[i].FOLDED;
        const brace_vec_t v = {__builtin_fmaf(straight.x, knee.x, folded.x * knee.z),
                               __builtin_fmaf(straight.z, knee.x, folded.z * knee.z)};
        sum += cross_square(v, base);
    }
    return sum;
}

static inline brace_tensor_t tensor(const brace_general_t *general, float theta1_rad, float theta2_rad, float hip, float knee)
{
    const uint32_t half_turn = brace_turn(0.5f * theta2_rad);
    const brace_vec_t half = brace_direction(half_turn); /* of the knee's angle */
    const brace_vec_t bisector = brace_direction(brace_turn(theta1_rad) - half_turn);
    const half_knee_t h = {half.x * half.x, half.x * half.z, half.z * half.z};
    const float femur_mm = general->femur_mm, tibia_mm = general->tibia_mm, iso = general->iso_mm_per_n;
    const brace_vec_t by_hip = {(tibia_mm - femur_mm) * half.z, (femur_mm + tibia_mm) * half.x};
    const brace_vec_t by_knee = {tibia_mm * half.z, tibia_mm * half.x};
    const brace_cross_t *cross = general->cross;

    /* twice the mean and the deviator that the springs add, in the bisector's frame */
    const float hip_x = hip * by_hip.x, hip_z = hip * by_hip.z, knee_x = knee * by_knee.x, knee_z = knee * by_knee.z;
    float xx = __builtin_fmaf(hip_x, by_hip.x, knee_x * by_knee.x);
    float zz = __builtin_fmaf(hip_z, by_hip.z, knee_z * by_knee.z);
    float xz = __builtin_fmaf(hip_x, by_hip.z, knee_x * by_knee.z);
    float squares = three_squares(cross, h);
    squares = __builtin_fmaf(hip, three_squares(cross + 3, h), squares);
    squares = __builtin_fmaf(knee, __builtin_fmaf(hip, plus_square(0.0f, cross + 9, h), three_squares(cross + 6, h)), squares);
    const brace_vec_t base = general->base;
    if (base.x != 0.0f || base.z != 0.0f) {
        const brace_vec_t seen = {__builtin_fmaf(base.x, bisector.x, base.z * bisector.z),
                                  __builtin_fmaf(base.z, bisector.x, -(base.x * bisector.z))};
        xx = __builtin_fmaf(seen.x, seen.x, xx);
        zz = __builtin_fmaf(seen.z, seen.z, zz);
        xz = __builtin_fmaf(seen.x, seen.z, xz);
        squares += base_squares(general, half, seen, hip * cross_square(by_hip, seen) + knee * cross_square(by_knee, seen));
    }
    const float mean = quadratic(&general->mean, h) + 0.5f * (xx + zz);
    brace_vec_t dev = {quadratic(&general->dev_x, h) + 0.5f * (xx - zz), quadratic(&general->dev_y, h) + xz};
    const brace_vec_t to_world = {__builtin_fmaf(-2.0f * bisector.z, bisector.z, 1.0f), 2.0f * bisector.z * bisector.x};
    dev = brace_turned(dev, to_world);
    return (brace_tensor_t){iso + mean, dev.x, dev.z, __builtin_fmaf(iso, __builtin_fmaf(2.0f, mean, iso), squares)};
}

brace_status_t brace_general_stiffness(const brace_general_t *general, float theta1_rad, float theta2_rad,
                                       float hip_rad_per_n_mm, float knee_rad_per_n_mm, brace_stiffness_t *stiffness)
{
    const float reach = theta1_rad * theta1_rad + theta2_rad * theta2_rad;
    if (!(reach <= BRACE_PLANAR_REACH_RAD2)) {
        return reach <= 3.4028234e38f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    return brace_tensor_inverse(tensor(general, theta1_rad, theta2_rad, hip_rad_per_n_mm, knee_rad_per_n_mm), stiffness);
}
