/* source.h - opening the mesh of a job. */
#ifndef FFD_JOB_INPUT_SOURCE_H
#define FFD_JOB_INPUT_SOURCE_H

#include "mesh/mesh.h"

/* The format that a source has by its own account or by its name's ending. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_source_format(const ffd_source *source, ffd_format *format, ffd_error *error);

/* Opens the document, to be closed by the caller, with the job's threads (0: all cores) unless the source has
   a number of its own. Messages name the file. */
ffd_status ffd_source_open(const ffd_source *source, int threads, mesh_document **document, ffd_error *error);

/* Adds the files that the source's document was read from: its own, then those that it refers to. A stream
   is not a file. Errors: FFD_E_MEMORY. */
ffd_status ffd_source_files(const ffd_source *source, const mesh_document *document, path_list *files,
                            ffd_error *error);

/* Closes a document, if there is one, and clears the pointer. */
void ffd_source_close(mesh_document **document);

/* Positions of a part's vertices [first, first + count) in the lattice's space: 3*count doubles. */
void ffd_source_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                          double *xyz);

/* Widens bounds by a part's finite vertices, in the lattice's space. Returns how many are not finite. */
size_t ffd_source_widen(const mesh_document *document, size_t part, ffd_bounds *bounds);

/* What a source is called in messages. */
const char *ffd_source_name(const ffd_source *source);

#endif
