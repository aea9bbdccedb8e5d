#include "base/text/size.h"
#include "base/text/number.h"
#include <string.h>

bool ffd_size_parse(const char *text, uint64_t *bytes)
{
    static const char units[] = "KMG";
    double number = 0, unit = 1;
    const char *const end = text + strlen(text), *const digits = ffd_number_parse(text, end, &number);
    const char *const letter = digits && digits + 1 == end ? strchr(units, *digits) : NULL;
    for (const char *u = units; letter && u <= letter; u++)
        unit *= 1000;
    if (!digits || digits + (letter != NULL) != end || !(number * unit >= 1 && number * unit < 0x1p63))
        return false;
    *bytes = (uint64_t)(number * unit);
    return true;
}
