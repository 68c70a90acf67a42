/* Loops over postures, so that Python asks once per limb. Rows of seven floats: K_xx, K_xz, K_zz, lambda_min,
 * lambda_max, stiff axis, flags. */
#include <stddef.h>

#include "brace/planar_batch.h"
#include "brace/planar_fixed.h"
#include "brace/spatial.h"

int fixed_rows(const brace_limb_t *limb, size_t n, const int32_t *theta1_rad_q28, const int32_t *theta2_rad_q28,
               float *rows)
{
    brace_planar_fixed_t fixed;
    int status = brace_planar_fixed_collapse(limb, &fixed);
    for (size_t i = 0; status == BRACE_OK && i < n; i++) {
        brace_stiffness_t k;
        status = brace_planar_fixed_stiffness(&fixed, theta1_rad_q28[i], theta2_rad_q28[i], &k);
        float *row = rows + 7 * i;
        row[0] = k.k_xx_n_per_mm, row[1] = k.k_xz_n_per_mm, row[2] = k.k_zz_n_per_mm;
        row[3] = k.lambda_min_n_per_mm, row[4] = k.lambda_max_n_per_mm, row[5] = k.stiff_axis_rad;
        row[6] = (float)k.flags;
    }
    return status;
}

/* Rows of thirteen: K_xx, K_xy, K_xz, K_yy, K_yz, K_zz, three eigenvalues, the stiff axis, flags. */
int spatial_rows(const brace_limb_t *limb, size_t n, const float *theta0_rad, const float *theta1_rad,
                 const float *theta2_rad, float *rows)
{
    brace_spatial_t spatial;
    int status = brace_spatial_collapse(limb, &spatial);
    for (size_t i = 0; status == BRACE_OK && i < n; i++) {
        brace_stiffness_spatial_t k;
        status = brace_spatial_stiffness(&spatial, theta0_rad[i], theta1_rad[i], theta2_rad[i], &k);
        float *row = rows + 13 * i;
        row[0] = k.k_xx_n_per_mm, row[1] = k.k_xy_n_per_mm, row[2] = k.k_xz_n_per_mm;
        row[3] = k.k_yy_n_per_mm, row[4] = k.k_yz_n_per_mm, row[5] = k.k_zz_n_per_mm;
        for (int j = 0; j < 3; j++) {
            row[6 + j] = k.lambda_n_per_mm[j];
            row[9 + j] = k.stiff_axis[j];
        }
        row[12] = (float)k.flags;
    }
    return status;
}

/* Six columns of n floats, one after the other, and the number of refused postures; negative: a status. */
long batch_columns(const brace_limb_t *limb, size_t n, const float *theta1_rad, const float *theta2_rad, float *columns)
{
    brace_planar_t planar;
    const int status = brace_planar_collapse(limb, &planar);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_stiffness_soa_t out = {columns,         columns + n,     columns + 2 * n,
                                       columns + 3 * n, columns + 4 * n, columns + 5 * n};
    return (long)brace_planar_batch(&planar, n, theta1_rad, theta2_rad, &out);
}
