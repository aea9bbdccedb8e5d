/* vtk_arrays.c - the arrays of points and cells in a VTK file of the legacy format. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/vtk/vtk_reader.h"
#include <inttypes.h>

/* Skips texts in binary. In front of each is its length in 1, 2, 4 or 8 bytes: 3 less the upper two bits is
   the power of two. */
static ffd_status skip_binary_texts(vtk_reader *r, uint64_t count)
{
    const char *at = ffd_vtk_binary(r);
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t left = (uint64_t)(r->scan.last - at);
        const size_t size = left ? (size_t)1 << (3 - ((unsigned char)*at >> 6)) : 1;
        uint64_t length = left ? (unsigned char)*at & 63 : 0;
        for (size_t b = 1; b < size && b < left; b++)
            length = length << 8 | (unsigned char)at[b];
        if (size > left || length > left - size)
            return VTK_REFUSE(r, "the file ends within an array of %" PRIu64 " texts", count);
        at += size + length;
    }
    r->scan.at = at;
    return FFD_OK;
}

static ffd_status skip_binary(vtk_reader *r, const vtk_type *type, uint64_t count)
{
    const char *const at = ffd_vtk_binary(r);
    const uint64_t left = (uint64_t)(r->scan.last - at), size = ffd_type_size(type->type);
    if (type->special == VTK_TEXTS)
        return skip_binary_texts(r, count);
    if (type->special == VTK_BITS ? left < (count + 7) / 8 : left / size < count)
        return VTK_REFUSE(r, "the file ends within an array of %" PRIu64 " numbers", count);
    r->scan.at = at + (type->special == VTK_BITS ? (count + 7) / 8 : count * size);
    return FFD_OK;
}

/* Skips numbers, bits, or texts, which are a line each. */
static ffd_status skip_text(vtk_reader *r, const vtk_type *type, uint64_t count)
{
    const bool is_text = type->special == VTK_TEXTS;
    text_word word;
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        if (!is_text)
            TRY(ffd_vtk_word(r, "a number of an array", &word));
        else if (!ffd_text_next_line(&r->scan))
            return VTK_REFUSE(r, "the file ends within an array of %" PRIu64 " texts", count);
    }
    if (is_text && count)
        ffd_text_next_line(&r->scan);
    return FFD_OK;
}

/* Takes the normals of the points. */
static ffd_status take_normals(vtk_reader *r, const number_run *run)
{
    const char *last;
    size_t line;
    r->d->file.directions = ffd_alloc(run->count, 3 * sizeof *r->d->file.directions);
    if (!r->d->file.directions)
        return ffd_fail_memory(r->error);
    r->has_normals = true;
    TRY(ffd_volume_add_piece(r->d, MESH_NORMALS, 0, run, &last, &line, r->error));
    r->scan.at = last;
    r->scan.line = line;
    return FFD_OK;
}

static ffd_status take_array(vtk_reader *r, text_word name, const vtk_type *type, uint64_t components,
                             uint64_t tuples, bool is_normals)
{
    const uint64_t most = UINT64_C(8) * r->d->file.input.size;
    if (components && tuples > most / components)
        return VTK_REFUSE(r, "the file ends within the array \"%s\"", ffd_text_shown(name).text);
    const number_run run = {.type = type->type,
                            .is_text = !r->is_binary,
                            .is_big = true,
                            .count = (size_t)tuples,
                            .width = (size_t)components,
                            .stride = (size_t)components * ffd_type_size(type->type),
                            .first = r->is_binary ? ffd_vtk_binary(r) : r->scan.at,
                            .last = r->scan.last,
                            .line = vtk_line(r)};
    const bool is_read = !type->special && components > 0 && components <= RUN_WIDTH_MAX &&
                         r->owner != VTK_OF_FILE && tuples == r->tuples;
    if (is_read)
        TRY(ffd_run_check(&run, r->d->file.name, "value", r->error));
    if (is_normals && is_read && r->owner == VTK_OF_POINTS && !r->has_normals && number_is_real(type->type))
        return take_normals(r, &run);
    if (is_read)
        TRY(ffd_volume_add_array(r->d, name, &run, r->owner == VTK_OF_CELLS, r->error));
    return r->is_binary ? skip_binary(r, type, components * tuples) : skip_text(r, type, components * tuples);
}

