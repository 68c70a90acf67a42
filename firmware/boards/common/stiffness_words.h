/* K in words: what the console says of the newest snapshot. */
#ifndef BRACE_BOARDS_STIFFNESS_WORDS_H
#define BRACE_BOARDS_STIFFNESS_WORDS_H

#include "brace/app.h"
#include "text.h"

/* Prints a line `k: ...`; of a limb in space a line `space: ...`, too; of a limb that has drifted a line `drift:
 * ...`. */
void stiffness_words(text_t *text, const brace_app_t *app);

#endif
