/* temporary.h - the names under which outputs are written until they are complete: beside their targets, the
   same for the same target, locked by the run that writes. */
#ifndef FFD_BASE_FILE_TEMPORARY_H
#define FFD_BASE_FILE_TEMPORARY_H

/* The target's folder and ".NAME.ffd-tmp"; of a name too long for that its beginning and a digest. Free with
   ffd_free; NULL: no memory. */
char *ffd_temporary_name(const char *target);
/* Makes the file of that name and locks it, so that a run that was killed leaves no obstacle and one that
   still lives is not disturbed. A file that is there and not locked was left behind: it is removed, since its
   permission bits are outdated. Returns its descriptor; -1: errno says why not; EBUSY: another run holds it.
 */
int ffd_temporary_open(const char *name);
/* Removes what a process that ended in the middle of writing path left beside it (and of the buffers beside a
   .gltf), unless another one is writing it. */
void ffd_temporary_discard(const char *path);

#endif
