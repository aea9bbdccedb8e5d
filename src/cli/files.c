#include "cli/files.h"
#include "cli/command.h"
#include <stdlib.h>
#include <string.h>

bool cli_is_stream(const char *path)
{
    return strcmp(path, "-") == 0 || strcmp(path, "/dev/stdin") == 0 || strcmp(path, "/dev/stdout") == 0;
}

bool cli_add_file(ffd_source **list, size_t *count, const cli_option *option, const char *value)
{
    if (!*value || cli_is_stream(value)) {
        cli_complain("--%s names a file, not %s", option->name, *value ? "standard input" : "nothing");
        return false;
    }
    ffd_source *const more = realloc(*list, (*count + 1) * sizeof *more);
    if (!more) {
        cli_complain("out of memory");
        return false;
    }
    more[(*count)++] = (ffd_source){.path = value};
    *list = more;
    return true;
}
