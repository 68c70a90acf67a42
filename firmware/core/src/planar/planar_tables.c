#include "planar/planar_tables.h"

/* pi/4 - atan(t 2^31/BRACE_AXIS_ONE) on the sixteenths [i/8, (i+1)/8) of [-1, 1], as cubics in the place d within the
 * sixteenth: Chebyshev interpolation, error 4e-7 rad. Each row is two words of 64 bits that start a
 * multiply-accumulate: their low halves are themselves factors, and weigh as fractions below the last bit. */
#define ROW(c0, c1, c2, c3) {WORD(c0, c1), WORD(c2, c3)}
#define WORD(high, low) ((int64_t)(((uint64_t)(uint32_t)(high) << 32) | (uint32_t)(low)))

const brace_axis_row_t brace_axis_table[BRACE_AXIS_ROWS] = {
    ROW(843315105, -536867199, -537141488, -352700339),
    ROW(807576565, -608119743, -604095015, -305869509),
    ROW(767134627, -687157053, -662676090, -186098831),
    ROW(721553257, -772065081, -699110918, 33277329),
    ROW(670576372, -858904261, -694311553, 361467536),
    ROW(614270935, -941261733, -627105475, 765230194),
    ROW(553179300, -1010495544, -482517957, 1152716458),
    ROW(488419996, -1057185296, -263470281, 1395275489),
    ROW(421657479, -1073768196, 1856127, 1395275489),
    ROW(354894939, -1057301893, 266383621, 1152716458),
    ROW(290135587, -1010682376, 483624813, 765230194),
    ROW(229043906, -941457258, 626536390, 361467536),
    ROW(172738445, -859063977, 692871419, 33277329),
    ROW(121761558, -772172410, 697569621, -186098831),
    ROW(76180196, -687216028, 661445548, -305869509),
    ROW(35738269, -608143092, 603272802, -352700339),
};
