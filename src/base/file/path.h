/* path.h - parts of file names. Both '/' and, on Windows, '\\' separate. */
#ifndef FFD_BASE_FILE_PATH_H
#define FFD_BASE_FILE_PATH_H

#include <stdbool.h>
#include <stddef.h>

/* "a/b.obj" -> "b.obj"; points into path. */
const char *ffd_path_name(const char *path);
/* "a/b.obj" -> ".obj", or ""; points into path. */
const char *ffd_path_ending(const char *path);
/* Whether path ends so; letters in any case. */
bool ffd_path_has_ending(const char *path, const char *ending);
/* Whether path starts at the root of a file system. */
bool ffd_path_is_absolute(const char *path);

/* Whether a normalized relative path leads out of its folder. */
bool ffd_path_leads_out(const char *path);

/* The functions below return new strings (free with ffd_free); NULL if memory runs out. */

/* "a/b.obj" -> "a"; "b.obj" -> "." */
char *ffd_path_folder(const char *path);
/* "a/b.x.obj" -> "b.x" */
char *ffd_path_stem(const char *path);
/* "a", "b" -> "a/b" */
char *ffd_path_join(const char *folder, const char *name);
/* "a/b.obj", "c" -> "a/c" */
char *ffd_path_beside(const char *path, const char *name);
/* The path with "." and ".." resolved ("a/../b" -> "b"); leading ".." of a relative path stay. */
char *ffd_path_normalize(const char *path);
/* The path that leads from the folder `from` to `to`, both absolute and normalized. */
char *ffd_path_relative(const char *from, const char *to);
/* A copy of text. */
char *ffd_text_copy(const char *text);

#endif
