#include "view/page_edit.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <string.h>

static const edit_points *points_of(const page_edit *edit)
{
    return &edit->mesh->scene->edit->points;
}

ffd_status ffd_page_edit_make(const page_mesh *mesh, page_edit *edit, ffd_error *error)
{
    *edit = (page_edit){.mesh = mesh};
    if (!mesh->scene->edit)
        return FFD_OK;
    const edit_points *const points = points_of(edit);
    edit->points = ffd_alloc(mesh->vertex_count + points->count - points->vertices, sizeof *edit->points);
    if (!edit->points)
        return ffd_fail_memory(error);
    memcpy(edit->points, mesh->vertices, mesh->vertex_count * sizeof *edit->points);
    edit->count = mesh->vertex_count;
    for (size_t p = points->vertices; p < points->count; p++)
        if (mesh->places[points->owners[p - points->vertices]] != VIEW_NONE)
            edit->points[edit->count++] = (uint32_t)p;
    return FFD_OK;
}

void ffd_page_edit_free(page_edit *edit)
{
    ffd_free(edit->points);
    edit->points = NULL;
}

/* Numbers of points, `each` for one, of the points that a list names; or of all in their order. */
typedef struct number_block {
    const double *numbers;
    size_t each;
    const uint32_t *points;
} number_block;

static void fill_numbers(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const number_block *const block = of;
    for (size_t i = first; i < first + count; i++) {
        const double *const from = block->numbers + block->each * (block->points ? block->points[i] : i);
        for (size_t k = 0; k < block->each; k++, bytes += 8)
            store_double(bytes, from[k]);
    }
}

/* Writes nothing without numbers. */
static void write_numbers(page_writer *w, const char *id, size_t count, const double *numbers, size_t each,
                          const uint32_t *points)
{
    const number_block block = {numbers, each, points};
    if (numbers)
        ffd_page_write_block(w, id, count, 8 * each, fill_numbers, &block);
}

static void fill_kinds(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_edit *const edit = of;
    for (size_t i = 0; i < count; i++)
        bytes[i] = points_of(edit)->kinds[edit->points[first + i]];
}

static void fill_owners(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_edit *const edit = of;
    const edit_points *const points = points_of(edit);
    const uint32_t *const further = edit->points + edit->mesh->vertex_count + first;
    for (size_t i = 0; i < count; i++)
        store_u32(bytes + 4 * i, edit->mesh->places[points->owners[further[i] - points->vertices]]);
}

/* One flag a triangle: it is of the same polygon as the one before it. */
static void fill_faces(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    memcpy(bytes, ((const page_edit *)of)->mesh->continues + first, count);
}

static void write_points(const page_edit *edit, page_writer *w)
{
    const page_mesh *const mesh = edit->mesh;
    const edit_points *const points = points_of(edit);
    const size_t further = edit->count - mesh->vertex_count;
    write_numbers(w, "data-edit-start", edit->count, points->start, 3, edit->points);
    write_numbers(w, "data-edit-uvw", edit->count, points->uvw, 3, edit->points);
    write_numbers(w, "data-edit-rest", mesh->vertex_count, mesh->scene->before, 3, mesh->vertices);
    write_numbers(w, "data-edit-gradient", mesh->vertex_count, points->gradients, 9, mesh->vertices);
    write_numbers(w, "data-edit-way", edit->count, points->ways, EDIT_WAY, edit->points);
    ffd_page_write_block(w, "data-edit-kind", edit->count, 1, fill_kinds, edit);
    if (further) {
        write_numbers(w, "data-edit-factor", edit->count, points->factors, 1, edit->points);
        ffd_page_write_block(w, "data-edit-owner", further, 4, fill_owners, edit);
    }
}

static void write_lattice(const view_scene *scene, page_writer *w)
{
    static const char *const knots[] = {"data-edit-knot-0", "data-edit-knot-1", "data-edit-knot-2"};
    const view_edit *const edit = scene->edit;
    const size_t *const size = scene->cages[edit->cage].size;
    const size_t count = size[0] * size[1] * size[2];
    write_numbers(w, "data-edit-offset", count, edit->offsets, 3, NULL);
    write_numbers(w, "data-edit-weight", count, edit->weights, 1, NULL);
    write_numbers(w, "data-edit-deformed-weight", count, edit->deformed_weights, 1, NULL);
    for (int a = 0; a < 3; a++)
        write_numbers(w, knots[a], edit->knot_count[a], edit->knots[a], 1, NULL);
}

void ffd_page_edit_write(const page_edit *edit, page_writer *w)
{
    if (!edit->points)
        return;
    write_lattice(edit->mesh->scene, w);
    write_points(edit, w);
    if (edit->mesh->continues)
        ffd_page_write_block(w, "data-edit-face", edit->mesh->triangle_count, 1, fill_faces, edit);
}

void ffd_page_edit_describe(const page_edit *edit, json_text *json)
{
    if (!edit->points)
        return;
    const view_edit *const of = edit->mesh->scene->edit;
    const double degree[3] = {of->degree[0], of->degree[1], of->degree[2]};
    ffd_json_object(json, "edit", true);
    ffd_json_count(json, "cage", of->cage);
    ffd_json_vector(json, "degree", degree, 3);
    ffd_json_string(json, "key", of->key);
    ffd_json_bool(json, "isNew", of->is_new);
    ffd_json_bool(json, "hasMoves", of->has_moves);
    ffd_json_bool(json, "extends", of->extends);
    ffd_json_string(json, "file", of->file);
    ffd_json_string(json, "name", of->name);
    ffd_json_string(json, "comment", of->comment);
    ffd_json_end(json, '}');
}
