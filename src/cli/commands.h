/* commands.h - the table of commands. */
#ifndef FFD_CLI_COMMANDS_H
#define FFD_CLI_COMMANDS_H

#include "cli/command.h"

/* All commands, in the order of the help, terminated by NULL. */
extern const cli_command *const cli_commands[];

#endif
