#include "cli/three.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

bool cli_split_three(const char *value, char part[3][CLI_PART])
{
    const bool is_one = !strchr(value, ',');
    for (int a = 0; a < 3; a++) {
        const size_t length = strcspn(value, ",");
        if (length == 0 || length >= CLI_PART)
            return false;
        memcpy(part[a], value, length);
        part[a][length] = 0;
        if (is_one)
            continue;
        value += length;
        if (a < 2 ? *value != ',' : *value != 0)
            return false;
        value++;
    }
    return true;
}

bool cli_parse_count(const char *text, long least, long greatest, long *count)
{
    char *end;
    errno = 0;
    *count = strtol(text, &end, 10);
    return *text >= '0' && *text <= '9' && *end == 0 && !errno && *count >= least && *count <= greatest;
}
