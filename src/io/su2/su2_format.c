#include "io/su2/su2_format.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/su2/su2_sections.h"
#include "io/volume/volume_document.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct su2_reader {
    volume_document *d;
    su2_sections sections;
    uint64_t *first; /* the first vertex of each zone, and their number */
    size_t zones;
    ffd_error *error;
} su2_reader;

#define REFUSE(r, line, ...) ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->file.name, line, __VA_ARGS__)

/* Counts the vertices of each zone, into the place behind its own. */
static ffd_status count_points(su2_reader *r)
{
    r->zones = r->sections.zones ? (size_t)r->sections.zones : 1;
    r->first = ffd_alloc_zero(r->zones + 1, sizeof *r->first);
    if (!r->first)
        return ffd_fail_memory(r->error);
    bool found = false;
    for (size_t i = 0; i < r->sections.count; i++) {
        const su2_section *const s = &r->sections.list[i];
        if (s->kind != SU2_POINTS)
            continue;
        found = true;
        if (r->first[s->zone + 1])
            return REFUSE(r, s->scan.line, "there are points twice in a zone");
        r->first[s->zone + 1] = s->count;
    }
    for (size_t z = 0; z < r->zones; z++)
        r->first[z + 1] += r->first[z];
    return found ? FFD_OK : ffd_fail_file(r->error, FFD_E_INVALID, r->d->file.name, "has no NPOIN= (points)");
}

static ffd_status read_points(su2_reader *r)
{
    TRY(ffd_volume_make_points(r->d, r->first[r->zones], 0, r->error));
    for (size_t i = 0; i < r->sections.count; i++) {
        const su2_section *const s = &r->sections.list[i];
        const char *last;
        size_t line;
        if (s->kind != SU2_POINTS)
            continue;
        const number_run run = {.type = NUMBER_DOUBLE,
                                .is_text = true,
                                .count = (size_t)s->count,
                                .width = r->d->dimensions,
                                .has_lines = true,
                                .comment = SU2_COMMENT,
                                .first = s->scan.at,
                                .last = s->scan.last,
                                .line = s->scan.line};
        TRY(ffd_volume_add_piece(r->d, MESH_POSITIONS, (size_t)r->first[s->zone], &run, &last, &line,
                                 r->error));
    }
    return FFD_OK;
}

/* Takes the kind of the element of a line. */
static ffd_status take_kind(su2_reader *r, text_scan *scan, uint64_t *number)
{
    text_word word = {"", ""};
    ffd_su2_line(scan);
    if (!ffd_su2_word(scan, &word) || !ffd_text_whole(word, number))
        return REFUSE(r, scan->line, "the type of an element is not a whole number: \"%s\"",
                      ffd_text_shown(word).text);
    const cell_kind *const kind = ffd_cell_kind(*number);
    return kind && kind->points
               ? FFD_OK
               : ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, scan->line,
                               "elements of the type %" PRIu64 " are not supported", *number);
}

/* Takes a point of an element: its number in the document. */
static ffd_status take_point(su2_reader *r, text_scan *scan, size_t zone, uint32_t *point)
{
    const uint64_t count = r->first[zone + 1] - r->first[zone];
    text_word word = {"", ""};
    uint64_t number;
    if (!ffd_su2_word(scan, &word) || !ffd_text_whole(word, &number))
        return REFUSE(r, scan->line, "a point of an element is not a whole number: \"%s\"",
                      ffd_text_shown(word).text);
    if (number >= count)
        return REFUSE(r, scan->line,
                      "an element has the point %" PRIu64 ", but there are only %" PRIu64 " (counted from 0)",
                      number, count);
    *point = (uint32_t)(number + r->first[zone]);
    return FFD_OK;
}

static ffd_status read_elements(su2_reader *r, const su2_section *s)
{
    text_scan scan = s->scan;
    uint64_t number;
    uint32_t point;
    for (uint64_t i = 0; i < s->count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(take_kind(r, &scan, &number));
        for (size_t p = 0; p < ffd_cell_kind(number)->points; p++) {
            TRY(take_point(r, &scan, s->zone, &point));
            TRY(ffd_cells_word(&r->d->cells, point, r->error));
        }
        TRY(ffd_cells_end(&r->d->cells, number, r->d->file.part.vertex_count, r->error));
        ffd_text_next_line(&scan);
    }
    return FFD_OK;
}

static ffd_status read_marker(su2_reader *r, const su2_section *s)
{
    text_scan scan = s->scan;
    uint64_t number;
    uint32_t point;
    size_t group;
    TRY(ffd_volume_group(r->d, s->tag.first, (size_t)(s->tag.last - s->tag.first), &group, r->error));
    for (uint64_t i = 0; i < s->count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(take_kind(r, &scan, &number));
        for (size_t p = 0; p < ffd_cell_kind(number)->points; p++) {
            TRY(take_point(r, &scan, s->zone, &point));
            TRY(ffd_volume_group_add(r->d, group, point, r->error));
        }
        ffd_text_next_line(&scan);
    }
    return FFD_OK;
}

/* A group for the points of each zone: "zone 1". */
static ffd_status add_zones(su2_reader *r)
{
    char name[32];
    size_t group;
    for (size_t z = 0; z < r->sections.zones; z++) {
        const int size = snprintf(name, sizeof name, "zone %zu", z + 1);
        TRY(ffd_volume_group(r->d, name, (size_t)size, &group, r->error));
        for (uint64_t v = r->first[z]; v < r->first[z + 1]; v++)
            TRY(ffd_volume_group_add(r->d, group, (uint32_t)v, r->error));
    }
    return FFD_OK;
}

static ffd_status read_sections(su2_reader *r)
{
    text_scan scan;
    ffd_text_begin(&scan, r->d->file.input.data, r->d->file.input.size, false);
    TRY(ffd_su2_find(&scan, r->d->file.name, &r->sections, r->error));
    r->d->dimensions = (size_t)r->sections.dimensions;
    r->d->encoding = "ascii";
    if (r->sections.has_ffd_boxes)
        r->d->kept = "the FFD boxes of the file stay as they are";
    TRY(count_points(r));
    TRY(read_points(r));
    for (size_t i = 0; i < r->sections.count; i++) {
        const su2_section *const s = &r->sections.list[i];
        if (s->kind == SU2_ELEMENTS)
            TRY(read_elements(r, s));
        else if (s->kind == SU2_MARKER)
            TRY(read_marker(r, s));
    }
    return add_zones(r);
}

static ffd_status open_su2(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    su2_reader r = {.d = ffd_volume_make(sizeof(volume_document), input, source, error), .error = error};
    if (!r.d)
        return FFD_E_MEMORY;
    ffd_status status;
    TRY_END(read_sections(&r));
    *document = ffd_volume_ready(r.d, true, source);
end:
    ffd_free(r.sections.list);
    ffd_free(r.first);
    if (status)
        ffd_volume_free(r.d);
    return status;
}

const mesh_format ffd_su2_format = {
    .format = FFD_FORMAT_SU2,
    .name = "SU2",
    .open = open_su2,
    .close = ffd_volume_close,
    .save = ffd_volume_save,
    .selectors = &ffd_volume_selectors,
    VOLUME_CALLS,
};
