#include "io/ply/ply_format.h"
#include "io/ply/ply_document.h"
#include "io/ply/ply_textures.h"
#include "io/ply/ply_weights.h"
#include <float.h>

static ffd_status check(const mesh_document *document, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    for (int a = 0; a < PLY_NORMAL_SLOT; a++)
        if (!number_is_real(d->types[a]))
            return ffd_fail_line(error, FFD_E_UNSUPPORTED, d->file.name, d->vertex->line,
                                 "%c of the vertices is of type %s: only float and double can be deformed",
                                 "xyz"[a], ffd_ply_type_name(d->types[a]));
    return ffd_ply_check_faces(d, error);
}

static const mesh_resource_calls resources = {.find_named = ffd_ply_find_named};
static const mesh_splat_calls splats = {.read = ffd_ply_read_splats, .write = ffd_ply_write_splats};

const mesh_format ffd_ply_format = {
    .format = FFD_FORMAT_PLY,
    .name = "PLY",
    .open = ffd_ply_open,
    .close = ffd_ply_close,
    .resources = &resources,
    .check = check,
    .warn = ffd_ply_warn,
    .mark_used = ffd_ply_mark_used,
    .largest_coordinate = DBL_MAX,
    .read = ffd_file_document_read,
    .splats = &splats,
    .weights = &ffd_ply_weights,
    .begin_results = ffd_ply_begin_results,
    .write = ffd_ply_write,
    .save = ffd_ply_save,
    .faces = ffd_ply_faces,
    .mixed_faces = ffd_ply_mixed_faces,
    .model = ffd_ply_model,
    .describe = ffd_ply_describe,
    .compare = ffd_ply_compare,
};
