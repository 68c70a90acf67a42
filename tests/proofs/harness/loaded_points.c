#include "proof.h"
#include "loaded_sizes.h"
#include "loaded/fixed_link.h"

#include "fixed/fixed_table.c"
static bool is_in(int64_t number, int64_t most)
{
    return number <= most && number >= -most;
}
int main(void)
{
    fixed_shape_t shape;
    const int32_t root = shape.root;
    ASSUME(is_in(shape.root, ROOT_ANGLE_MOST) && is_in(shape.a, CURVATURE_MOST) && is_in(shape.b, CURVATURE_MOST));
    const double a1 = 0.5, b1 = -0.0773502692, a2 = 1.07735027, b2 = 0.5;
    const int32_t first = fixed_turn_at(&shape, Q30(a1), Q30(b1));
    const int32_t second = fixed_turn_at(&shape, Q30(a2), Q30(b2)), end = fixed_end_turn(&shape);
    PROVE(is_in((int64_t)first - root, NEAR_MOST), "the first point is near the root");
    PROVE(is_in((int64_t)second - root, SECOND_MOST - ROOT_ANGLE_MOST), "the second point is");
    PROVE(is_in((int64_t)second - first, FAR_MOST), "the second is not far from the first");
    PROVE(is_in((int64_t)second - end, NEAR_MOST), "nor from the end");
    return 0;
}
