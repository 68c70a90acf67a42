/* Plain C with the C library's float functions: the limb's chain summed element by element, then inverted. */
#ifndef PEER_PLAIN_H
#define PEER_PLAIN_H

typedef struct {
    float length;
    float axial;   /* mm/N */
    float bending; /* mm/N */
    float lateral; /* mm/N, out of plane */
    float torsion; /* rad/(N mm) */
    float moment_transfer;
} plain_link_t;

typedef struct {
    plain_link_t coxa, femur, tibia;
    float joint[3]; /* rad/(N mm): coxa, femur, tibia */
} plain_limb_t;

typedef struct {
    float k_xx, k_xz, k_zz;
    float lambda_min, lambda_max;
    float stiff_axis;
} plain_stiffness_t;

typedef struct {
    float k[3][3];
    float lambda[3]; /* ascending */
    float stiff_axis[3];
} plain_spatial_t;

#ifdef __cplusplus
extern "C" {
#endif

void plain_stiffness(const plain_limb_t *limb, float theta1, float theta2, plain_stiffness_t *out);
void plain_spatial_stiffness(const plain_limb_t *limb, float theta0, float theta1, float theta2, plain_spatial_t *out);

#ifdef __cplusplus
}
#endif

#endif
