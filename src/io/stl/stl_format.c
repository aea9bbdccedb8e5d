#include "io/stl/stl_format.h"
#include "io/stl/stl_document.h"
#include <float.h>

const mesh_format ffd_stl_format = {
    .format = FFD_FORMAT_STL,
    .name = "STL",
    .open = ffd_stl_open,
    .close = ffd_file_document_close,
    .largest_coordinate = DBL_MAX,
    .read = ffd_stl_read,
    .begin_results = ffd_stl_begin_results,
    .write = ffd_stl_write,
    .save = ffd_stl_save,
    .faces = ffd_stl_faces,
    .mixed_faces = ffd_stl_mixed_faces,
    .model = ffd_stl_model,
    .describe = ffd_stl_describe,
    .compare = ffd_stl_compare,
};
