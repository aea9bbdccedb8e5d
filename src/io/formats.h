/* formats.h - the table of mesh formats. */
#ifndef FFD_IO_FORMATS_H
#define FFD_IO_FORMATS_H

#include "mesh/linked_files.h"
#include "mesh/mesh.h"

/* Returns the table of a format; NULL for FFD_FORMAT_AUTO. */
const mesh_format *ffd_format_table(ffd_format format);

/* Opens a document with a format's table, and stores the table in the document, so that a reader need not
   know its own. The document owns input after success, the caller after a failure. Errors: those of the
   format's open function. */
ffd_status ffd_format_open(const mesh_format *format, file_input *input, const ffd_source *source,
                           mesh_document **document, ffd_error *error);

#endif
