#include "base/text/stand_in.h"
#include <stdbool.h>
#include <string.h>

/* Whether data begins with a text in small letters. A byte of the text may be above 127. */
static bool begins(const unsigned char *data, size_t size, const char *start)
{
    const size_t length = strlen(start);
    bool same = size >= length;
    for (size_t i = 0; i < length && same; i++) {
        const int lower = data[i] >= 'A' && data[i] <= 'Z' ? data[i] - 'A' + 'a' : data[i];
        same = lower == (unsigned char)start[i];
    }
    return same;
}

const char *ffd_stand_in(const void *data, size_t size)
{
    static const struct {
        const char *start, *name;
    } known[] = {{"version https://git-lfs", STAND_IN_LFS},
                 {"/annex/objects/", STAND_IN_ANNEX},
                 {"<!doctype", STAND_IN_HTML},
                 {"<html", STAND_IN_HTML},
                 {"<head", STAND_IN_HTML},
                 {"<!--", STAND_IN_HTML}};
    const unsigned char *at = data;
    const size_t mark = begins(at, size, "\xef\xbb\xbf") ? 3 : 0;
    size_t first = mark;
    while (first < size && memchr(" \t\r\n", at[first], 4))
        first++;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (begins(at + first, size - first, known[i].start))
            return known[i].name;
    return NULL;
}
