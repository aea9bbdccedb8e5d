/* temporary.h - the temporary names of outputs that are not complete: in the folder of the target, always the
   same for a target, locked by the run that writes. And the atomic step that gives such a file its final
   name.

   Some file systems have no locks (Lustre without -o flock, NFS without its lock service, some of FUSE).
   There files are not locked, and what a run that still goes on writes is taken for the leftover of a killed
   one. */
#ifndef FFD_BASE_FILE_TEMPORARY_H
#define FFD_BASE_FILE_TEMPORARY_H

#include "base/fail.h"
#include <stdbool.h>

/* Returns the path ".NAMEending" in the target's folder; a name that is too long is shortened to its
   beginning and a digest. Free with ffd_free. Returns NULL if memory runs out. */
char *ffd_hidden_name(const char *target, const char *ending);
/* The same with the ending ".ffd-tmp". */
char *ffd_temporary_name(const char *target);
/* Locks the open file at path against other runs, where the file system has locks. Returns 1; 0 if path leads
   to another file by now; -1 with errno on failure, EBUSY if another run holds the lock. */
int ffd_lock_named(int fd, const char *path);
/* Returns whether path leads to another file than the open one, which only happens where there are no
   locks. */
bool ffd_names_other(int fd, const char *path);
/* Creates the file for reading and writing, and locks it. An existing file without a lock is the leftover of
   a killed run; it is removed first, because its permission bits may be outdated. A file that another run has
   locked is left alone. Returns the descriptor; -1 with errno on failure, EBUSY if another run holds the
   lock. Nothing is left behind after a failure. */
int ffd_temporary_open(const char *name);
/* Describes such a failure, by its errno; target: for the message. */
ffd_status ffd_temporary_fail(int reason, const char *name, const char *target, ffd_error *error);
/* Renames a file atomically. An existing target is replaced if `replace` is true; otherwise the call fails
   with EEXIST, also if the target was created just now. Returns 0, or -1 with errno. */
int ffd_place(const char *from, const char *to, bool replace);
/* Removes the temporary file of a target, unless another run is writing it. */
void ffd_temporary_remove(const char *target);
/* Removes the temporary files that a process left when it ended while writing path (for a .gltf also those of
   its buffers), unless another run is writing them. */
void ffd_temporary_discard(const char *path);

#endif
