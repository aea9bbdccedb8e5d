#include "io/obj/obj_names.h"
#include "base/memory/memory.h"
#include <stdlib.h>
#include <string.h>

text_word ffd_obj_names_line(obj_scan *scan)
{
    text_word name = {0}, word;
    while (ffd_obj_scan_word(scan, &word))
        name = (text_word){name.first ? name.first : word.first, word.last};
    return name;
}

static int compare_words(const void *a, const void *b)
{
    const text_word *x = a, *y = b;
    const ptrdiff_t x_size = x->last - x->first, y_size = y->last - y->first;
    if (x_size != y_size)
        return x_size < y_size ? -1 : 1;
    return memcmp(x->first, y->first, (size_t)x_size);
}

bool ffd_obj_names_add(obj_names *names, text_word word)
{
    /* Many files repeat the name for every face. */
    if (names->count && compare_words(&names->words[names->count - 1], &word) == 0)
        return true;
    if (!ffd_grow((void **)&names->words, &names->capacity, names->count + 1, sizeof *names->words))
        return false;
    names->words[names->count++] = word;
    return true;
}

size_t ffd_obj_names_distinct(obj_names *names)
{
    if (names->count < 2)
        return names->count;
    qsort(names->words, names->count, sizeof *names->words, compare_words);
    size_t distinct = 1;
    for (size_t i = 1; i < names->count; i++)
        if (compare_words(&names->words[distinct - 1], &names->words[i]) != 0)
            names->words[distinct++] = names->words[i];
    return names->count = distinct;
}

void ffd_obj_names_free(obj_names *names)
{
    ffd_free(names->words);
    memset(names, 0, sizeof *names);
}
