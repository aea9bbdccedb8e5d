#include "base/memory/slots.h"
#include "base/memory/memory.h"
#include <string.h>

void *ffd_slots_make(size_t keys, size_t size, size_t *mask)
{
    size_t count = 16;
    while (count / 2 < keys)
        count *= 2;
    *mask = count - 1;
    void *slots = ffd_alloc(count, size);
    if (slots)
        memset(slots, 0xff, count * size);
    return slots;
}
