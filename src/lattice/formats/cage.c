/* cage.c - a lattice as two cages of lines, which modellers show: an OBJ of the objects "rest" and
   "deformed". Any OBJ is read as points in the order of its v lines. */
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/written_text.h"
#include <stdio.h>
#include <string.h>

/* The first line of a file that tells the size, as the program writes it. */
#define HINT "ffd-lattice"

typedef struct cage_reader {
    text_scan scan;
    const char *name;
    double *points; /* count points */
    size_t count, capacity;
    ffd_error *error;
} cage_reader;

/* "# ffd-lattice size 4 4 4" */
static bool take_hint(text_scan scan, size_t size[3])
{
    static const char *const words[] = {"#", HINT, "size"};
    text_word word;
    uint64_t number;
    for (size_t w = 0; w < sizeof words / sizeof *words; w++)
        if (!ffd_text_word(&scan, &word) || !ffd_text_is(word, words[w]))
            return false;
    for (int a = 0; a < 3; a++) {
        if (!ffd_text_word(&scan, &word) || !ffd_text_whole(word, &number) || number > FFD_MAX_CONTROL_POINTS)
            return false;
        size[a] = (size_t)number;
    }
    return true;
}

static ffd_status take_point(cage_reader *r)
{
    text_word word;
    if (!ffd_grow((void **)&r->points, &r->capacity, 3 * r->count + 3, sizeof *r->points))
        return ffd_fail_memory(r->error);
    for (size_t c = 0; c < 3; c++)
        if (!ffd_text_word(&r->scan, &word) || !ffd_text_number(word, &r->points[3 * r->count + c]) ||
            !isfinite(r->points[3 * r->count + c]))
            return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan.line,
                                 "v is not followed by three finite numbers");
    if (++r->count > 2 * FFD_MAX_CONTROL_POINTS)
        return ffd_fail_file(r->error, FFD_E_LIMIT, r->name, "has more than %zu control points",
                             FFD_MAX_CONTROL_POINTS);
    return FFD_OK;
}

static ffd_status read_points(cage_reader *r)
{
    text_word word;
    do {
        if (ffd_text_word(&r->scan, &word) && ffd_text_is(word, "v"))
            TRY(take_point(r));
    } while (ffd_text_next_line(&r->scan));
    return r->count ? FFD_OK : ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has no points (v)");
}

/* Finds the size, and whether the points are those of both states. */
static ffd_status find_size(const cage_reader *r, const format_wish *wish, bool has_hint, size_t size[3],
                            bool *has_both)
{
    uint64_t count = 1;
    if (wish->size[0] && has_hint && !wish->size_is_known)
        return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name,
                             "tells its size itself: {size} is not for it");
    if (!has_hint && !wish->size[0])
        return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name,
                             "has %zu points in a row: give the control points along u, v and w ({size})",
                             r->count);
    for (int a = 0; a < 3; a++) {
        size[a] = has_hint ? size[a] : wish->size[a];
        count = size[a] && count <= r->count ? count * size[a] : UINT64_MAX;
    }
    *has_both = r->count == 2 * count;
    if (count != r->count && !*has_both)
        return ffd_fail_file(
            r->error, FFD_E_INVALID, r->name,
            "has %zu points, but a lattice of %zu x %zu x %zu has as many, or twice as many for both "
            "states",
            r->count, size[0], size[1], size[2]);
    return FFD_OK;
}

/* The deformed points of the second object become offsets. */
static ffd_status take_deformed(const cage_reader *r, lattice_spec *spec)
{
    spec->deformed_offsets = ffd_alloc(spec->count, 3 * sizeof *spec->deformed_offsets);
    if (!spec->deformed_offsets)
        return ffd_fail_memory(r->error);
    for (size_t i = 0; i < 3 * spec->count; i++)
        spec->deformed_offsets[i] = r->points[3 * spec->count + i] - r->points[i];
    return FFD_OK;
}

static ffd_status make(cage_reader *r, const format_wish *wish, bool has_hint, size_t size[3],
                       lattice_spec **spec)
{
    bool has_both;
    TRY(find_size(r, wish, has_hint, size, &has_both));
    TRY(ffd_format_check_size(size, r->name, wish, r->error));
    if (wish->finds_order || (wish->finds_cage_order && !has_hint))
        TRY(ffd_points_order(&r->points, has_both ? 2 : 1, size, true, r->name, wish, r->error));
    TRY(ffd_format_begin(size, r->name, wish, spec, r->error));
    memcpy((*spec)->points, r->points, 3 * (*spec)->count * sizeof *r->points);
    return has_both ? take_deformed(r, *spec) : FFD_OK;
}

ffd_status ffd_lattice_read_cage(const file_input *file, const char *name, const format_wish *wish,
                                 lattice_spec **spec, ffd_error *error)
{
    cage_reader r = {.name = name, .error = error};
    size_t size[3] = {0};
    *spec = NULL;
    ffd_text_begin(&r.scan, file->data, ffd_text_size(file->data, file->size), false);
    const bool has_hint = take_hint(r.scan, size);
    ffd_status status = read_points(&r);
    if (!status)
        status = make(&r, wish, has_hint, size, spec);
    ffd_free(r.points);
    return status;
}

/* Appends the chain of lines along a direction through a control point of its first layer. first: the number
   of the object's first point. */
static void append_chain(const ffd_lattice *lattice, int d, size_t from, size_t first, byte_buffer *text)
{
    const size_t *const n = lattice->size;
    const size_t stride = d == 0 ? 1 : d == 1 ? n[0] : n[0] * n[1];
    ffd_buffer_text(text, "l");
    for (size_t i = 0; i < n[d]; i++)
        ffd_buffer_format(text, " %zu", first + from + i * stride);
    if (ffd_knots_closed(&lattice->knots[d]))
        ffd_buffer_format(text, " %zu", first + from);
    ffd_buffer_text(text, "\n");
}

static ffd_status write_object(const ffd_lattice *lattice, const char *name, const double *points,
                               size_t first, byte_buffer *text, file_output *output, ffd_error *error)
{
    const size_t *const n = lattice->size;
    ffd_buffer_format(text, "o %s\n", name);
    for (size_t i = 0; i < lattice->count; i++) {
        ffd_buffer_text(text, "v");
        for (size_t c = 0; c < 3; c++) {
            ffd_buffer_text(text, " ");
            ffd_buffer_number(text, points[3 * i + c]);
        }
        ffd_buffer_text(text, "\n");
        TRY(ffd_text_written(text, false, output, error));
    }
    for (int d = 0; d < 3; d++)
        for (size_t i = 0; i < lattice->count; i++) {
            const size_t at[3] = {i % n[0], i / n[0] % n[1], i / (n[0] * n[1])};
            if (at[d] > 0)
                continue;
            append_chain(lattice, d, i, first, text);
            TRY(ffd_text_written(text, false, output, error));
        }
    return FFD_OK;
}

ffd_status ffd_lattice_write_cage(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    byte_buffer text = {0};
    ffd_status status;
    ffd_buffer_format(&text, "# " HINT " size %zu %zu %zu\n", lattice->size[0], lattice->size[1],
                      lattice->size[2]);
    TRY_END(write_object(lattice, "rest", lattice->rest, 1, &text, output, error));
    if (!ffd_lattice_is_still(lattice))
        TRY_END(
            write_object(lattice, "deformed", lattice->deformed, 1 + lattice->count, &text, output, error));
    TRY_END(ffd_text_written(&text, true, output, error));
end:
    ffd_buffer_free(&text);
    return status;
}
