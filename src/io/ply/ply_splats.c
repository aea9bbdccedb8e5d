/* ply_splats.c - the Gaussian splats of a PLY file, as 3D Gaussian splatting programs write them: rot_0 to
   rot_3 are a quaternion w, x, y, z, scale_0 to scale_2 natural logarithms of scales, f_rest_0 and so on the
   spherical harmonics of degrees 1 to 3, all coefficients of red first. */
#include "base/inline.h"
#include "base/memory/memory.h"
#include "io/ply/ply_document.h"
#include <float.h>
#include <stdio.h>
#include <string.h>

#define SPLAT_NAME 24

/* Writes the property name of a slot: "rot_2" for PLY_ROTATION_SLOT + 2. */
static void name_slot(size_t slot, char name[SPLAT_NAME])
{
    if (slot >= PLY_REST_SLOT)
        snprintf(name, SPLAT_NAME, "f_rest_%zu", slot - PLY_REST_SLOT);
    else if (slot >= PLY_SCALE_SLOT)
        snprintf(name, SPLAT_NAME, "scale_%zu", slot - PLY_SCALE_SLOT);
    else
        snprintf(name, SPLAT_NAME, "rot_%zu", slot - PLY_ROTATION_SLOT);
}

static const ply_property *find(const ply_document *d, size_t slot)
{
    char name[SPLAT_NAME];
    name_slot(slot, name);
    return ffd_ply_find_property(d->vertex, name);
}

/* Whether all slots of [first, last) are present as float or double. */
static bool have_fractions(const ply_document *d, size_t first, size_t last)
{
    for (size_t slot = first; slot < last; slot++) {
        const ply_property *const property = find(d, slot);
        if (!property || property->is_list || !number_is_real(property->type))
            return false;
    }
    return true;
}

static bool are_there(const ply_document *d, size_t first, size_t last)
{
    for (size_t slot = first; slot < last; slot++)
        if (!find(d, slot))
            return false;
    return true;
}

static void fill_slots(ply_document *d, size_t first, size_t last)
{
    for (size_t slot = first; slot < last; slot++) {
        ply_property *const property = &d->header.properties[find(d, slot) - d->header.properties];
        property->slot = (unsigned char)slot;
        d->types[slot] = property->type;
    }
}

/* Returns the number of properties whose names begin with "f_rest_". */
static size_t count_rests(const ply_document *d)
{
    static const char start[] = "f_rest_";
    size_t count = 0;
    for (size_t i = 0; i < d->vertex->property_count; i++) {
        const text_word name = d->vertex->properties[i].name;
        count += (size_t)(name.last - name.first) >= sizeof start - 1 &&
                 memcmp(name.first, start, sizeof start - 1) == 0;
    }
    return count;
}

/* Returns the degree of the harmonics; 0: none, or not valid. */
static int find_degree(const ply_document *d)
{
    for (int degree = 1; degree <= HARMONICS_DEGREES; degree++) {
        const size_t count = HARMONICS_CHANNELS * (size_t)harmonics_count(degree);
        if (d->rest_count == count && have_fractions(d, PLY_REST_SLOT, PLY_REST_SLOT + count))
            return degree;
    }
    return 0;
}

void ffd_ply_find_splats(ply_document *d)
{
    mesh_part *const part = &d->file.part;
    const bool is_flat = !find(d, PLY_SCALE_SLOT + 2);
    const size_t scales = is_flat ? PLY_REST_SLOT - 1 : PLY_REST_SLOT;
    part->place = MESH_NO_PLACE;
    /* Two scales are enough: a disk has no third one. */
    part->splats = are_there(d, PLY_ROTATION_SLOT, PLY_SCALE_SLOT + 2);
    part->has_ellipsoids = part->splats && have_fractions(d, PLY_ROTATION_SLOT, scales);
    d->rest_count = count_rests(d);
    if (!part->has_ellipsoids)
        return;
    part->form = (splat_form){.is_logarithmic = true, .is_flat = is_flat, .degree = find_degree(d)};
    fill_slots(d, PLY_ROTATION_SLOT, scales);
    fill_slots(d, PLY_REST_SLOT,
               PLY_REST_SLOT + HARMONICS_CHANNELS * (size_t)harmonics_count(part->form.degree));
}

