/* temporary.h - the names under which outputs are written until they are complete: beside their targets, the
   same for the same target, locked by the run that writes. And the one step by which such a file gets its
   name. */
#ifndef FFD_BASE_FILE_TEMPORARY_H
#define FFD_BASE_FILE_TEMPORARY_H

#include <stdbool.h>

/* The target's folder and ".NAMEending"; of a name too long for that its beginning and a digest. Free with
   ffd_free; NULL: no memory. */
char *ffd_hidden_name(const char *target, const char *ending);
/* That name with the ending ".ffd-tmp". */
char *ffd_temporary_name(const char *target);
/* Locks the open file at path, so that no other run takes it. Returns 1; 0: path leads to another file by
   now; -1: errno says why not; EBUSY: another run holds it. */
int ffd_lock_named(int fd, const char *path);
/* Makes the file of that name, for reading too, and locks it, so that a run that was killed leaves no
   obstacle and one that still runs is not disturbed. A file that exists and is not locked is a leftover: it
   is removed, since its permission bits are outdated. Returns its descriptor; -1: errno says why not; EBUSY:
   another run holds it. */
int ffd_temporary_open(const char *name);
/* Renames a file. One that is there is replaced if `replace`; else it is left alone, and errno is EEXIST,
   also where it came a moment ago. Returns 0, or -1 and errno. */
int ffd_place(const char *from, const char *to, bool replace);
/* Removes the temporary file of a target, unless another run is writing it. */
void ffd_temporary_remove(const char *target);
/* Removes what a process that ended in the middle of writing path left beside it (and of the buffers beside a
   .gltf), unless another one is writing it. */
void ffd_temporary_discard(const char *path);

#endif
