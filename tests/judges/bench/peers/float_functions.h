/* Included ahead of CasADi's text, which names C's double functions whatever its type: the float ones instead. */
#include <math.h>

#define sin sinf
#define cos cosf
#define acos acosf
#define atan2 atan2f
#define sqrt sqrtf
#define fabs fabsf
#define fmin fminf
#define fmax fmaxf