/* Returns the first slot of [first, last) whose property is missing. */
static size_t find_missing(const ply_document *d, size_t first, size_t last)
{
    while (first < last && find(d, first))
        first++;
    return first;
}

/* Returns the first slot whose property is present. */
static size_t find_present(const ply_document *d, size_t first, size_t last)
{
    while (first < last && !find(d, first))
        first++;
    return first;
}

/* Warns if some properties of splats are present, but not all. */
static void warn_of_part(const ply_document *d, const mesh_log *log)
{
    char there[SPLAT_NAME], missing[SPLAT_NAME];
    const size_t rotation = find_present(d, PLY_ROTATION_SLOT, PLY_SCALE_SLOT);
    const size_t scale = find_present(d, PLY_SCALE_SLOT, PLY_REST_SLOT);
    const bool turns = rotation < PLY_SCALE_SLOT, has_size = scale < PLY_REST_SLOT;
    const bool shines =
        ffd_ply_find_property(d->vertex, "f_dc_0") || ffd_ply_find_property(d->vertex, "opacity");
    if (turns + has_size + shines < 2 || !(turns || has_size))
        return; /* alone, they may be anything */
    name_slot(turns ? rotation : scale, there);
    name_slot(find_missing(d, PLY_ROTATION_SLOT, PLY_SCALE_SLOT + 2), missing);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "element vertex has %s but no %s: its vertices are points, not Gaussian splats, and their "
                 "rotations and scales stay",
                 there, missing);
}

ffd_status ffd_ply_warn(const mesh_document *document, const mesh_log *log, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    (void)error;
    if (!d->file.part.splats)
        warn_of_part(d, log);
    else if (d->rest_count > 0 && d->file.part.has_ellipsoids && d->file.part.form.degree == 0)
        ffd_log_line(
            log, FFD_LOG_WARNING,
            "element vertex has %zu properties f_rest, not 9, 24 or 45 that are float or double: the "
            "spherical harmonics of its Gaussian splats are not turned",
            d->rest_count);
    if (d->file.part.splats && ffd_ply_find_property(d->vertex, "filter_3D"))
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the property filter_3D of its Gaussian splats, a size, stays as it is");
    return FFD_OK;
}

double *ffd_ply_splat_number(splat_ellipsoid *splat, size_t slot)
{
    return slot < PLY_SCALE_SLOT ? &splat->rotation[slot - PLY_ROTATION_SLOT]
                                 : &splat->scale[slot - PLY_SCALE_SLOT];
}

/* Whether floats hold all rotations and scales. A disk's third scale, which is always 0, does not count. */
static bool are_floats(const ply_document *d)
{
    const size_t last = d->file.part.form.is_flat ? PLY_REST_SLOT - 1 : PLY_REST_SLOT;
    bool all = true;
    for (size_t slot = PLY_ROTATION_SLOT; slot < last; slot++)
        all = all && d->types[slot] == NUMBER_FLOAT;
    return all;
}

/* Allocates the results of each vertex, as small as possible: touching memory for the first time costs more
   than computing its content. */
