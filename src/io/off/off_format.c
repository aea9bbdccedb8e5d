#include "io/formats.h"
#include "io/off/off_document.h"
#include <float.h>

/* Nothing in an OFF file moves vertices but the file's own numbers. */
static ffd_status check(const mesh_document *document, ffd_error *error)
{
    (void)document;
    (void)error;
    return FFD_OK;
}

const mesh_format ffd_off_format = {
    .format = FFD_FORMAT_OFF,
    .name = "OFF",
    .open = ffd_off_open,
    .close = ffd_off_close,
    .check = check,
    .largest_coordinate = DBL_MAX,
    .read_positions = ffd_off_read_positions,
    .read_normals = ffd_off_read_normals,
    .begin_results = ffd_off_begin_results,
    .write_positions = ffd_off_write_positions,
    .write_normals = ffd_off_write_normals,
    .save = ffd_off_save,
    .faces = ffd_off_faces,
    .model = ffd_off_model,
    .describe = ffd_off_describe,
    .compare = ffd_off_compare,
};
