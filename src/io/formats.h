/* formats.h - the table of mesh formats. */
#ifndef FFD_IO_FORMATS_H
#define FFD_IO_FORMATS_H

#include "mesh/mesh.h"

/* For messages. */
#define FORMAT_NAMES "obj, gltf, glb, vrm, ply, off or stl"

/* The table for a format; NULL for FFD_FORMAT_AUTO. */
const mesh_format *ffd_format_table(ffd_format format);

/* Opens a document by a format's table, and gives it this table, so that no format's reader needs to know its
   own. input is the document's after success only. Errors: those of the format's open function. */
ffd_status ffd_format_open(const mesh_format *format, file_input *input, const ffd_source *source,
                           mesh_document **document, ffd_error *error);

#endif
