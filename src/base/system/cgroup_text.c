#include "base/system/cgroup_text.h"
#include <stddef.h>
#include <string.h>

bool ffd_cgroup_controls(const char *controllers, const char *controller)
{
    const size_t length = strlen(controller);
    if (length == 0)
        return *controllers == 0;
    for (const char *at = controllers; at; at = strchr(at, ',')) {
        at += *at == ',';
        if (strncmp(at, controller, length) == 0 && (at[length] == ',' || at[length] == 0))
            return true;
    }
    return false;
}

/* A line is "NUMBER:CONTROLLERS:PATH". */
bool ffd_cgroup_place(char *line, cgroup_place *place)
{
    char *const list = strchr(line, ':'), *const path = list ? strchr(list + 1, ':') : NULL;
    if (!path || path[1] != '/')
        return false;
    *path = 0;
    *place = (cgroup_place){list + 1, path + 1};
    return true;
}

/* Ends the field at *at, moves *at to the next one, and returns the field. NULL: the line has no more. */
static char *next_field(char **at)
{
    char *const field = *at, *const blank = field ? strchr(field, ' ') : NULL;
    if (blank)
        *blank = 0;
    *at = blank ? blank + 1 : NULL;
    return field;
}

static bool is_octal(const char *text)
{
    for (int i = 0; i < 3; i++)
        if (text[i] < '0' || text[i] > '7')
            return false;
    return true;
}

/* Replaces \040 and the like, which stand for a blank, a tab, a line break and a backslash. */
static void unescape(char *text)
{
    char *to = text;
    for (const char *at = text; *at; at++) {
        if (*at == '\\' && is_octal(at + 1)) {
            *to++ = (char)((at[1] - '0') * 64 + (at[2] - '0') * 8 + at[3] - '0');
            at += 3;
        } else
            *to++ = *at;
    }
    *to = 0;
}

/* A line is "ID PARENT DEVICE ROOT POINT OPTIONS [TAG ...] - TYPE SOURCE OPTIONS". Those of version 1 name
   its controllers. */
bool ffd_cgroup_mount(char *line, cgroup_mount *mount)
{
    char *at = line, *field[6], *word;
    if (!strstr(line, " - cgroup")) /* most lines */
        return false;
    for (int i = 0; i < 6; i++)
        field[i] = next_field(&at);
    while ((word = next_field(&at)) && strcmp(word, "-") != 0)
        ;
    const char *const type = next_field(&at);
    next_field(&at);
    const char *const options = next_field(&at);
    const bool is_second = options && strcmp(type, "cgroup2") == 0;
    if (!options || field[3][0] != '/' || field[4][0] != '/' || (!is_second && strcmp(type, "cgroup") != 0))
        return false;
    unescape(field[3]);
    unescape(field[4]);
    *mount = (cgroup_mount){is_second ? "" : options, field[3], field[4]};
    return true;
}

/* Whether a path has a component "..". */
static bool goes_up(const char *path)
{
    for (const char *at = strstr(path, "/.."); at; at = strstr(at + 1, "/.."))
        if (at[3] == '/' || at[3] == 0)
            return true;
    return false;
}

/* A root as "/../.." lies above that of the namespace. */
const char *ffd_cgroup_below(const char *root, const char *path)
{
    const size_t length = strcmp(root, "/") == 0 ? 0 : strlen(root);
    if (strncmp(root, path, length) == 0 && (path[length] == '/' || path[length] == 0) &&
        !goes_up(path + length))
        return path[length] && path[length + 1] ? path + length : "";
    return goes_up(root) && !goes_up(path) ? "" : NULL;
}

/* Reads a number, which ends the text or comes before a blank. Returns its end, or NULL. A number beyond 64
   bits is UINT64_MAX. */
static const char *read_number(const char *text, uint64_t *number)
{
    const char *at = text;
    *number = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        const uint64_t digit = (uint64_t)(*at - '0');
        *number = *number > (UINT64_MAX - digit) / 10 ? UINT64_MAX : *number * 10 + digit;
    }
    return at > text && (*at == 0 || *at == ' ') ? at : NULL;
}

uint64_t ffd_cgroup_processors(const char *text)
{
    uint64_t quota, period;
    const char *at = read_number(text, &quota);
    at = at && *at ? read_number(at + 1, &period) : NULL;
    if (!at || *at || quota == 0 || quota == UINT64_MAX || period == 0)
        return CGROUP_UNLIMITED;
    return quota / period + (quota % period != 0);
}

/* Version 1 says no limit by the largest one, which depends on the size of a page. */
#define LEAST_UNLIMITED ((uint64_t)1 << 62)

uint64_t ffd_cgroup_bytes(const char *text)
{
    uint64_t bytes;
    const char *const end = read_number(text, &bytes);
    return end && *end == 0 && bytes < LEAST_UNLIMITED ? bytes : CGROUP_UNLIMITED;
}
