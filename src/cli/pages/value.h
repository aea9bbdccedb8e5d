/* value.h - what a shell can complete for a value: words, and files by their endings. */
#ifndef FFD_CLI_PAGES_VALUE_H
#define FFD_CLI_PAGES_VALUE_H

#include "cli/command.h"

/* "keep|extend|error" are words, "LATTICE|FILE.npy" are kinds of files. Nothing is completed for other names,
   such as "N,M,O". */
typedef struct pages_value {
    char words[200];   /* separated by spaces; "": none */
    char endings[200]; /* of files, without dots, separated by |; "": any */
    const char *whole; /* files of this name too; NULL: none */
    bool files, folders;
    bool list; /* a list: any number of the words, separated by commas */
} pages_value;

/* Returns what shells complete for the value of an option. */
pages_value pages_option_value(const cli_option *option);

/* Returns what shells complete for the positional arguments of a command. */
pages_value pages_command_arguments(const cli_command *command);

#endif
