#include "use/stiffness_check.h"

#include "base/check.h"
#include "brace/limb.h"

/* Rounding may put the eigenvalues of a round K in the wrong order by this share of themselves. */
#define ROUND 1e-6f

/* The first is softer than any limb in range, the second harder. Their inverses and squares are still far from the ends
 * of the float format. */
#define LEAST_N_PER_MM 1e-12f
#define MOST_N_PER_MM 1e12f

brace_status_t brace_check_stiffness(const brace_stiffness_t *stiffness)
{
    brace_status_t status = brace_check_two(stiffness->k_xx_n_per_mm, stiffness->k_xz_n_per_mm, MOST_N_PER_MM);
    status = brace_first_refusal(status, brace_check_magnitude(stiffness->k_zz_n_per_mm, MOST_N_PER_MM));
    status = brace_first_refusal(status, brace_check_magnitude(stiffness->stiff_axis_rad, BRACE_ANGLE_LIMIT_RAD));
    const float lambda_max = stiffness->lambda_max_n_per_mm, lambda_min = stiffness->lambda_min_n_per_mm;
    status = brace_first_refusal(status, brace_check_two(lambda_min, lambda_max, MOST_N_PER_MM));
    if (status == BRACE_OK && !(lambda_min >= LEAST_N_PER_MM && lambda_min <= lambda_max * (1.0f + ROUND))) {
        status = BRACE_E_RANGE;
    }
    return status;
}
