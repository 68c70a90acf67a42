/* Turns about the frame's axes, each against the product of whole matrices in double: K is put together by them. */
#include <math.h>
#include <string.h>

#pragma GCC diagnostic ignored "-Wunused-function" /* this suite does not call all functions of the header */
#include "loaded/space_frame.h"
#include "unity.h"

enum { X, Y, Z };

static const float angle_rad[] = {-2.9f, -0.7f, 0.0f, 0.4f, 1.5f, 3.0f};
static const sym3_t some = {.xx = 2.0f, .xy = -0.3f, .xz = 0.7f, .yy = 5.0f, .yz = 1.1f, .zz = 3.5f};

void setUp(void) {}

void tearDown(void) {}

/* The matrix of a turn about an axis, counterclockwise for who looks against it. */
static void turn_of(int axis, double rad, double turn[3][3])
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    memset(turn, 0, 9 * sizeof(double));
    turn[axis][axis] = 1.0;
    turn[a][a] = turn[b][b] = cos(rad);
    turn[a][b] = -sin(rad);
    turn[b][a] = sin(rad);
}

static void turned(double turn[3][3], const double m[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[i][j] = 0.0;
            for (int k = 0; k < 3; k++) {
                for (int l = 0; l < 3; l++) {
                    out[i][j] += turn[i][k] * m[k][l] * turn[j][l];
                }
            }
        }
    }
}

static void test_a_symmetric_matrix_turns_about_each_axis(void)
{
    static void (*const about[3])(sym3_t *, brace_vec_t) = {sym3_about_x, sym3_about_y, sym3_about_z};
    const double m[3][3] = {{some.xx, some.xy, some.xz}, {some.xy, some.yy, some.yz}, {some.xz, some.yz, some.zz}};
    for (int axis = X; axis <= Z; axis++) {
        for (unsigned i = 0; i < sizeof angle_rad / sizeof *angle_rad; i++) {
            double turn[3][3], wanted[3][3];
            turn_of(axis, angle_rad[i], turn);
            turned(turn, m, wanted);
            sym3_t found = some;
            about[axis](&found, (brace_vec_t){cosf(angle_rad[i]), sinf(angle_rad[i])});
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[X][X], found.xx);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[X][Y], found.xy);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[X][Z], found.xz);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[Y][Y], found.yy);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[Y][Z], found.yz);
            TEST_ASSERT_FLOAT_WITHIN(1e-5f, (float)wanted[Z][Z], found.zz);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_symmetric_matrix_turns_about_each_axis);
    return UNITY_END();
}
