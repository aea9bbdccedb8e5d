/* member.h - the options that are members of ffd_deform_desc (ffd/settings.h), and their names in the
   library's messages. */
#ifndef FFD_CLI_MEMBER_H
#define FFD_CLI_MEMBER_H

#include "cli/options.h"

/* An ffd_spell_function: "--falloff", "--outside extend". */
void cli_spell(const char *member, const char *value, char *text, size_t capacity);

/* A setter: of the member that is called as the option is, in the ffd_deform_desc at the option's offset. */
bool cli_set_member(void *settings, const cli_option *option, const char *value);

#endif
