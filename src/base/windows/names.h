/* names.h - names in UTF-8, and those of Windows; errors of Windows as errno. */
#ifndef FFD_BASE_WINDOWS_NAMES_H
#define FFD_BASE_WINDOWS_NAMES_H

#include <stddef.h>
#include <stdint.h>
#include <wchar.h>

/* The longest path of Windows, with the final 0. */
#define WIDE_ROOM 32768

/* Makes a path of Windows, which may be longer than 260 characters. Returns false with errno for one that is
   no UTF-8, too long, or that of no file (path_flaw.h). */
_Bool ffd_wide_path(const char *path, wchar_t wide[WIDE_ROOM]);
/* Returns the text in UTF-8, to be freed with free; NULL with errno if memory runs out. */
char *ffd_utf8(const wchar_t *wide);
/* Likewise into `capacity` bytes. Returns false with errno if these do not suffice. */
_Bool ffd_utf8_into(const wchar_t *wide, char *text, size_t capacity);
/* Makes a path that Windows gives one with '/', without the prefix of long ones. */
void ffd_plain_path(wchar_t *wide);

/* Returns a letter as Windows compares names: the small one. */
uint32_t ffd_small_letter(uint32_t c);
/* Returns a name in these letters, to be freed with free; NULL if memory runs out. */
char *ffd_small_letters(const char *name);
/* Returns whether two names differ in their letters' case at most. */
_Bool ffd_equal_without_case(const char *a, const char *b);

/* Sets errno by an error of Windows. Returns -1. */
int ffd_set_errno_by(unsigned long error);
/* Likewise by that of the last call. */
int ffd_set_errno(void);

#endif
