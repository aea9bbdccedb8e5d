/* gltf_format.c - the table of functions for .gltf and .glb files. */
#include "io/gltf/gltf_format.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/gltf_skeleton.h"
#include "io/gltf/gltf_weights.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_instancing.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/model/gltf_splats.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_saver.h"
#include "mesh/resource/sidecar.h"
#include <float.h>

static ffd_status check(const mesh_document *document, ffd_error *error)
{
    return ffd_gltf_refuse_read(ffd_gltf_of(document), error);
}

static ffd_status warn(const mesh_document *document, const mesh_log *log, ffd_error *error)
{
    TRY(ffd_gltf_warn_of_held(ffd_gltf_of(document), log, error));
    return ffd_gltf_warn_of_faults(document, log, error);
}

static void read(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                 size_t first, size_t count, double *values)
{
    ffd_gltf_read_shown(ffd_gltf_of(document), part, (gltf_semantic)stream, state, first, count,
                        stream == MESH_TANGENTS ? 4 : 3, values);
}

static void read_offsets(const mesh_document *document, size_t part, size_t shape, mesh_stream stream,
                         size_t first, size_t count, double *xyz)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t target = d->base.part_count + d->parts[part].first_shape + shape;
    ffd_gltf_read(d, d->parts[target].streams[stream].accessor, first, count, 3, xyz);
}

static ffd_status begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    ffd_gltf_clear_edit((gltf_document *)document);
    TRY(ffd_gltf_begin_results(document, results, error));
    return ffd_gltf_begin_splats((gltf_document *)document, error);
}

/* mesh_format's follow. Nodes that follow also turn splats that are not selected; these are turned back, as
   vertices are moved back. */
static ffd_status follow(mesh_document *document, const mesh_places *places, mesh_place_move *moves,
                         const mesh_log *log, mesh_following *following, ffd_error *error)
{
    TRY(ffd_gltf_follow(document, places, moves, log, following, error));
    return ffd_gltf_begin_splats((gltf_document *)document, error);
}

static ffd_status save(mesh_document *document, const mesh_save_options *options, file_output *output,
                       const mesh_log *log, ffd_error *error)
{
    if (output)
        ffd_gltf_warn_of_splats(ffd_gltf_of(document), log);
    return ffd_gltf_save(document, options, output, log, error);
}

static const mesh_selector_calls selectors = {
    .kinds = SELECTOR_BIT(SELECT_NODE) | SELECTOR_BIT(SELECT_MESH) | SELECTOR_BIT(SELECT_MATERIAL),
    .mark_kinds = SELECTOR_BIT(SELECT_NODE) | SELECTOR_BIT(SELECT_MESH) | SELECTOR_BIT(SELECT_MATERIAL) |
                  SELECTOR_BIT(SELECT_JOINT),
    .select = ffd_gltf_select,
    .mark = ffd_gltf_mark,
    .list = ffd_gltf_list_parts,
    .name_owner = ffd_gltf_name_part,
};
static const mesh_resource_calls resources = {
    .find_named = ffd_gltf_find_named,
    .list_linked = ffd_gltf_list_linked,
};
static const mesh_sidecar_calls sidecars = {
    .list = ffd_gltf_list_files,
    .list_images = ffd_gltf_list_images,
    .count = ffd_gltf_count_sidecars,
    .name = ffd_sidecar_name,
};
static const mesh_place_calls places = {
    .list = ffd_gltf_list_places,
    .name = ffd_gltf_place_name,
    .find_pieces = ffd_gltf_place_pieces,
    .find_turned = ffd_gltf_find_turned,
    .count_skins = ffd_gltf_count_skins,
    .follow = follow,
};
static const mesh_morph_calls morphs = {
    .read_offsets = read_offsets,
    .write_offsets = ffd_gltf_write_offsets,
    .keep_base = ffd_gltf_keep_base,
    .keep_clips = ffd_gltf_keep_clips,
    .list_targets = ffd_gltf_list_targets,
    .read_target = ffd_gltf_read_target,
};
static const mesh_rig_calls rig = {.read_skeleton = ffd_gltf_read_skeleton,
                                   .read_anchors = ffd_gltf_read_anchors};
static const mesh_splat_calls splats = {.read = ffd_gltf_read_splats, .write = ffd_gltf_write_splats};

const mesh_format ffd_gltf_format = {
    .format = FFD_FORMAT_GLTF,
    .name = "glTF",
    .open = ffd_gltf_open,
    .close = ffd_gltf_close,
    .check = check,
    .warn = warn,
    .check_reach = ffd_gltf_check_reach,
    .largest_coordinate = FLT_MAX,
    .read_transforms = ffd_gltf_read_transforms,
    .mark_used = ffd_gltf_mark_used,
    .read = read,
    .begin_results = begin_results,
    .write = ffd_gltf_write,
    .save = save,
    .faces = ffd_gltf_faces,
    .visit_triangles = ffd_gltf_visit_triangles,
    .mixed_faces = ffd_gltf_mixed_faces,
    .corner_normals = ffd_gltf_corner_normals,
    .model = ffd_gltf_extract,
    .list_materials = ffd_gltf_list_materials,
    .selectors = &selectors,
    .resources = &resources,
    .sidecars = &sidecars,
    .places = &places,
    .morphs = &morphs,
    .rig = &rig,
    .splats = &splats,
    .weights = &ffd_gltf_weights,
    .describe = ffd_gltf_describe,
    .list_names = ffd_gltf_list_names,
    .compare = ffd_gltf_compare,
};