static ffd_status make_results(ply_document *d, ffd_error *error)
{
    const size_t count = d->file.part.vertex_count;
    const bool floats = are_floats(d), turns = d->file.part.form.degree > 0;
    const size_t numbers = PLY_ELLIPSOID * (floats ? sizeof *d->float_splats : sizeof *d->double_splats);
    const size_t size = numbers + (turns ? sizeof *d->new_turns : 0) + sizeof *d->splat_marks;
    TRY(ffd_budget_take(&d->file.base.budget, count, size, error));
    if (floats)
        d->float_splats = ffd_alloc_whole(count, numbers);
    else
        d->double_splats = ffd_alloc_whole(count, numbers);
    if (turns)
        d->new_turns = ffd_alloc_whole(count, sizeof *d->new_turns);
    d->splat_marks = ffd_alloc(count, sizeof *d->splat_marks);
    const bool is_there = (d->float_splats || d->double_splats) && (d->new_turns || !turns) && d->splat_marks;
    return is_there ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_ply_begin_splats(ply_document *d, const mesh_results *results, ffd_error *error)
{
    if (!d->file.part.has_ellipsoids || results->converted)
        return FFD_OK;
    TRY(d->splat_marks ? FFD_OK : make_results(d, error));
    memset(d->splat_marks, 0, d->file.part.vertex_count);
    return FFD_OK;
}

static void read_fixed(const ply_document *d, size_t vertex, splat_ellipsoid *splat)
{
    const size_t last = d->file.part.form.is_flat ? PLY_REST_SLOT - 1 : PLY_REST_SLOT;
    const char *const row = ply_row(d, vertex);
    splat->scale[2] = 0;
    for (size_t slot = PLY_ROTATION_SLOT; slot < last; slot++)
        *ffd_ply_splat_number(splat, slot) =
            ply_load_binary(d->header.encoding, d->types[slot], row + d->offsets[slot]);
}

void ffd_ply_read_splats(const mesh_document *document, size_t part, size_t first, size_t count,
                         splat_ellipsoid *splats)
{
    const ply_document *const d = ffd_ply_of(document);
    (void)part; /* the only one */
    for (size_t i = 0; i < count; i++)
        if (d->has_fixed_rows)
            read_fixed(d, first + i, &splats[i]);
        else
            splats[i] = d->splats[first + i];
}

static void keep_result(const ply_document *d, size_t vertex, const splat_ellipsoid *splat,
                        const splat_turn *turn)
{
    const double numbers[PLY_ELLIPSOID] = {splat->rotation[0], splat->rotation[1], splat->rotation[2],
                                           splat->rotation[3], splat->scale[0],    splat->scale[1],
                                           splat->scale[2]};
    for (size_t i = 0; i < PLY_ELLIPSOID; i++)
        if (d->float_splats)
            d->float_splats[PLY_ELLIPSOID * vertex + i] = (float)numbers[i];
        else
            d->double_splats[PLY_ELLIPSOID * vertex + i] =
                number_round(d->types[PLY_ROTATION_SLOT + i], numbers[i]);
    if (d->new_turns)
        memcpy(d->new_turns[vertex], turn->quaternion, sizeof *d->new_turns);
}

void ffd_ply_write_splats(mesh_document *document, size_t part, size_t first, size_t count,
                          const splat_ellipsoid *splats, const splat_turn *turns, const uint8_t *changed)
{
    const ply_document *d = ffd_ply_of(document);
    (void)part;
    for (size_t i = 0; d->splat_marks && i < count; i++) {
        if (!changed[i])
            continue;
        keep_result(d, first + i, &splats[i], &turns[i]);
        const bool is_turn = d->new_turns && turns[i].is_turn;
        d->splat_marks[first + i] = (uint8_t)(PLY_SPLAT_CHANGES | (is_turn ? PLY_SPLAT_TURNS : 0) |
                                              (turns[i].is_mirrored ? PLY_SPLAT_MIRRORS : 0));
    }
}

splat_turn ffd_ply_turn_of(const ply_document *d, size_t vertex)
{
    splat_turn turn = {.is_turn = true, .is_mirrored = d->splat_marks[vertex] & PLY_SPLAT_MIRRORS};
    memcpy(turn.quaternion, d->new_turns[vertex], sizeof turn.quaternion);
    return turn;
}

/* Whether no magnitude exceeds `most`, and none is NaN. The bits of magnitudes are in the order of the
   numbers, with NaN last. The compiler vectorizes these differences, but not comparisons of doubles. */
static ALWAYS_INLINE bool are_within(const double *c, int count, double most)
{
    uint64_t limit, excess = 0;
    memcpy(&limit, &most, sizeof limit);
    for (int m = 0; m < count; m++) {
        uint64_t bits;
        memcpy(&bits, c + m, sizeof bits);
        excess |= limit - (bits & INT64_MAX);
    }
    return !(excess >> 63);
}

bool ffd_ply_rests_fit(const ply_document *d, const double c[HARMONICS_MOST], int channel)
{
    const number_type *const types = d->types + ply_rest_slot(d, channel, 0);
    const int count = harmonics_count(d->file.part.form.degree);
    bool all = true;
    if (d->has_plain_rests && count == HARMONICS_MOST)
        return are_within(c, HARMONICS_MOST, FLT_MAX);
    if (d->has_plain_rests)
        return are_within(c, count, FLT_MAX);
    for (int m = 0; m < count; m++)
        all &= fabs(c[m]) <= (types[m] == NUMBER_FLOAT ? FLT_MAX : DBL_MAX);
    return all;
}
