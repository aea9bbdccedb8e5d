/* files.h - names of files in a command line. */
#ifndef FFD_CLI_FILES_H
#define FFD_CLI_FILES_H

#include "cli/options.h"
#include <ffd/ffd.h>

/* Whether a path means standard input or output, under any of their names. */
bool cli_is_stream(const char *path);

/* Part of a setter: adds a mesh to a list, which the caller frees. Complains and returns false if the value
   is no name of a file. */
bool cli_add_file(ffd_source **list, size_t *count, const cli_option *option, const char *value);

#endif
