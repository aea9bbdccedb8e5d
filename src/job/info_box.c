/* info_box.c - boxes in what `ffd info` prints: any bounds, and the box of a lattice's rest volume. */
#include "base/memory/memory.h"
#include "job/chain/mesh_boxes.h"
#include "job/info.h"
#include "lattice/lattice.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <string.h>

void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *box)
{
    if (box->min[0] > box->max[0]) {
        ffd_json_null(json, key);
        return;
    }
    ffd_json_object(json, key, false);
    ffd_json_vector(json, "min", box->min, 3);
    ffd_json_vector(json, "max", box->max, 3);
    ffd_json_end(json, '}');
}

static ffd_status write_meshes(const ffd_lattice *lattice, json_text *json, ffd_error *error)
{
    ffd_json_array(json, "meshes", true);
    for (size_t i = 0; i < ffd_lattice_get_mesh_count(lattice); i++) {
        char *path = NULL;
        TRY(ffd_lattice_get_mesh(lattice, i, &path, error));
        ffd_json_string(json, NULL, path);
        ffd_free(path);
    }
    ffd_json_end(json, ']');
    return FFD_OK;
}

/* Measures the box round the named meshes, with the margin. fits: also fit the lattice to it. */
static ffd_status go_round(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                           ffd_error *error)
{
    mesh_boxes own = {0};
    path_list files = {0};
    fit_extent extent;
    const ffd_status status = ffd_mesh_box_find(&own, lattice, like, &extent, &files, NULL, error);
    ffd_mesh_boxes_free(&own);
    ffd_paths_free(&files);
    TRY(status);
    TRY(ffd_shape_grow_box(extent.min, extent.max, lattice->spec->margin, box->min, box->max, error));
    return fits ? ffd_lattice_fit_extent(lattice, &extent, error) : FFD_OK;
}

static ffd_status describe_meshes(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                                  json_text *json, ffd_error *error)
{
    ffd_error reason;
    char line[1024];
    TRY(write_meshes(lattice, json, error));
    ffd_status status = go_round(lattice, like, fits, box, &reason);
    if (!status)
        return FFD_OK;
    *box = ffd_bounds_empty();
    if (status == FFD_E_MEMORY) {
        if (error)
            *error = reason;
        return status;
    }
    ffd_error_format(&reason, line, sizeof line);
    ffd_json_string(json, "box_unknown", line);
    return FFD_OK;
}

ffd_status ffd_info_box(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                        json_text *json, ffd_error *error)
{
    const lattice_spec *const spec = lattice->spec;
    ffd_status status = FFD_OK;
    *box = ffd_bounds_empty();
    if (spec->rest != SPEC_BOX && spec->rest != SPEC_BOX_MESH)
        return FFD_OK;
    if (spec->rest == SPEC_BOX) {
        memcpy(box->min, spec->box_min, sizeof box->min);
        memcpy(box->max, spec->box_max, sizeof box->max);
    } else {
        if (spec->mesh_count > 0)
            status = describe_meshes(lattice, like, fits, box, json, error);
        ffd_json_vector(json, "margin", spec->margin, 3);
    }
    ffd_info_bounds(json, "box", box);
    if (spec->rest == SPEC_BOX && spec->has_axes) {
        ffd_json_array(json, "axes", true);
        for (size_t a = 0; a < 3; a++)
            ffd_json_vector(json, NULL, spec->box_axes + 3 * a, 3);
        ffd_json_end(json, ']');
    }
    return status;
}
