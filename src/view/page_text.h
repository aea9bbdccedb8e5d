/* page_text.h - text of files, made fit to be shown on a page. */
#ifndef FFD_VIEW_PAGE_TEXT_H
#define FFD_VIEW_PAGE_TEXT_H

#include "base/text/buffer.h"

/* Returns a name, which may hold any bytes, as UTF-8 that is safe to show: control and formatting characters
   become escapes ("\u{202e}"), bytes that are not UTF-8 become the replacement character, and after 200
   characters the rest becomes one "…". Free with ffd_free; NULL: out of memory. */
char *ffd_page_name(const char *name);
/* Appends UTF-8, escaped as text of an HTML element. */
void ffd_page_html(byte_buffer *out, const char *text);
/* Appends UTF-8, escaped as an attribute's value in double quotes. */
void ffd_page_attribute(byte_buffer *out, const char *text);
/* Appends a relative path as a URL: each byte but letters, digits and "-._~/" becomes %XX. */
void ffd_page_address(byte_buffer *out, const char *path);
/* Appends JSON, escaped for a script element: each '<', which occurs in strings only, becomes an escape. */
void ffd_page_json(byte_buffer *out, const char *text, size_t size);

#endif
