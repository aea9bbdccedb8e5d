#include "io/off/off_format.h"
#include "io/off/off_document.h"
#include <float.h>

const mesh_format ffd_off_format = {
    .format = FFD_FORMAT_OFF,
    .name = "OFF",
    .open = ffd_off_open,
    .close = ffd_file_document_close,
    .mark_used = ffd_off_mark_used,
    .largest_coordinate = DBL_MAX,
    .read = ffd_file_document_read,
    .begin_results = ffd_file_document_begin_results,
    .write = ffd_file_document_write,
    .save = ffd_off_save,
    .faces = ffd_off_faces,
    .mixed_faces = ffd_off_mixed_faces,
    .model = ffd_off_model,
    .describe = ffd_off_describe,
    .compare = ffd_off_compare,
};
