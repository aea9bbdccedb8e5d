#include "batch/files/scan.h"
#include <string.h>

void ffd_scan_add(byte_buffer *text, scan_kind kind, const char *path)
{
    const char mark = (char)kind;
    ffd_buffer_append(text, &mark, 1);
    ffd_buffer_append(text, path, strlen(path) + 1);
}

void ffd_scan_add_all(byte_buffer *text, scan_kind kind, const path_list *paths)
{
    for (size_t i = 0; i < paths->count; i++)
        ffd_scan_add(text, kind, paths->paths[i]);
}

const char *ffd_scan_next(const byte_buffer *text, size_t *at, scan_kind *kind)
{
    if (*at + 1 >= text->size)
        return NULL;
    *kind = (scan_kind)text->data[*at];
    const char *const path = text->data + *at + 1, *const end = memchr(path, 0, text->size - *at - 1);
    *at = end ? (size_t)(end - text->data) + 1 : text->size;
    return end ? path : NULL;
}
