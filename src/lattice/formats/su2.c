/* su2.c - the FFD boxes of an SU2 mesh: lines KEY= VALUE, the corners as a hexahedron of VTK, and the control
   points by index. */
#include "base/memory/memory.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The most boxes that are named in a message. */
#define NAMED 8

typedef enum su2_blending { SU2_BEZIER, SU2_UNIFORM } su2_blending;

typedef struct su2_box {
    char tag[100];
    bool has_degree[3], has_order[3];
    uint64_t degree[3], order[3]; /* the control points less one; of the B-splines */
    su2_blending blending;
    uint64_t corners;
    double corner[8][3];
    bool has_points;
    text_scan points; /* where the control points begin */
    uint64_t count;   /* of these */
    size_t line;
} su2_box;

typedef struct su2_reader {
    const char *name;
    text_scan scan;
    su2_box box;   /* the one that is read, */
    su2_box found; /* and the one that is meant */
    size_t boxes;
    char tags[NAMED * 24];
    ffd_error *error;
} su2_reader;

#define REFUSE(r, line, ...) ffd_fail_line((r)->error, FFD_E_INVALID, (r)->name, line, __VA_ARGS__)

/* Takes a line "KEY= VALUE". Returns false for any other. line: its value. */
static bool take_key(su2_reader *r, text_word *key, text_scan *value)
{
    text_scan line = r->scan;
    const char *last = line.at;
    while (last < line.last && *last != '\n' && *last != '\r')
        last++;
    line.last = last;
    r->scan.at = last;
    ffd_text_next_line(&r->scan);
    const char *const equals = memchr(line.at, '=', (size_t)(last - line.at));
    if (!equals)
        return false;
    *key = (text_word){line.at, equals};
    while (key->first < key->last && ffd_text_is_blank(*key->first))
        key->first++;
    while (key->last > key->first && ffd_text_is_blank(key->last[-1]))
        key->last--;
    *value = line;
    value->at = equals + 1;
    return true;
}

static ffd_status take_whole(su2_reader *r, text_scan *value, const char *what, uint64_t *number)
{
    text_word word;
    return ffd_text_word(value, &word) && ffd_text_whole(word, number)
               ? FFD_OK
               : REFUSE(r, value->line, "%s is not a whole number", what);
}

/* Takes the corners of a box, or in two dimensions of its middle plane. */
static ffd_status take_corners(su2_reader *r, text_scan *value)
{
    TRY(take_whole(r, value, "FFD_CORNER_POINTS", &r->box.corners));
    if (r->box.corners != 4 && r->box.corners != 8)
        return REFUSE(r, value->line, "there are %" PRIu64 " corners, not 8, or 4 in two dimensions",
                      r->box.corners);
    for (uint64_t c = 0; c < r->box.corners; c++) {
        double *const corner = r->box.corner[c];
        for (int d = 0; d < (r->box.corners == 4 ? 2 : 3); d++)
            TRY(ffd_next_number(&r->scan, r->name, &corner[d], r->error));
        ffd_text_next_line(&r->scan);
    }
    for (int c = 0; c < 4 && r->box.corners == 4; c++) {
        memcpy(r->box.corner[4 + c], r->box.corner[c], sizeof r->box.corner[c]);
        r->box.corner[c][2] = -0.5;
        r->box.corner[4 + c][2] = 0.5;
    }
    return FFD_OK;
}

static ffd_status take_blending(su2_reader *r, text_scan *value)
{
    text_word word;
    if (ffd_text_word(value, &word) && ffd_text_is_any_case(word, "bezier"))
        r->box.blending = SU2_BEZIER;
    else if (ffd_text_is_any_case(word, "bspline_uniform"))
        r->box.blending = SU2_UNIFORM;
    else
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, value->line,
                             "the blending \"%s\" is not BEZIER or BSPLINE_UNIFORM",
                             ffd_text_shown(word).text);
    return FFD_OK;
}

/* Returns the direction of a key that ends in I, J or K, or -1. */
static int direction_of(text_word key, const char *start)
{
    const size_t length = strlen(start);
    if ((size_t)(key.last - key.first) != length + 1 || memcmp(key.first, start, length) != 0)
        return -1;
    const char letter = key.first[length];
    return letter >= 'I' && letter <= 'K' ? letter - 'I' : -1;
}

