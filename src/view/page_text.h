/* page_text.h - names from files as a page may show them. */
#ifndef FFD_VIEW_PAGE_TEXT_H
#define FFD_VIEW_PAGE_TEXT_H

#include "base/text/buffer.h"

/* Returns a name, of any bytes, as UTF-8 that shows what it holds: control characters and those that turn or
   hide text become escapes ("\u{202e}"), what is not UTF-8 the replacement character, and from character 200
   on there is one "…". Free with ffd_free; NULL: memory ran out. */
char *ffd_page_name(const char *name);
/* Appends UTF-8 as text of an HTML element. */
void ffd_page_html(byte_buffer *out, const char *text);
/* Appends UTF-8 as the value of an attribute in double quotes. */
void ffd_page_attribute(byte_buffer *out, const char *text);
/* Appends a relative path as the address of a file: all but letters, digits and "-._~/" becomes %XX. */
void ffd_page_address(byte_buffer *out, const char *path);
/* Appends JSON for a script element: '<' occurs in strings only and is escaped there. */
void ffd_page_json(byte_buffer *out, const char *text, size_t size);

#endif
