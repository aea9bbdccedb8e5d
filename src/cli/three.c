#include "cli/three.h"
#include <errno.h>
#include <ffd/ffd.h>
#include <limits.h>
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

/* Parses three whole numbers, or one for all. part: their texts, for messages. */
static bool parse_counts(const char *value, long least, long greatest, char part[3][CLI_PART], long counts[3])
{
    bool right = cli_split_three(value, part);
    for (int a = 0; right && a < 3; a++)
        right = cli_parse_count(part[a], least, greatest, &counts[a]);
    return right;
}

/* Whether a direction has one layer. */
static bool is_plane(char part[3][CLI_PART])
{
    return strcmp(part[0], "1") == 0 || strcmp(part[1], "1") == 0 || strcmp(part[2], "1") == 0;
}

bool cli_set_sizes(void *settings, const cli_option *option, const char *value)
{
    size_t *const size = (size_t *)((char *)settings + option->offset);
    char part[3][CLI_PART] = {{0}};
    long counts[3];
    if (!parse_counts(value, 2, LONG_MAX, part, counts)) {
        cli_complain("--%s: \"%.80s\" is not one or three whole numbers of at least 2, like 4,4,4%s",
                     option->name, value,
                     is_plane(part) ? ": a plane needs two layers that move alike: --size 5,5,2 --degree "
                                      "3,3,1, and \"at\": [i, j, \"all\"]"
                                    : "");
        return false;
    }
    for (int a = 0; a < 3; a++)
        size[a] = (size_t)counts[a];
    return true;
}

bool cli_set_degrees(void *settings, const cli_option *option, const char *value)
{
    int *const degree = (int *)((char *)settings + option->offset);
    char part[3][CLI_PART];
    long counts[3];
    if (!parse_counts(value, 1, FFD_MAX_DEGREE, part, counts)) {
        cli_complain("--%s: \"%.80s\" is not one or three whole numbers from 1 to %d, like 3,3,3",
                     option->name, value, FFD_MAX_DEGREE);
        return false;
    }
    for (int a = 0; a < 3; a++)
        degree[a] = (int)counts[a];
    return true;
}

const char *const cli_knots_names[] = {"clamped", "open", "unclamped", "uniform", "closed", "periodic", NULL};
#define KNOTS_NAMES (sizeof cli_knots_names / sizeof *cli_knots_names - 1)

bool cli_read_knots(ffd_knots knots[3], const cli_option *option, const char *value)
{
    static const ffd_knots known[] = {FFD_KNOTS_CLAMPED, FFD_KNOTS_OPEN,   FFD_KNOTS_OPEN,
                                      FFD_KNOTS_UNIFORM, FFD_KNOTS_CLOSED, FFD_KNOTS_CLOSED};
    char part[3][CLI_PART];
    const char *meant = NULL;
    bool right = cli_split_three(value, part);
    for (int a = 0; right && a < 3; a++) {
        right = false;
        for (size_t i = 0; !right && i < KNOTS_NAMES; i++)
            if (strcmp(part[a], cli_knots_names[i]) == 0) {
                knots[a] = known[i];
                right = true;
            }
        meant = right ? NULL : ffd_word_meant(part[a], cli_knots_names, KNOTS_NAMES);
    }
    if (!right)
        cli_complain("--%s: \"%s\" is not one or three of clamped, open, uniform, closed%s%s%s", option->name,
                     value, meant ? " (nearest: " : "", meant ? meant : "", meant ? ")" : "");
    return right;
}

bool cli_read_margin(double margin[3], const cli_option *option, const char *value, bool *are_three)
{
    char part[3][CLI_PART];
    bool right = cli_split_three(value, part);
    *are_three = strchr(value, ',') != NULL;
    for (int a = 0; right && a < 3; a++)
        right = cli_parse_number(part[a], &margin[a]) && margin[a] >= 0;
    if (!right)
        cli_complain("--%s: \"%s\" is not a number of at least 0, nor three like 0.1,0,0.1", option->name,
                     value);
    return right;
}
