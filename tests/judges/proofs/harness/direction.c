/* An angle in floats, brought near zero: every angle that brace_direction takes. */
#include <math.h>

#include "proof.h"

/* Rounded once, as the processor does it: any float that the sum may be rounded to. A product of two floats is exact in
 * a double; `off` is more than the sum in doubles can be wrong by. */
float fmaf(float a, float b, float c)
{
    const double product = (double)a * b, near = product + c;
    const double off = (fabs(product) + fabs(c)) * 2.3e-16;
    double sum; /* any */
    ASSUME(sum >= near - off && sum <= near + off);
    return (float)sum;
}

#include "base/trig.h"

int main(void)
{
    const float angle_rad = any_float();
    ASSUME(angle_rad >= -16.0f && angle_rad <= 16.0f);
    const float half_turns = brace_half_turns(angle_rad);
    const float rest_rad = brace_less_half_turns(angle_rad, half_turns);
    const int32_t whole = (int32_t)half_turns; /* as brace_direction does it; CBMC checks that it fits */
    PROVE(half_turns >= -5.0f && half_turns <= 5.0f && half_turns == (float)whole, "half turns are a whole number");
    PROVE(rest_rad >= -1.5708f && rest_rad <= 1.5708f, "what is left is a quarter turn at most");
    return 0;
}
