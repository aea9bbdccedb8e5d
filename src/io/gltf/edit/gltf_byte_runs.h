/* gltf_byte_runs.h - which bytes of the buffers accessors and views use, and how many of them nothing else
   uses. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_BYTE_RUNS_H
#define FFD_IO_GLTF_EDIT_GLTF_BYTE_RUNS_H

#include "io/gltf/read/gltf_document.h"

/* `count` pieces of `size` bytes in a buffer, one every `stride` bytes. */
typedef struct gltf_byte_run {
    size_t buffer, begin, count, stride, size;
} gltf_byte_run;

/* A list of runs, which may overlap. All zeros: empty. The caller frees runs. */
typedef struct gltf_byte_runs {
    gltf_byte_run *runs;
    size_t count, capacity;
    bool failed; /* memory ran out: runs are missing */
} gltf_byte_runs;

/* Adds the bytes of an accessor: its elements, sparse indices and values, the compressed bytes of its views.
 */
void ffd_gltf_add_accessor_bytes(const gltf_document *document, size_t accessor, gltf_byte_runs *runs);

/* Adds a whole view, and its compressed bytes. */
void ffd_gltf_add_view_bytes(const gltf_document *document, size_t view, gltf_byte_runs *runs);

/* Counts the bytes that are in runs and not in others, each once. Returns false if memory runs out. */
bool ffd_gltf_count_bytes_without(const gltf_document *document, const gltf_byte_runs *runs,
                                  const gltf_byte_runs *others, uint64_t *bytes);

#endif
