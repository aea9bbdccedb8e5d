#include "io/foam/foam_format.h"
#include "base/memory/memory.h"
#include "io/foam/foam_mesh.h"
#include <string.h>

/* "(0 0 0)" */
#define LEAST_POINT 7
/* Memory for a point that has no bytes of its own in the file, also in what a job makes of it. */
#define POINT_MEMORY 160

/* Gives all points the place of the first one. */
static void spread(volume_document *d)
{
    for (size_t i = 3; i < 3 * d->file.part.vertex_count; i++)
        d->file.positions[i] = d->file.positions[i % 3];
}

static ffd_status take_points(foam_reader *r, foam_file *f)
{
    volume_document *const d = &r->d->volume;
    const size_t stride = 3 * ffd_type_size(f->scalar);
    uint64_t count;
    foam_list list;
    TRY(ffd_foam_check_class(f, "vectorField", NULL));
    d->encoding = f->is_binary ? "binary" : "ascii";
    TRY(ffd_foam_list(f, "points", f->is_binary ? stride : LEAST_POINT, VOLUME_VERTICES_MAX, &list, &count));
    r->d->is_uniform = list == FOAM_SAME;
    /* A few bytes may stand for any number of points. */
    if (r->d->is_uniform)
        TRY(ffd_budget_check(&d->file.base.budget, count, POINT_MEMORY, r->error));
    TRY(ffd_volume_make_points(d, count, foam_line(f), r->error));
    const number_run run = {.type = f->is_binary && !r->d->is_uniform ? f->scalar : NUMBER_DOUBLE,
                            .is_text = !f->is_binary || r->d->is_uniform,
                            .count = r->d->is_uniform ? 1 : (size_t)count,
                            .width = 3,
                            .stride = stride,
                            .is_bracketed = true,
                            .first = f->scan.at,
                            .last = f->scan.last,
                            .line = foam_line(f)};
    TRY(ffd_volume_add_piece(d, MESH_POSITIONS, 0, &run, &f->scan.at, &f->scan.line, r->error));
    if (r->d->is_uniform)
        spread(d);
    return ffd_foam_list_end(f, "points", list);
}

static ffd_status read_sides(foam_reader *r)
{
    const bool *const is_there = r->d->is_there;
    r->faces.inner = SIZE_MAX; /* is not known */
    TRY(ffd_foam_read_side(r, FOAM_FACES, ffd_foam_take_faces));
    if (is_there[FOAM_FACES])
        TRY(ffd_foam_read_side(r, FOAM_OWNER, ffd_foam_take_owner));
    if (is_there[FOAM_FACES])
        TRY(ffd_foam_read_side(r, FOAM_NEIGHBOUR, ffd_foam_take_neighbour));
    TRY(ffd_foam_make_cells(r));
    TRY(ffd_foam_note_missing(r));
    if (is_there[FOAM_FACES])
        TRY(ffd_foam_read_side(r, FOAM_BOUNDARY, ffd_foam_take_patches));
    if (!is_there[FOAM_FACES])
        r->d->volume.lacks_groups = "the file faces, without which no patches are known, is not beside it";
    else if (!is_there[FOAM_BOUNDARY])
        r->d->volume.lacks_groups = "the file boundary, which names patches, is not beside it";
    TRY(ffd_foam_read_side(r, FOAM_POINT_ZONES, ffd_foam_take_point_zones));
    if (is_there[FOAM_FACES])
        TRY(ffd_foam_read_side(r, FOAM_FACE_ZONES, ffd_foam_take_face_zones));
    return r->d->volume.lacks_cells ? FFD_OK
                                    : ffd_foam_read_side(r, FOAM_CELL_ZONES, ffd_foam_take_cell_zones);
}

static ffd_status read_all(foam_reader *r, const file_input *input)
{
    foam_file file = {.name = r->d->volume.file.name, .error = r->error};
    TRY(ffd_foam_begin(&file, input->data, input->size));
    TRY(take_points(r, &file));
    return read_sides(r);
}

/* The further files raise the limit of the document; their groups are in memory already. */
static void add_sides(volume_document *d, uint64_t most)
{
    d->file.base.budget.most = most;
    for (size_t g = 0; g < d->group_count; g++)
        d->file.base.budget.taken += (uint64_t)d->groups[g].capacity * sizeof *d->groups[g].vertices;
}

static ffd_status open_foam(file_input *input, const ffd_source *source, mesh_document **document,
                            ffd_error *error)
{
    foam_reader r = {.d = (foam_document *)ffd_volume_make(sizeof(foam_document), input, source, error),
                     .error = error};
    if (!r.d)
        return FFD_E_MEMORY;
    const ffd_status status = read_all(&r, input);
    if (status)
        ffd_volume_free(&r.d->volume);
    else {
        const uint64_t most = r.d->volume.file.base.budget.most;
        *document = ffd_volume_ready(&r.d->volume, strcmp(r.d->volume.encoding, "ascii") == 0, source);
        add_sides(&r.d->volume, most);
    }
    ffd_free(r.faces.corners.values);
    ffd_free(r.faces.ends);
    ffd_free(r.owner.values);
    ffd_free(r.neighbour.values);
    ffd_free(r.stamps);
    return status;
}

/* Whether all points are still one. */
static bool is_one_place(const file_document *file)
{
    const size_t size = 3 * sizeof *file->new_positions;
    for (size_t v = 1; v < file->part.vertex_count; v++)
        if (memcmp(file->new_positions + 3 * v, file->new_positions, size) != 0)
            return false;
    return true;
}

static ffd_status save(mesh_document *document, const mesh_save_options *options, file_output *output,
                       const mesh_log *log, ffd_error *error)
{
    const foam_document *const d = (const foam_document *)document;
    const file_document *const file = &d->volume.file;
    if (d->is_uniform && file->new_positions && !is_one_place(file))
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, file->name,
                             "has one place for all points, and only some of them move: this is not "
                             "supported");
    return ffd_volume_save(document, options, output, log, error);
}

static const mesh_resource_calls resources = {.find_named = ffd_foam_find_named};
static const mesh_sidecar_calls sidecars = {.list = ffd_foam_list_files, .list_images = ffd_foam_list_images};

const mesh_format ffd_foam_format = {
    .format = FFD_FORMAT_FOAM,
    .name = "OpenFOAM",
    .open = open_foam,
    .close = ffd_volume_close,
    .save = save,
    .selectors = &ffd_volume_selectors,
    .resources = &resources,
    .sidecars = &sidecars,
    VOLUME_CALLS,
};
