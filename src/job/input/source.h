/* source.h - opening the mesh of a job. */
#ifndef FFD_JOB_INPUT_SOURCE_H
#define FFD_JOB_INPUT_SOURCE_H

#include "base/memory/hash.h"
#include "mesh/mesh.h"

/* Returns a source's format: the one that it states, or else that of its name's ending.
   Errors: FFD_E_ARGUMENT. */
ffd_status ffd_source_format(const ffd_source *source, ffd_format *format, ffd_error *error);

/* Opens the document, to be closed by the caller, with the job's threads (0: all cores) unless the source has
   a number of its own. Messages name the file. */
ffd_status ffd_source_open(const ffd_source *source, int threads, mesh_document **document, ffd_error *error);
/* The same with the bytes of the source's file, which the document takes over, or which are unloaded. */
ffd_status ffd_source_open_bytes(const ffd_source *source, int threads, file_input *input,
                                 mesh_document **document, ffd_error *error);

/* Adds the files that the source's document was read from: its own, then those that it refers to. A stream
   is not a file, nor is what is in memory. Errors: FFD_E_MEMORY. */
ffd_status ffd_source_files(const ffd_source *source, const mesh_document *document, path_list *files,
                            ffd_error *error);

/* Whether the document refers to no other file, be it there or not. False too where memory runs out. */
bool ffd_source_is_alone(const mesh_document *document);

/* Closes a document, if there is one, and clears the pointer. */
void ffd_source_close(mesh_document **document);

/* Positions of a part's vertices [first, first + count) in the lattice's space: 3*count doubles. */
void ffd_source_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                          double *xyz);

/* Gets a place of a vertex, in the lattice's space. Returns false to end the walk. */
typedef bool place_visitor(void *context, size_t vertex, const double place[3]);

/* Visits the places that a box round a part has to hold: those of its vertices, and where each morph target,
   and what their weights show of all, bring them. Returns false where a visit did. */
bool ffd_source_visit_places(mesh_document *document, size_t part, place_visitor *visit, void *context);

/* Widens bounds by a part's finite vertices, in the lattice's space. Returns how many are not finite. */
size_t ffd_source_widen(const mesh_document *document, size_t part, ffd_bounds *bounds);

/* A hash of what decides whether a file is read or refused: strict and the allowed extensions. */
hash128 ffd_source_rules(const ffd_source *source);

/* What a source is called in messages. */
const char *ffd_source_name(const ffd_source *source);

#endif
