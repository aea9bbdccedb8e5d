#include "mesh/resource/left_out.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include <stdio.h>

/* Capacity for a name, including the final 0. */
#define NAME_SIZE 81

void ffd_left_add(left_out *left, const char *name, const char *why)
{
    char shown[NAME_SIZE];
    if (left->count < LEFT_SHOWN) {
        ffd_name_shown(name, shown, sizeof shown);
        snprintf(left->shown[left->count], sizeof left->shown[left->count], "\"%s\" %s", shown, why);
    }
    left->count++;
}

ffd_status ffd_left_add_unreached(left_out *left, const char *to, const char *path, const char *why,
                                  ffd_error *error)
{
    char *const there = to ? ffd_path_join(to, path) : NULL;
    const bool is_there = there && ffd_file_exists(there);
    ffd_free(there);
    if (to && !there)
        return ffd_fail_memory(error);
    if (!is_there)
        ffd_left_add(left, path, why);
    return FFD_OK;
}

void ffd_left_add_unloaded(left_out *list, const char *path, const char *left)
{
    const char *const refused = ffd_path_leads_out(path) ? "is outside the model's folder" : "cannot be read";
    ffd_left_add(list, path, left ? left : refused);
}

void ffd_left_out_log(const left_out *left, const char *one, const char *many, const mesh_log *log)
{
    char text[sizeof left->shown + 60] = "";
    size_t length = 0;
    for (size_t i = 0; i < LEFT_SHOWN && i < left->count; i++)
        length +=
            (size_t)snprintf(text + length, sizeof text - length, "%s%s", i > 0 ? ", " : "", left->shown[i]);
    if (left->count > LEFT_SHOWN)
        snprintf(text + length, sizeof text - length, " and %zu more", left->count - LEFT_SHOWN);
    if (left->count > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu %s: %s", left->count, ffd_plural(left->count, one, many),
                     text);
}

void ffd_left_out_log_stream(const left_out *left, const mesh_log *log)
{
    ffd_left_out_log(left, "file that the mesh names is not copied, as standard input has no folder",
                     "files that the mesh names are not copied, as standard input has no folder", log);
}
