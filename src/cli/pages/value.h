/* value.h - what a shell can offer for a value: words, and files by their endings. */
#ifndef FFD_CLI_PAGES_VALUE_H
#define FFD_CLI_PAGES_VALUE_H

#include "cli/command.h"

/* "keep|extend|error" are words, "LATTICE|FILE.npy" files of these kinds; what is not known ("N,M,O") is the
   user's own to know, and nothing is offered. */
typedef struct pages_value {
    char words[200];   /* separated by spaces, "": none */
    char endings[200]; /* of files, without their points, separated by |; "": any */
    bool files, folders;
    bool list; /* any number of the words, separated by commas */
} pages_value;

/* What shells complete for the value of an option. */
pages_value pages_option_value(const cli_option *option);

/* What shells complete for the arguments of a command that are not options. */
pages_value pages_command_arguments(const cli_command *command);

#endif
