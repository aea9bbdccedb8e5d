/* blender_npz.c - lattices of Blender as body refitters keep them: a ZIP of NumPy arrays whose magic is LATZ.
 */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "io/npy/npy.h"
#include "lattice/formats/blender.h"
#include "lattice/formats/grid_arrays.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/zip.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define VERSION 3
/* The room for a member that is not a list of points. */
#define SMALL 65536
/* A point may be so far from the even spacing of its direction, as a part of the range. */
#define UNEVEN 1e-6

typedef struct npz_reader {
    const file_input *file;
    const char *name;
    const format_wish *wish;
    zip_list list;
    blender_lattice lattice;
    double *rest, *deformed;
    ffd_error *error;
} npz_reader;

/* Finds an array of `count` elements. content: to be unloaded by the caller. */
static ffd_status open_member(const npz_reader *r, const char *what, uint64_t count, uint64_t most,
                              file_input *content, npy_view *view)
{
    char member[40];
    snprintf(member, sizeof member, "%s.npy", what);
    const zip_member *const found = ffd_zip_find(&r->list, member);
    *content = (file_input){0};
    if (!found)
        return ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has no array \"%s\"", what);
    TRY(ffd_zip_unpack(r->file, r->name, found, most, content, r->error));
    TRY(ffd_npy_view(content, r->name, view, r->error));
    return view->count == count
               ? FFD_OK
               : ffd_fail_file(r->error, FFD_E_INVALID, r->name,
                               "has an array \"%s\" of %" PRIu64 " elements, not of %" PRIu64, what,
                               view->count, count);
}

static ffd_status take_numbers(const npz_reader *r, const char *what, const npy_view *view, double *numbers)
{
    const bool is_float = view->kind == 'f';
    if ((!is_float && view->kind != 'i' && view->kind != 'u') || view->size > 8 ||
        (is_float && view->size < 4))
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                             "has an array \"%s\" of another type than numbers", what);
    for (uint64_t i = 0; i < view->count; i++) {
        numbers[i] = ffd_grid_number(view->values + i * view->size, view->size, is_float, view->kind != 'u',
                                     view->is_big_endian);
        if (!isfinite(numbers[i]))
            return ffd_fail_file(r->error, FFD_E_INVALID, r->name,
                                 "has a number in \"%s\" that is not finite", what);
    }
    return FFD_OK;
}

static ffd_status read_numbers(const npz_reader *r, const char *what, uint64_t count, double *numbers)
{
    const uint64_t most = 8 * count + SMALL;
    file_input content;
    npy_view view;
    ffd_status status = open_member(r, what, count, most, &content, &view);
    if (!status && view.is_fortran && view.dimensions > 1)
        status =
            ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name, "has an array \"%s\" in Fortran order", what);
    if (!status)
        status = take_numbers(r, what, &view, numbers);
    ffd_free(content.block);
    return status;
}

/* Reads texts; which: of several. */
static ffd_status read_text(const npz_reader *r, const char *what, uint64_t count, char texts[][32])
{
    file_input content;
    npy_view view;
    ffd_status status = open_member(r, what, count, SMALL, &content, &view);
    if (!status && view.kind != 'S')
        status = ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                               "has an array \"%s\" of another type than texts", what);
    for (uint64_t i = 0; !status && i < count; i++) {
        const size_t size = view.size < 31 ? view.size : 31;
        memcpy(texts[i], view.values + i * view.size, size);
        texts[i][size] = 0;
    }
    ffd_free(content.block);
    return status;
}

static ffd_status read_magic(npz_reader *r)
{
    char magic[1][32];
    double version;
    TRY(read_text(r, "magic", 1, magic));
    if (strcmp(magic[0], "LATZ") != 0)
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                             "has the magic \"%.8s\", not LATZ of a lattice", magic[0]);
    TRY(read_numbers(r, "version", 1, &version));
    return version == VERSION ? FFD_OK
                              : ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                                              "is of version %g, not %d", version, VERSION);
}

