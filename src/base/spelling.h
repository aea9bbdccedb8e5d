/* spelling.h - how messages name the members of descriptions. The texts of messages have them in braces:
   "{falloff} needs {outside=extend}". The front end's function (ffd_spell_members) says how they read. */
#ifndef FFD_BASE_SPELLING_H
#define FFD_BASE_SPELLING_H

#include <ffd/program.h>

/* The function in use, for what a process loads with messages of its own. */
ffd_spell_function ffd_spelling(void);

/* Returns a text with its members spelled: the text itself if it has none, else buffer, where the text is cut
   to fit. ffd_fail and ffd_log_line spell their formats by themselves, never their arguments. */
const char *ffd_spelled(const char *text, char *buffer, size_t capacity);

/* The same in a buffer that lives until the end of the enclosing block: for arguments of messages. */
#define SPELLED(text) ffd_spelled(text, (char[512]){0}, 512)

#endif
