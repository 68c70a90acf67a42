/* The planar K with CMSIS-DSP: C = sum of T' S T with the library's matrices, its inverse, its fast sine, cosine,
 * square root and arctangent. */
#include "cmsis_dsp.h"

#include "arm_math.h"

/* c += t' s t; t is rows x 2, s is rows x rows. */
static void add_element(arm_matrix_instance_f32 *c, int rows, float32_t *s_data, float32_t *t_data)
{
    float32_t transposed_data[6], product_data[6], sum_data[4], result_data[4];
    arm_matrix_instance_f32 s, t, transposed, product, term, sum;
    arm_mat_init_f32(&s, rows, rows, s_data);
    arm_mat_init_f32(&t, rows, 2, t_data);
    arm_mat_init_f32(&transposed, 2, rows, transposed_data);
    arm_mat_init_f32(&product, 2, rows, product_data);
    arm_mat_init_f32(&term, 2, 2, sum_data);
    arm_mat_init_f32(&sum, 2, 2, result_data);
    arm_mat_trans_f32(&t, &transposed);
    arm_mat_mult_f32(&transposed, &s, &product);
    arm_mat_mult_f32(&product, &t, &term);
    arm_mat_add_f32(c, &term, &sum);
    arm_copy_f32(result_data, c->pData, 4);
}

/* A link along u (cosine, sine) with the tip at arm (x, z) from its far end: wrench (axial, across, moment). */
static void add_link(arm_matrix_instance_f32 *c, const plain_link_t *link, const float32_t u[2], const float32_t arm[2])
{
    float32_t t[6] = {u[0], u[1], -u[1], u[0], -arm[1], arm[0]};
    if (link->moment_transfer == 0.0f) {
        float32_t s[4] = {link->axial, 0.0f, 0.0f, link->bending};
        add_element(c, 2, s, t);
    } else {
        const float32_t b = link->bending * link->moment_transfer;
        const float32_t coupling = 1.5f * b / link->length, rotation = 3.0f * b / (link->length * link->length);
        float32_t s[9] = {link->axial, 0.0f, 0.0f, 0.0f, link->bending, coupling, 0.0f, coupling, rotation};
        add_element(c, 3, s, t);
    }
}

static void add_spring(arm_matrix_instance_f32 *c, float32_t compliance, const float32_t arm[2])
{
    float32_t t[2] = {-arm[1], arm[0]};
    add_element(c, 1, &compliance, t);
}

void cmsis_dsp_stiffness(const plain_limb_t *limb, float theta1, float theta2, plain_stiffness_t *out)
{
    const float32_t u1[2] = {arm_cos_f32(theta1), arm_sin_f32(theta1)};
    const float32_t u2[2] = {arm_cos_f32(theta1 - theta2), arm_sin_f32(theta1 - theta2)};
    const float32_t shank[2] = {limb->tibia.length * u2[0], limb->tibia.length * u2[1]};
    const float32_t tip[2] = {limb->femur.length * u1[0] + shank[0], limb->femur.length * u1[1] + shank[1]};
    const float32_t none[2] = {0.0f, 0.0f};

    float32_t c_data[4] = {0.0f, 0.0f, 0.0f, 0.0f}, k_data[4];
    arm_matrix_instance_f32 c, k;
    arm_mat_init_f32(&c, 2, 2, c_data);
    arm_mat_init_f32(&k, 2, 2, k_data);
    add_link(&c, &limb->femur, u1, shank);
    add_link(&c, &limb->tibia, u2, none);
    add_spring(&c, limb->joint[1], tip);
    add_spring(&c, limb->joint[2], shank);
    arm_mat_inverse_f32(&c, &k);

    const float32_t mean = 0.5f * (k_data[0] + k_data[3]), half = 0.5f * (k_data[0] - k_data[3]);
    float32_t radius, angle;
    arm_sqrt_f32(half * half + k_data[1] * k_data[1], &radius);
    arm_atan2_f32(k_data[1], half, &angle);
    out->k_xx = k_data[0];
    out->k_xz = k_data[1];
    out->k_zz = k_data[3];
    out->lambda_min = mean - radius;
    out->lambda_max = mean + radius;
    out->stiff_axis = 0.5f * angle;
}
