/* volume_select.c - groups of vertices, as `--only` selects by them. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/volume/volume_document.h"
#include "mesh/listing.h"
#include <stdio.h>
#include <string.h>

#define LONGEST_NAME 200 /* bytes of a group's name in messages */

static const char *name_of(const volume_document *d, size_t group)
{
    return ffd_intern_key(&d->group_names, (uint32_t)group);
}

static ffd_status refuse(const volume_document *d, const selector_nearest *nearest, ffd_error *error)
{
    const ffd_status status = ffd_selector_unknown(nearest, d->file.name, error);
    if (!d->lacks_groups || !error)
        return status;
    const ffd_error own = *error;
    return ffd_fail_file(error, status, d->file.name, "%s (%s)", own.message, d->lacks_groups);
}

static ffd_status mark(mesh_document *document, const mesh_selector *selector, uint8_t *marks,
                       ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    selector_nearest nearest = {.selector = selector};
    bool found = false;
    for (size_t g = 0; g < d->group_count; g++) {
        const volume_group *const group = &d->groups[g];
        if (!ffd_selector_is(selector, name_of(d, g), strlen(name_of(d, g))))
            continue;
        found = true;
        for (size_t i = 0; i < group->count; i++)
            marks[group->vertices[i]] = 1;
    }
    for (size_t g = 0; g < d->group_count && !found; g++)
        ffd_selector_offer(&nearest, name_of(d, g), strlen(name_of(d, g)));
    return found ? FFD_OK : refuse(d, &nearest, error);
}

static ffd_status select_groups(mesh_document *document, const mesh_selector *selectors, size_t count,
                                ffd_error *error)
{
    volume_document *const d = (volume_document *)document;
    d->selected = ffd_alloc_zero(d->file.part.vertex_count, 1);
    if (!d->selected)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        TRY(mark(document, &selectors[i], d->selected, error));
    d->file.part.selected = d->selected;
    d->file.part.skipped = !memchr(d->selected, 1, d->file.part.vertex_count);
    return FFD_OK;
}

static ffd_status list(const mesh_document *document, mesh_listing *listing, ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    for (size_t g = 0; g < d->group_count; g++) {
        const volume_group *const group = &d->groups[g];
        TRY(ffd_listing_add(listing, SELECT_GROUP, name_of(d, g), strlen(name_of(d, g)), g, error));
        ffd_listing_draw(listing, 0, group->vertices, group->count);
    }
    return FFD_OK;
}

static bool has_vertex(const volume_group *group, uint64_t vertex)
{
    for (size_t i = 0; i < group->count; i++)
        if (group->vertices[i] == vertex)
            return true;
    return false;
}

static uint64_t name_owner(const mesh_document *document, uint64_t vertex, uint8_t *marks, char *name,
                           size_t capacity)
{
    const volume_document *const d = ffd_volume_of(document);
    char shown[LONGEST_NAME + 1];
    uint64_t marked = 0;
    size_t g = 0;
    *name = 0;
    while (g < d->group_count && !has_vertex(&d->groups[g], vertex))
        g++;
    if (g == d->group_count)
        return 0;
    ffd_name_shown(name_of(d, g), shown, sizeof shown);
    snprintf(name, capacity, "group:%s", shown);
    for (size_t i = 0; i < d->groups[g].count; i++) {
        uint8_t *const of = &marks[d->groups[g].vertices[i]];
        marked += *of != 0;
        *of = 0;
    }
    return marked;
}

const mesh_selector_calls ffd_volume_selectors = {.kinds = SELECTOR_BIT(SELECT_GROUP),
                                                  .mark_kinds = SELECTOR_BIT(SELECT_GROUP),
                                                  .select = select_groups,
                                                  .mark = mark,
                                                  .list = list,
                                                  .name_owner = name_owner};
