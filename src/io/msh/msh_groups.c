/* msh_groups.c - the physical groups of a mesh of Gmsh, and the entities that are in them. */
#include "base/memory/memory.h"
#include "io/msh/msh_reader.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes a name in quotes, to the end of its line. */
static ffd_status take_name(msh_reader *r, text_word *name)
{
    const char *at = r->scan.at, *end = at;
    while (end < r->scan.last && *end != '\n')
        end++;
    const char *const first = memchr(at, '"', (size_t)(end - at));
    const char *last = end;
    while (first && last > first + 1 && last[-1] != '"')
        last--;
    if (!first || last <= first + 1)
        return MSH_REFUSE(r, "a physical group has no name in quotes");
    *name = (text_word){first + 1, last - 1};
    r->scan.at = end;
    return FFD_OK;
}

static int compare_names(const void *a, const void *b)
{
    const msh_name *const x = a, *const y = b;
    if (x->dimension != y->dimension)
        return x->dimension < y->dimension ? -1 : 1;
    return x->tag < y->tag ? -1 : x->tag > y->tag;
}

/* The number of names; for each a line of dimension, tag and name, also in binary. */
ffd_status ffd_msh_names(msh_reader *r)
{
    const bool is_binary = r->is_binary;
    uint64_t count;
    r->is_binary = false;
    ffd_status status;
    TRY_END(ffd_msh_count(r, "the number of names", 4, &count));
    for (uint64_t i = 0; i < count; i++) {
        msh_name name;
        TRY_END(ffd_msh_size(r, "the dimension of a group", &name.dimension));
        TRY_END(ffd_msh_size(r, "the tag of a group", &name.tag));
        TRY_END(take_name(r, &name.name));
        if (!ffd_grow((void **)&r->names, &r->name_capacity, r->name_count + 1, sizeof *r->names))
            TRY_END(ffd_fail_memory(r->error));
        r->names[r->name_count++] = name;
    }
    if (r->name_count > 1)
        qsort(r->names, r->name_count, sizeof *r->names, compare_names);
end:
    r->is_binary = is_binary;
    return status;
}

/* Tag, place or box, physical tags; of all but points the entities around it. */
static ffd_status take_entity(msh_reader *r, uint64_t dimension)
{
    int64_t tag, physical, bounding;
    uint64_t count;
    TRY(ffd_msh_int(r, "the tag of an entity", &tag));
    TRY(ffd_msh_skip(r, dimension == 0 ? 3 : 6));
    TRY(ffd_msh_count(r, "the number of physical tags", 2, &count));
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_msh_int(r, "a physical tag", &physical));
        if (!ffd_grow((void **)&r->entities, &r->entity_capacity, r->entity_count + 1, sizeof *r->entities))
            return ffd_fail_memory(r->error);
        r->entities[r->entity_count++] = (msh_entity){dimension, tag, physical};
    }
    if (dimension == 0)
        return FFD_OK;
    TRY(ffd_msh_count(r, "the number of entities around another", 2, &count));
    for (uint64_t i = 0; i < count; i++)
        TRY(ffd_msh_int(r, "an entity around another", &bounding));
    return FFD_OK;
}

static int compare_entities(const msh_entity *a, const msh_entity *b)
{
    if (a->dimension != b->dimension)
        return a->dimension < b->dimension ? -1 : 1;
    return a->tag < b->tag ? -1 : a->tag > b->tag;
}

static int compare_rows(const void *a, const void *b)
{
    return compare_entities(a, b);
}

ffd_status ffd_msh_entities(msh_reader *r)
{
    uint64_t counts[4];
    for (int dimension = 0; dimension < 4; dimension++)
        TRY(ffd_msh_count(r, "the number of entities", 8, &counts[dimension]));
    for (uint64_t dimension = 0; dimension < 4; dimension++)
        for (uint64_t i = 0; i < counts[dimension]; i++)
            TRY(take_entity(r, dimension));
    if (r->entity_count > 1)
        qsort(r->entities, r->entity_count, sizeof *r->entities, compare_rows);
    return FFD_OK;
}

size_t ffd_msh_find_entity(const msh_reader *r, const msh_entity *wanted)
{
    size_t first = 0, last = r->entity_count;
    while (first < last) {
        const size_t middle = first + (last - first) / 2;
        if (compare_entities(&r->entities[middle], wanted) < 0)
            first = middle + 1;
        else
            last = middle;
    }
    return first;
}

bool ffd_msh_is_entity(const msh_reader *r, size_t row, const msh_entity *wanted)
{
    return row < r->entity_count && compare_entities(&r->entities[row], wanted) == 0;
}

ffd_status ffd_msh_physical(msh_reader *r, uint64_t dimension, int64_t physical, size_t *group)
{
    const uint64_t tag = (uint64_t)(physical < 0 ? -physical : physical);
    char number[24];
    const msh_name wanted = {.dimension = dimension, .tag = tag};
    const msh_name *const found =
        r->name_count ? bsearch(&wanted, r->names, r->name_count, sizeof *r->names, compare_names) : NULL;
    if (found)
        return ffd_volume_group(r->d, found->name.first, (size_t)(found->name.last - found->name.first),
                                group, r->error);
    const int length = snprintf(number, sizeof number, "%" PRIu64, tag);
    return ffd_volume_group(r->d, number, (size_t)length, group, r->error);
}
