/* left_out.h - what is missing in a picture of a mesh, as one line of a log: how many things, and the reasons
   for the first ones. */
#ifndef FFD_MESH_RESOURCE_LEFT_OUT_H
#define FFD_MESH_RESOURCE_LEFT_OUT_H

#include "base/fail.h"
#include "mesh/mesh_log.h"
#include <stddef.h>

#define LEFT_SHOWN 3

/* All zeros: empty. */
typedef struct left_out {
    size_t count;
    char shown[LEFT_SHOWN][200];
} left_out;

/* Adds a thing by its name, with the reason why it is left out, such as "is missing". */
void ffd_left_add(left_out *left, const char *name, const char *why);
/* Adds a file that is not copied, unless there is one at the same path in the output's folder `to` (NULL:
   there are no files). why: what names it, such as "of mtllib". Errors: FFD_E_MEMORY. */
ffd_status ffd_left_add_unreached(left_out *left, const char *to, const char *path, const char *why,
                                  ffd_error *error);
/* Adds a file that was not loaded. left: the reason; NULL: it must not be read (ffd_resource_load). */
void ffd_left_add_unloaded(left_out *list, const char *path, const char *left);
/* Logs the list unless it is empty: "2 WHAT: a is missing, b is no file". one, many: WHAT for one thing, and
   for several. */
void ffd_left_out_log(const left_out *left, const char *one, const char *many, const mesh_log *log);
/* The same for files that a mesh from standard input names. */
void ffd_left_out_log_stream(const left_out *left, const mesh_log *log);

#endif
