/* The angle of every vector that brace_atan2 takes. */
#include "base/trig.c"
#include "proof.h"

int main(void)
{
    const float x = any_float(), y = any_float();
    ASSUME(x >= -1e37f && x <= 1e37f && y >= -1e37f && y <= 1e37f);
    const float angle_rad = brace_atan2(y, x);
    PROVE(angle_rad >= -3.1415928f && angle_rad <= 3.1415928f, "an angle within half a turn");
    PROVE(!(x >= 0.0f) || (angle_rad >= -1.5707964f && angle_rad <= 1.5707964f),
          "within a quarter turn unless x is negative");
    PROVE(!(y >= 0.0f) || angle_rad >= 0.0f, "not negative unless y is");
    PROVE(!(x == 0.0f && y == 0.0f) || angle_rad == 0.0f, "0 for the zero vector");
    return 0;
}
