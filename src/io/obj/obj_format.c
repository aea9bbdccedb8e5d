#include "io/obj/obj_format.h"
#include "io/obj/obj_weights.h"
#include "io/obj/resource/obj_resources.h"
#include <float.h>

static const mesh_selector_calls selectors = {
    .kinds = SELECTOR_BIT(SELECT_GROUP) | SELECTOR_BIT(SELECT_OBJECT) | SELECTOR_BIT(SELECT_MATERIAL),
    .mark_kinds = SELECTOR_BIT(SELECT_GROUP) | SELECTOR_BIT(SELECT_OBJECT) | SELECTOR_BIT(SELECT_MATERIAL),
    .select = ffd_obj_select,
    .mark = ffd_obj_mark,
    .list = ffd_obj_list_parts,
    .name_owner = ffd_obj_name_part,
};
static const mesh_resource_calls resources = {
    .find_named = ffd_obj_find_named,
    .list_linked = ffd_obj_list_linked,
};

const mesh_format ffd_obj_format = {
    .format = FFD_FORMAT_OBJ,
    .name = "OBJ",
    .open = ffd_obj_open,
    .close = ffd_obj_close,
    .resources = &resources,
    .largest_coordinate = DBL_MAX,
    .selectors = &selectors,
    .weights = &ffd_obj_weights,
    .mark_used = ffd_obj_mark_used,
    .read = ffd_obj_read,
    .begin_results = ffd_obj_begin_results,
    .write = ffd_obj_write,
    .save = ffd_obj_save,
    .faces = ffd_obj_faces,
    .mixed_faces = ffd_obj_mixed_faces,
    .corner_normals = ffd_obj_corner_normals,
    .model = ffd_obj_model,
    .list_materials = ffd_obj_list_materials,
    .describe = ffd_obj_describe,
    .compare = ffd_obj_compare,
};
