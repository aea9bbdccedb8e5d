/* pattern.h - whether a name matches a pattern of the shell: * for any characters, ? for one, [a-z] for one
   of these, [!a-z] and [^a-z] for another one, with the classes [:alpha:], [:digit:] and so on of ASCII. A
   character is one of UTF-8, or else a byte. A backslash takes the meaning of what follows, but on Windows,
   where it separates folders, and capitals are equal to small letters. A leading dot is matched by a dot
   only. */
#ifndef FFD_BASE_FILE_PATTERN_H
#define FFD_BASE_FILE_PATTERN_H

#include <stdbool.h>
#include <stddef.h>

/* Returns whether the first `length` characters of a pattern have a wildcard. */
bool ffd_pattern_has_wildcards(const char *pattern, size_t length);
/* Returns whether the first `length` characters of a pattern, which have no separator, match a name. */
bool ffd_pattern_matches(const char *pattern, size_t length, const char *name);
/* Removes the backslashes that take a meaning. */
void ffd_pattern_unescape(char *text);

#endif
