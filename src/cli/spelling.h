/* spelling.h - the options in the library's messages. */
#ifndef FFD_CLI_SPELLING_H
#define FFD_CLI_SPELLING_H

#include <stddef.h>

/* An ffd_spell_function: "--falloff", "--outside extend". */
void cli_spell(const char *member, const char *value, char *text, size_t capacity);

#endif
