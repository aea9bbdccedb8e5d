/* memory_files.h - the files that a mesh in memory refers to: the caller's function is asked once for each.
 */
#ifndef FFD_BASE_FILE_MEMORY_FILES_H
#define FFD_BASE_FILE_MEMORY_FILES_H

#include <ffd/job.h>

/* Those of several meshes, in a list. NULL: empty. */
typedef struct memory_files memory_files;

/* Adds those of a mesh that has bytes and a name, at the head of the list. Errors: FFD_E_MEMORY. */
ffd_status ffd_memory_add(memory_files **list, const ffd_source *mesh, ffd_error *error);
/* An ffd_resolve_function for names as the mesh has them, whose user is the head of such a list. It finds
   nothing outside of the mesh's folder. Thread-safe. */
ffd_status ffd_memory_find(void *files, const char *name, ffd_bytes *bytes);
/* Returns status; but if a caller's function has failed, or memory for its result ran out, that failure. */
ffd_status ffd_memory_judge(const memory_files *list, ffd_status status, ffd_error *error);
/* Frees the list. */
void ffd_memory_free(memory_files **list);

#endif