static ffd_status take_value(su2_reader *r, text_word key, text_scan *value)
{
    const int degree = direction_of(key, "FFD_DEGREE_"), order = direction_of(key, "BSPLINE_ORDER_");
    if (degree >= 0) {
        r->box.has_degree[degree] = true;
        return take_whole(r, value, "a degree", &r->box.degree[degree]);
    }
    if (order >= 0) {
        r->box.has_order[order] = true;
        return take_whole(r, value, "an order", &r->box.order[order]);
    }
    if (ffd_text_is(key, "FFD_BLENDING"))
        return take_blending(r, value);
    if (ffd_text_is(key, "FFD_CORNER_POINTS"))
        return take_corners(r, value);
    if (ffd_text_is(key, "FFD_CONTROL_POINTS")) {
        TRY(take_whole(r, value, "FFD_CONTROL_POINTS", &r->box.count));
        r->box.points = r->scan;
        r->box.has_points = true;
    }
    return FFD_OK;
}

/* Ends a box: it is the one that is meant, or one of several. */
static void end_box(su2_reader *r, const char *wanted)
{
    const size_t used = strlen(r->tags);
    if (!r->box.line)
        return;
    if (r->boxes == 0 || (wanted && strcmp(r->box.tag, wanted) == 0))
        r->found = r->box;
    if (r->boxes++ < NAMED)
        snprintf(r->tags + used, sizeof r->tags - used, "%s%.20s", used ? ", " : "", r->box.tag);
}

static ffd_status begin_box(su2_reader *r, text_scan *value)
{
    text_word word;
    if (!ffd_text_word(value, &word))
        return REFUSE(r, value->line, "FFD_TAG has no name");
    r->box = (su2_box){.line = value->line};
    snprintf(r->box.tag, sizeof r->box.tag, "%.*s",
             (int)(word.last - word.first < 99 ? word.last - word.first : 99), word.first);
    return FFD_OK;
}

/* Finds the box that is meant. Everything before the first one is the mesh. */
static ffd_status find_box(su2_reader *r, const char *wanted)
{
    text_word key;
    text_scan value;
    while (r->scan.at < r->scan.last) {
        if (!take_key(r, &key, &value))
            continue;
        if (ffd_text_is(key, "FFD_TAG")) {
            end_box(r, wanted);
            TRY(begin_box(r, &value));
        } else if (r->box.line)
            TRY(take_value(r, key, &value));
    }
    end_box(r, wanted);
    if (r->boxes == 0)
        return ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has no FFD box (FFD_TAG)");
    if (!wanted && r->boxes > 1)
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                             "has %zu FFD boxes, which are several lattices: choose one ({block}) of %s",
                             r->boxes, r->tags);
    if (wanted && strcmp(r->found.tag, wanted) != 0)
        return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name, "has no FFD box \"%.80s\" ({block}), but %s",
                             wanted, r->tags);
    return FFD_OK;
}

/* The degree of the splines of a direction. */
static ffd_status find_degree(su2_reader *r, int a, uint64_t *degree)
{
    const su2_box *const box = &r->found;
    *degree = box->blending == SU2_BEZIER ? box->degree[a] : box->has_order[a] ? box->order[a] - 1 : 0;
    if (box->blending == SU2_UNIFORM && (!box->has_order[a] || box->order[a] < 2))
        return REFUSE(r, box->line, "the box %s has no BSPLINE_ORDER_%c of at least 2", box->tag, "IJK"[a]);
    if (*degree > FFD_MAX_DEGREE)
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->name, box->line,
                             "the box %s has degree %" PRIu64 " along %c; degrees to %d are supported",
                             box->tag, *degree, "IJK"[a], FFD_MAX_DEGREE);
    if (*degree > box->degree[a])
        return REFUSE(r, box->line,
                      "the box %s has %" PRIu64 " control points along %c, too few for order %" PRIu64,
                      box->tag, box->degree[a] + 1, "IJK"[a], box -> order[a]);
    return FFD_OK;
}

/* Finds the size of the box, and its degrees. A plane is two layers that move alike. */
static ffd_status find_shape(su2_reader *r, size_t size[3], int degree[3])
{
    su2_box *const box = &r->found;
    if (box->corners == 4) {
        box->degree[2] = 1;
        box->has_degree[2] = box->has_order[2] = true;
        box->order[2] = 2;
    }
    for (int a = 0; a < 3; a++) {
        uint64_t found;
        if (!box->has_degree[a] || box->degree[a] < 1 || box->degree[a] >= FFD_MAX_CONTROL_POINTS)
            return REFUSE(r, box->line, "the box %s has no FFD_DEGREE_%c of at least 1", box->tag, "IJK"[a]);
        TRY(find_degree(r, a, &found));
        size[a] = (size_t)box->degree[a] + 1;
        degree[a] = (int)found;
    }
    return FFD_OK;
}

