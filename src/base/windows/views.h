/* views.h - files that are mapped into memory (posix.h: mmap). */
#ifndef FFD_BASE_WINDOWS_VIEWS_H
#define FFD_BASE_WINDOWS_VIEWS_H

/* Makes the mappings of a file copies in memory, at the same addresses: Windows neither replaces nor deletes
   a file that is mapped. No thread may be reading them. Where memory does not suffice they stay. */
void ffd_views_detach(const char *path);

#endif
