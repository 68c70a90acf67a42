#include "base/trig.h"

#include <float.h>

/* atan's short polynomial holds for tangents below this. The limit is a little above tan(pi/8), so that two turns by
 * pi/4 bring any vector of the first quadrant below it. */
#define SMALL_TANGENT 0.421875f

/* The angle of (|x|, |y|): the vector is turned back by pi/4 until it is near +x, and then mirrored. */
float brace_atan2(float y, float x)
{
    float across = fabsf(y), along = fabsf(x), angle = 0.0f;
    while (across > SMALL_TANGENT * along) { /* at most twice */
        const float less = across - along;
        along += across;
        across = less;
        angle += BRACE_QUARTER_PI;
    }
    const float tangent = across / (along + FLT_MIN);
    const float u = tangent * tangent;
    /* atan(t)/t - 1 for |t| <= 27/64; error 6e-9 */
    float sum = 7.80888081e-2f;
    sum = sum * u - 0.13794738f;
    sum = sum * u + 0.19969f;
    sum = sum * u - 0.33332675f;
    angle += sum * (u * tangent) + tangent;
    if (x < 0.0f) {
        angle = BRACE_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}