static ffd_status read_shape(npz_reader *r)
{
    static const char *const sizes[] = {"U", "V", "W"};
    char types[3][32];
    uint64_t count = 1;
    TRY(read_text(r, "interp", 3, types));
    for (int d = 0; d < 3; d++) {
        double size;
        const text_word word = {types[d], types[d] + strlen(types[d])};
        TRY(read_numbers(r, sizes[d], 1, &size));
        if (!(size >= 1) || size > (double)FFD_MAX_CONTROL_POINTS || size != floor_of(size))
            return ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has %g control points along %c", size,
                                 "uvw"[d]);
        if (!ffd_blender_type(word, &r->lattice.type[d]))
            return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name, "has the interpolation \"%s\"",
                                 types[d]);
        r->lattice.size[d] = (size_t)size;
        count *= r->lattice.size[d];
        if (count > FFD_MAX_CONTROL_POINTS)
            return ffd_fail_file(r->error, FFD_E_LIMIT, r->name, "has more than %zu control points",
                                 FFD_MAX_CONTROL_POINTS);
    }
    return FFD_OK;
}

static ffd_status read_matrix(npz_reader *r)
{
    double quaternion[4];
    TRY(read_numbers(r, "location", 3, r->lattice.location));
    TRY(read_numbers(r, "rotation_quat", 4, quaternion));
    TRY(read_numbers(r, "scale", 3, r->lattice.scale));
    return ffd_blender_turn(quaternion, r->lattice.rotation)
               ? FFD_OK
               : ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has a rotation of length 0");
}

/* Finds the first point and the step of each direction, from which no point may differ. */
static ffd_status find_steps(npz_reader *r)
{
    const size_t *const n = r->lattice.size;
    const size_t count = n[0] * n[1] * n[2];
    double range = 0;
    for (int d = 0; d < 3; d++) {
        r->lattice.first[d] = r->rest[d];
        const double whole = r->rest[3 * (count - 1) + (size_t)d] - r->rest[d];
        r->lattice.step[d] = n[d] > 1 ? whole / (double)(n[d] - 1) : 0;
        range = fabs(whole) > range ? fabs(whole) : range;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t at[3] = {i % n[0], i / n[0] % n[1], i / (n[0] * n[1])};
        for (size_t d = 0; d < 3; d++)
            if (fabs(r->lattice.first[d] + (double)at[d] * r->lattice.step[d] - r->rest[3 * i + d]) >
                UNEVEN * range)
                return ffd_fail_file(r->error, FFD_E_INVALID, r->name,
                                     "has a point %zu,%zu,%zu at rest that is not on an even grid", at[0],
                                     at[1], at[2]);
    }
    return FFD_OK;
}

static ffd_status read_points(npz_reader *r)
{
    const size_t *const n = r->lattice.size;
    const size_t count = 3 * n[0] * n[1] * n[2];
    const zip_member *const member = ffd_zip_find(&r->list, "points_rest.npy");
    if (member && member->size < 2 * (uint64_t)count) /* before memory is taken */
        return ffd_fail_file(r->error, FFD_E_INVALID, r->name, "has too few points for %zu x %zu x %zu", n[0],
                             n[1], n[2]);
    TRY(ffd_format_check_memory(n, r->name, r->wish, r->error));
    r->rest = ffd_alloc(count, sizeof *r->rest);
    r->deformed = ffd_alloc(count, sizeof *r->deformed);
    if (!r->rest || !r->deformed)
        return ffd_fail_memory(r->error);
    TRY(read_numbers(r, "points_rest", count, r->rest));
    TRY(read_numbers(r, "points_deform", count, r->deformed));
    TRY(find_steps(r));
    for (size_t i = 0; i < count; i++)
        r->deformed[i] -= r->rest[i];
    r->lattice.offsets = r->deformed;
    return FFD_OK;
}

ffd_status ffd_lattice_read_npz(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    npz_reader r = {.file = file, .name = name, .wish = wish, .error = error};
    ffd_status status;
    *spec = NULL;
    TRY_END(ffd_zip_list(file, name, &r.list, error));
    TRY_END(read_magic(&r));
    TRY_END(read_shape(&r));
    TRY_END(read_matrix(&r));
    TRY_END(read_points(&r));
    TRY_END(ffd_blender_make(&r.lattice, name, wish, spec, error));
end:
    ffd_free(r.rest);
    ffd_free(r.deformed);
    return status;
}
