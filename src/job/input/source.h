/* source.h - opens the mesh of a job. */
#ifndef FFD_JOB_INPUT_SOURCE_H
#define FFD_JOB_INPUT_SOURCE_H

#include "base/memory/hash.h"
#include "mesh/mesh.h"

/* Finds a source's format: the one that it states, else by the ending of its name. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_source_format(const ffd_source *source, ffd_format *format, ffd_error *error);

/* Opens a document, to be closed by the caller. threads: 0: all cores; a number in the source has precedence.
   Messages name the file. */
ffd_status ffd_source_open(const ffd_source *source, int threads, mesh_document **document, ffd_error *error);
/* The same from the bytes of the source's file. The document takes them over; on failure they are
   unloaded. */
ffd_status ffd_source_open_bytes(const ffd_source *source, int threads, file_input *input,
                                 mesh_document **document, ffd_error *error);

/* Adds the files that the source's document was read from: its own, then those that it refers to. Streams and
   data in memory are not files. Errors: FFD_E_MEMORY. */
ffd_status ffd_source_files(const ffd_source *source, const mesh_document *document, path_list *files,
                            ffd_error *error);

/* Whether the document refers to no other file, present or missing. False also if memory runs out. */
bool ffd_source_is_alone(const mesh_document *document);

/* Closes a document, which may be NULL, and clears the pointer. */
void ffd_source_close(mesh_document **document);

/* Fills 3*count doubles with the positions of a part's vertices [first, first + count) in the lattice's
   space. */
void ffd_source_positions(const mesh_document *document, mesh_state state, size_t part, size_t first,
                          size_t count, double *xyz);

/* Receives a position of a vertex in the lattice's space. Returns false to stop the walk. */
typedef bool place_visitor(void *context, size_t vertex, const double place[3]);

/* Visits all positions that a box round a part has to enclose: of its vertices at rest, moved by each morph
   target in full, and moved by all targets with their default weights. Returns false if a visitor stopped. */
bool ffd_source_visit_places(const mesh_document *document, size_t part, place_visitor *visit, void *context);

/* Widens bounds by a part's finite vertices, in the lattice's space. Returns the number of other vertices. */
size_t ffd_source_widen(const mesh_document *document, mesh_state state, size_t part, ffd_bounds *bounds);

/* Hashes the options that decide whether a file is read or refused: strict, and the allowed extensions. */
hash128 ffd_source_rules(const ffd_source *source);

/* Returns the name of a source for messages. */
const char *ffd_source_name(const ffd_source *source);

#endif
