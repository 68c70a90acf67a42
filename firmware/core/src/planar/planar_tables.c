#include "planar/planar_tables.h"

/* pi/4 - atan(t 2^31/BRACE_AXIS_ONE) on the eighths [i/4, (i+1)/4) of [-1, 1], as quartics, error 3e-7 rad: each
 * coefficient rounded to what its place holds, from the highest, and the lower ones fitted anew to what is left. */
#define ROW(c0, c1, c2, c3, c4) {WORD(c0, c1), WORD(c2, (uint32_t)(c3) << 16 | (uint16_t)(c4))}
#define WORD(high, low) ((int64_t)(((uint64_t)(uint32_t)(high) << 32) | (uint32_t)(low)))

const brace_axis_row_t brace_axis_table[BRACE_AXIS_ROWS] = {
    ROW(405077202, -1264280841, -825104493, -78, 2865),
    ROW(418270607, -1123564444, -259085606, 15450, 13393),
    ROW(421692933, -1071831626, 36580051, 27015, 24622),
    ROW(421657583, -1073678039, 4289634, 23371, 14779),
    ROW(421657269, -1073677717, -4296344, 23371, -14779),
    ROW(421621830, -1071830023, -36589054, 27015, -24622),
    ROW(425045050, -1123572251, 259110753, 15449, -13393),
    ROW(438238126, -1264284120, 825112020, -79, -2865),
};
