/* unnamed_file.h - a temporary file that nobody else finds, and that is gone with its descriptor. */
#ifndef FFD_BASE_FILE_UNNAMED_FILE_H
#define FFD_BASE_FILE_UNNAMED_FILE_H

/* Opens one in TMPDIR or /var/tmp (Windows: TMP). Returns its descriptor; -1 if that is not possible. */
int ffd_unnamed_file(void);

#endif