/* The control points that no box lists: even between the corners. */
static void fill_corners(const su2_box *box, lattice_spec *spec)
{
    static const int corner_of[8] = {0, 1, 3, 2, 4, 5, 7, 6}; /* by the bits of i, j, k */
    const size_t *const n = spec->size;
    for (size_t p = 0; p < spec->count; p++) {
        const double at[3] = {(double)(p % n[0]) / (double)(n[0] - 1),
                              (double)(p / n[0] % n[1]) / (double)(n[1] - 1),
                              (double)(p / (n[0] * n[1])) / (double)(n[2] - 1)};
        for (int c = 0; c < 8; c++)
            for (int d = 0; d < 3; d++)
                spec->points[3 * p + (size_t)d] += (c & 1 ? at[0] : 1 - at[0]) * (c & 2 ? at[1] : 1 - at[1]) *
                                                   (c & 4 ? at[2] : 1 - at[2]) * box->corner[corner_of[c]][d];
    }
}

/* Reads the control points by their indices. given: one byte for each, 0. */
static ffd_status read_points(su2_reader *r, lattice_spec *spec, uint8_t *given)
{
    const su2_box *const box = &r->found;
    text_scan scan = box->points;
    const bool is_flat = box->corners == 4;
    for (uint64_t p = 0; p < box->count; p++) {
        uint64_t index[3] = {0};
        text_word word;
        for (int a = 0; a < (is_flat ? 2 : 3); a++)
            if (!ffd_next_word(&scan, &word) || !ffd_text_whole(word, &index[a]) || index[a] >= spec->size[a])
                return REFUSE(r, scan.line, "\"%s\" is not an index below %zu", ffd_text_shown(word).text,
                              spec->size[a]);
        const size_t layer = spec->size[0] * spec->size[1];
        const size_t at = (size_t)(index[0] + spec->size[0] * index[1] + layer * index[2]);
        if (given[at]++)
            return REFUSE(r, scan.line, "%" PRIu64 ",%" PRIu64 ",%" PRIu64 " is there twice", index[0],
                          index[1], index[2]);
        for (int d = 0; d < (is_flat ? 2 : 3); d++)
            TRY(ffd_next_number(&scan, r->name, &spec->points[3 * at + (size_t)d], r->error));
        if (is_flat) {
            memcpy(spec->points + 3 * (at + layer), spec->points + 3 * at, 2 * sizeof *spec->points);
            spec->points[3 * at + 2] = -0.5;
            spec->points[3 * (at + layer) + 2] = 0.5;
        }
    }
    return FFD_OK;
}

static ffd_status fill(su2_reader *r, lattice_spec *spec)
{
    const su2_box *const box = &r->found;
    const size_t listed = spec->count / (box->corners == 4 ? 2 : 1);
    if (!box->has_points)
        return REFUSE(r, box->line, "the box %s has no FFD_CONTROL_POINTS", box->tag);
    if (box->count == 0 && box->corners == 0)
        return REFUSE(r, box->line, "the box %s has neither corners nor control points", box->tag);
    if (box->count == 0) {
        fill_corners(box, spec);
        return FFD_OK;
    }
    if (box->count != listed)
        return REFUSE(r, box->line, "the box %s has %" PRIu64 " control points, but its degrees need %zu",
                      box->tag, box->count, listed);
    uint8_t *const given = ffd_alloc_zero(spec->count, 1);
    if (!given)
        return ffd_fail_memory(r->error);
    const ffd_status status = read_points(r, spec, given);
    ffd_free(given);
    return status;
}

ffd_status ffd_lattice_read_su2(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    su2_reader r = {.name = name, .error = error};
    format_wish own = *wish;
    size_t size[3];
    *spec = NULL;
    ffd_text_begin(&r.scan, file->data, ffd_text_size(file->data, file->size), false);
    TRY(find_box(&r, wish->block));
    TRY(find_shape(&r, size, own.degree));
    TRY(ffd_format_begin(size, name, &own, spec, error));
    return fill(&r, *spec);
}
