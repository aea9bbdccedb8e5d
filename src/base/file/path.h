/* path.h - operations on file names, without file system access. Separators are '/' and, on Windows, '\\'. */
#ifndef FFD_BASE_FILE_PATH_H
#define FFD_BASE_FILE_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether a character separates names. */
bool ffd_is_separator(char c);
/* Takes the next character of a text in UTF-8 as patterns see it: small on Windows, unchanged elsewhere. A
   byte that is in no character counts as one beyond the last. */
uint32_t ffd_take_character(const char **text);
/* "a/b.obj" -> "b.obj"; points into path. */
const char *ffd_path_name(const char *path);
/* "a/b.obj" -> ".obj", or ""; points into path. */
const char *ffd_path_ending(const char *path);
/* Returns whether path has this ending, in upper or lower case. */
bool ffd_path_has_ending(const char *path, const char *ending);
/* Returns whether path is absolute. */
bool ffd_path_is_absolute(const char *path);

/* Returns whether two names are those of one file. */
bool ffd_names_equal(const char *a, const char *b);
/* Returns whether a path leads to something below a folder; both are absolute and resolved. On Windows the
   case of letters does not matter. */
bool ffd_path_is_inside(const char *folder, const char *path);
/* Returns whether a normalized relative path leads out of its folder. */
bool ffd_path_leads_out(const char *path);

/* The functions below return new strings (free with ffd_free); NULL if memory runs out. */

/* "a/b.obj" -> "a"; "b.obj" -> "." */
char *ffd_path_folder(const char *path);
/* "a/b.x.obj" -> "b.x" */
char *ffd_path_stem(const char *path);
/* "a", "b" -> "a/b" */
char *ffd_path_join(const char *folder, const char *name);
/* "a/b.obj", "c" -> "a/c" */
char *ffd_path_sibling(const char *path, const char *name);
/* "a/b.obj", "glb" -> "a/b.glb". The ending may begin with a dot; its capitals become small. */
char *ffd_path_with_ending(const char *path, const char *ending);
/* Resolves "." and "..": "a/../b" -> "b". Leading ".." of a relative path stay. */
char *ffd_path_normalize(const char *path);
/* Returns the relative path from the folder `from` to `to`; both are absolute and normalized. */
char *ffd_path_relative(const char *from, const char *to);
/* Copies a string. */
char *ffd_text_copy(const char *text);

#endif
