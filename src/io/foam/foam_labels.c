/* foam_labels.c - lists: N ( .. ), or N { one for all }. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/foam/foam_file.h"
#include <inttypes.h>
#include <stdio.h>

/* Labels are numbers of faces, points and cells, of which the last one stands for none. */
#define LARGEST_LABEL (UINT32_MAX - 1)
/* A digit and a blank. */
#define LEAST_TEXT 2

/* Checks that the bytes that are left can hold the elements. */
static ffd_status check_count(const foam_file *f, const char *what, size_t least, uint64_t count)
{
    const uint64_t left = (uint64_t)(f->scan.last - f->scan.at);
    return count <= (left + !f->is_binary) / least
               ? FFD_OK
               : FOAM_REFUSE(f, "the file ends too early: %" PRIu64 " bytes are left for %" PRIu64 " %s",
                             left, count, what);
}

ffd_status ffd_foam_list(foam_file *f, const char *what, size_t least, uint64_t most, foam_list *list,
                         uint64_t *count)
{
    char number[80];
    snprintf(number, sizeof number, "the number of %s", what);
    TRY(ffd_foam_whole(f, number, count));
    *list = FOAM_EMPTY;
    if (*count == 0 && !(ffd_code_find(&f->scan) && *f->scan.at == '('))
        return FFD_OK;
    if (*count > 0 && *count <= most && ffd_code_mark(&f->scan, '{')) {
        *list = FOAM_SAME;
        return FFD_OK;
    }
    TRY(ffd_foam_mark(f, '(', what));
    *list = FOAM_ELEMENTS;
    return check_count(f, what, least, *count);
}

ffd_status ffd_foam_list_end(foam_file *f, const char *what, foam_list list)
{
    return list == FOAM_EMPTY ? FFD_OK : ffd_foam_mark(f, list == FOAM_SAME ? '}' : ')', what);
}

/* Takes a number of a list. */
static ffd_status take(foam_file *f, bool is_binary, const char *what, uint32_t *label)
{
    const size_t size = ffd_type_size(f->label);
    uint64_t value = 0;
    bool is_whole = true;
    if (!is_binary)
        TRY(ffd_foam_whole(f, "a whole number", &value));
    else {
        is_whole = ffd_type_load_whole(f->label, false, f->scan.at, &value);
        f->scan.at += size;
    }
    *label = (uint32_t)value;
    if (!is_whole)
        return FOAM_REFUSE(f, "a number among the %s is below 0", what);
    return value <= LARGEST_LABEL ? FFD_OK
                                  : FOAM_REFUSE(f, "%" PRIu64 " is too large for one of the %s", value, what);
}

ffd_status ffd_foam_labels(foam_file *f, const char *what, uint64_t most, foam_labels *labels)
{
    foam_list list;
    uint64_t count;
    uint32_t label = 0;
    TRY(ffd_foam_list(f, what, f->is_binary ? ffd_type_size(f->label) : LEAST_TEXT, most, &list, &count));
    if (list == FOAM_EMPTY)
        return FFD_OK;
    if (!ffd_grow((void **)&labels->values, &labels->capacity, labels->count + (size_t)count,
                  sizeof *labels->values))
        return ffd_fail_memory(f->error);
    if (list == FOAM_SAME)
        TRY(take(f, false, what, &label));
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, f->error));
        if (list == FOAM_ELEMENTS)
            TRY(take(f, f->is_binary, what, &label));
        labels->values[labels->count++] = label;
    }
    return ffd_foam_list_end(f, what, list);
}