/* FIELD name count, then arrays: name components tuples type */
static ffd_status take_field(vtk_reader *r)
{
    const vtk_type *type;
    text_word name;
    uint64_t count, components, tuples;
    TRY(ffd_vtk_word(r, "the name of a field", &name));
    TRY(ffd_vtk_count(r, "the number of arrays", &count));
    for (uint64_t a = 0; a < count; a++) {
        TRY(ffd_vtk_word(r, "the name of an array", &name));
        while (ffd_text_is(name, "METADATA")) {
            ffd_vtk_metadata(r);
            TRY(ffd_vtk_word(r, "the name of an array", &name));
        }
        TRY(ffd_vtk_count(r, "the number of components", &components));
        TRY(ffd_vtk_count(r, "the number of tuples", &tuples));
        TRY(ffd_vtk_type(r, &type));
        TRY(take_array(r, name, type, components, tuples, false));
    }
    return FFD_OK;
}

/* SCALARS name type [components], then LOOKUP_TABLE name. */
static ffd_status take_scalars(vtk_reader *r)
{
    const vtk_type *type;
    text_word name, word;
    uint64_t components = 1;
    TRY(ffd_vtk_word(r, "the name of an array", &name));
    TRY(ffd_vtk_type(r, &type));
    if (ffd_text_word(&r->scan, &word) && !ffd_text_whole(word, &components))
        return VTK_REFUSE(r, "\"%s\" is not a number of components", ffd_text_shown(word).text);
    const text_scan before = r->scan;
    if (ffd_text_find(&r->scan) && ffd_text_word(&r->scan, &word) && ffd_text_is(word, "LOOKUP_TABLE"))
        TRY(ffd_vtk_word(r, "the name of a table", &word));
    else
        r->scan = before;
    return take_array(r, name, type, components, r->tuples, false);
}

/* TEXTURE_COORDINATES name dimension type; COLOR_SCALARS name components; LOOKUP_TABLE name size */
static ffd_status take_other(vtk_reader *r, text_word keyword)
{
    static const vtk_type byte = {"unsigned_char", NUMBER_UINT8, VTK_NUMBERS};
    const vtk_type *type = &byte;
    text_word name;
    uint64_t count;
    const bool is_table = ffd_text_is(keyword, "LOOKUP_TABLE");
    const bool is_texture = ffd_text_is(keyword, "TEXTURE_COORDINATES");
    if (!is_table && !is_texture && !ffd_text_is(keyword, "COLOR_SCALARS"))
        return VTK_REFUSE(r, "\"%s\" is not a keyword that may stand here", ffd_text_shown(keyword).text);
    TRY(ffd_vtk_word(r, "a name", &name));
    TRY(ffd_vtk_count(r, "a count", &count));
    if (is_texture)
        TRY(ffd_vtk_type(r, &type));
    /* Texts of colours are not those of bytes: they are only skipped. */
    const vtk_owner owner = r->owner;
    r->owner = is_texture ? owner : VTK_OF_FILE;
    const ffd_status status =
        take_array(r, name, type, is_table ? 4 : count, is_table ? count : r->tuples, false);
    r->owner = owner;
    return status;
}

ffd_status ffd_vtk_attribute(vtk_reader *r, text_word keyword)
{
    static const struct {
        const char *keyword;
        uint64_t components;
    } attributes[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                      {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
    const vtk_type *type;
    text_word name;
    if (ffd_text_is(keyword, "FIELD"))
        return take_field(r);
    if (ffd_text_is(keyword, "SCALARS"))
        return take_scalars(r);
    for (size_t a = 0; a < sizeof attributes / sizeof *attributes; a++)
        if (ffd_text_is(keyword, attributes[a].keyword)) {
            TRY(ffd_vtk_word(r, "the name of an array", &name));
            TRY(ffd_vtk_type(r, &type));
            return take_array(r, name, type, attributes[a].components, r->tuples,
                              ffd_text_is(keyword, "NORMALS"));
        }
    return take_other(r, keyword);
}
