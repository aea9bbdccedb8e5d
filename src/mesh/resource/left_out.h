/* left_out.h - what a picture of a mesh goes without, as one line of a log: how many, and why the first ones.
 */
#ifndef FFD_MESH_RESOURCE_LEFT_OUT_H
#define FFD_MESH_RESOURCE_LEFT_OUT_H

#include "mesh/mesh_log.h"
#include <stddef.h>

#define LEFT_SHOWN 3

/* Zeroed: nothing. */
typedef struct left_out {
    size_t count;
    char shown[LEFT_SHOWN][200];
} left_out;

/* Adds a thing, by its name as it is written, and why it is left out: "is missing". */
void ffd_left_add(left_out *left, const char *name, const char *why);
/* Adds a file that was not loaded: left is why, or NULL where it must not be read (ffd_resource_load). */
void ffd_left_add_unloaded(left_out *list, const char *path, const char *left);
/* Says it, if there is anything: "2 WHAT: a is missing, b is no file". one, many: WHAT, by how many there
 * are. */
void ffd_left_say(const left_out *left, const char *one, const char *many, const mesh_log *log);

#endif
