#include "mesh/resource/sidecar.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/words.h"

char *ffd_sidecar_name(const char *output, size_t index)
{
    char *const stem = ffd_path_stem(output);
    byte_buffer name = {.failed = !stem};
    if (stem)
        ffd_buffer_text(&name, stem);
    if (index > 0)
        ffd_buffer_format(&name, "-%zu", index);
    ffd_buffer_text(&name, ".bin");
    ffd_free(stem);
    char *const finished = ffd_buffer_finish(&name);
    char *const path = finished ? ffd_path_sibling(output, finished) : NULL;
    ffd_free(finished);
    return path;
}

/* What is known of a file under a name. */
typedef struct sidecar_file {
    bool exists, is_own; /* is_own: the output names it already */
    size_t others;       /* models that name it too */
    path_list names;     /* of the first of these */
} sidecar_file;

static ffd_status inspect(const sidecar_names *names, const char *path, sidecar_file *file, ffd_error *error)
{
    const mesh_sharing *const sharing = names->options->sharing;
    *file = (sidecar_file){.exists = !names->options->to_sink && ffd_file_exists(path)};
    if (!sharing || !(file->exists || names->passes || sharing->is_cheap))
        return FFD_OK;
    return sharing->find(sharing->context, path, names->options->path, &file->others, &file->is_own,
                         &file->names, error);
}

/* Notes that a file of other models stays: a buffer, an image, or what an extension names. is: "is" or "was"
   a file of them. */
static ffd_status note_users(const char *path, const char *is, const sidecar_file *file, path_list *passed,
                             ffd_error *error)
{
    byte_buffer text = {0};
    ffd_buffer_format(&text, "%s %s a file of", path, is);
    for (size_t i = 0; i < file->names.count; i++)
        ffd_buffer_format(&text, "%s %s", i ? "," : "", file->names.paths[i]);
    if (file->others > file->names.count)
        ffd_buffer_format(&text, " and %zu more", file->others - file->names.count);
    char *const line = ffd_buffer_finish(&text);
    const ffd_status status = line ? ffd_paths_add(passed, line, error) : ffd_fail_memory(error);
    ffd_free(line);
    return status;
}

/* Notes the users of the file that the output has had so far, if it is left to them. The run may have given a
   new file to them too. */
static ffd_status note_old(const sidecar_names *names, const char *target, path_list *passed,
                           ffd_error *error)
{
    sidecar_file file = {0};
    if (ffd_file_same(names->old, target))
        return FFD_OK;
    ffd_status status;
    TRY_END(inspect(names, names->old, &file, error));
    if (file.others > 0)
        TRY_END(note_users(names->old, "was", &file, passed, error));
end:
    ffd_paths_free(&file.names);
    return status;
}

static void log_passed_over(const sidecar_names *names, const path_list *passed, const char *target)
{
    for (size_t i = 0; i < passed->count; i++)
        ffd_log_line(names->log, FFD_LOG_WARNING, "%s too, and stays: %s is written in place of it",
                     passed->paths[i], target);
}

ffd_status ffd_sidecar_next(sidecar_names *names, sidecar_own_function *own, const void *context,
                            char **target, ffd_error *error)
{
    path_list passed = {0};
    sidecar_file file = {0};
    char *path = NULL;
    bool is_own = false, old_is_noted = !names->old;
    ffd_status status = FFD_OK;
    *target = NULL;
    while (!*target) {
        path = ffd_sidecar_name(names->options->path, names->index++);
        TRY_END(path ? inspect(names, path, &file, error) : ffd_fail_memory(error));
        if (file.others > 0) {
            TRY_END(note_users(path, "is", &file, &passed, error));
            names->passes++;
            old_is_noted = old_is_noted || ffd_file_same(names->old, path);
        } else {
            is_own = names->in_place ? own(context, path) : file.is_own;
            const bool is_free = !file.exists || is_own || (!names->in_place && names->passes == 0);
            *target = is_free ? path : NULL;
        }
        if (!*target)
            ffd_free(path);
        path = NULL;
        ffd_paths_free(&file.names);
    }
    if (!old_is_noted)
        TRY_END(note_old(names, *target, &passed, error));
    if (!is_own) /* else it has that name already */
        log_passed_over(names, &passed, *target);
end:
    if (status) {
        ffd_free(*target);
        *target = NULL;
    }
    ffd_free(path);
    ffd_paths_free(&file.names);
    ffd_paths_free(&passed);
    return status;
}
