/* What the C library must not be asked for on the limb. */
#include <stdio.h>
#include <stdlib.h>

void library_bad(int value);

void library_bad(int value)
{
    int *const kept = malloc(16); /* BAD: library */
    if (kept != NULL) {
        kept[0] = value;
        printf("%d\n", kept[0]); /* BAD: library */
        free(kept);               /* BAD: library */
    }
}
