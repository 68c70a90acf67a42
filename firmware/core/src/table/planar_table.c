#include "brace/planar_table.h"

#define PRODUCT(a, b) ((int64_t)(int32_t)(a) * (int32_t)(b))
#define HIGH(sum) ((int32_t)(uint32_t)((uint64_t)(sum) >> 32))

/* 2^29 units are one turn, 2^21 one stretch of the table. */
#define TURN_PER_RAD 1367130551
#define HALF_STRETCH 0x00100000u

/* Of 2^32 units to a turn, 2^21 are one entry of the sines; a remainder of half an entry is 2^31. */
#define HALF_ENTRY 0x00100000u
#define RAD_PER_D (3.14159265f / 2048.0f / 0x1p31f)

brace_status_t brace_planar_table_stiffness(const brace_planar_table_t *table, float theta1_rad, float theta2_rad,
                                            brace_stiffness_t *stiffness)
{
    const float reach = __builtin_fmaf(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    if (!(reach <= BRACE_PLANAR_REACH_RAD2)) {
        return reach <= 3.4028234e38f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    const uint32_t knee = (uint32_t)HIGH(PRODUCT(theta2_rad * 0x1p28f, TURN_PER_RAD));
    const uint32_t femur = (uint32_t)HIGH(PRODUCT(theta1_rad * 0x1p28f, TURN_PER_RAD));

    const uint32_t stretch = (knee + HALF_STRETCH) >> 21 & (BRACE_PLANAR_TABLE_ROWS - 1);
    const brace_planar_table_row_t *row = table->row + stretch;
    const int32_t d = (int32_t)(knee << 11);
    const int32_t slope = (int32_t)row->axis_c0_c1 + HIGH(PRODUCT(row->axis_c2, d));
    const uint32_t from_bisector = (uint32_t)HIGH((uint64_t)row->axis_c0_c1 + (uint64_t)PRODUCT(slope, d)); /* wraps */
    const uint32_t twice_axis = from_bisector + ((2u * femur - knee) << 3);

    const float place = (float)d;
    const float *low = row->lambda_min_n_per_mm, *least = row->least_compliance_mm_per_n;
    const float lambda_min = __builtin_fmaf(__builtin_fmaf(low[2], place, low[1]), place, low[0]);
    const float steep = __builtin_fmaf(__builtin_fmaf(least[3], place, least[2]), place, least[1]);
    const float lambda_max = 1.0f / __builtin_fmaf(steep, place, least[0]);

    /* Half the sine and cosine of twice the axis, to first order from the nearest entry. */
    const float *entry = &table->half_sine[(twice_axis + HALF_ENTRY) >> 21];
    const float turned = (float)(int32_t)(twice_axis << 11) * RAD_PER_D;
    const float half_sin = __builtin_fmaf(entry[BRACE_PLANAR_TABLE_SINES / 5], turned, entry[0]);
    const float half_cos = __builtin_fmaf(-entry[0], turned, entry[BRACE_PLANAR_TABLE_SINES / 5]);

    /* K = lambda_min I + (lambda_max - lambda_min) a a' */
    const float excess = lambda_max - lambda_min;
    const float along_x = excess * (half_cos + 0.5f);
    stiffness->flags = 0;
    stiffness->lambda_min_n_per_mm = lambda_min;
    stiffness->lambda_max_n_per_mm = lambda_max;
    stiffness->k_xx_n_per_mm = lambda_min + along_x;
    stiffness->k_zz_n_per_mm = lambda_max - along_x;
    stiffness->k_xz_n_per_mm = excess * half_sin;
    stiffness->stiff_axis_rad = (float)(int32_t)twice_axis * (3.14159265f / 0x1p32f);
    return BRACE_OK;
}
