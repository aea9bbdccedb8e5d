#include "mesh/resource/resource_copy.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "base/text/words.h"
#include "mesh/resource/image_file.h"
#include <string.h>

/* The longest wait for other processes, and the time between checks, in seconds. */
#define MOST_WAITING 60.0
#define LOOK 0.002

/* Whether there is a file at a path of the output. */
static bool is_there(const resource_copier *c, const char *target)
{
    return !c->options->to_sink && ffd_file_exists(target);
}

/* Finds whether a file is there, and whether it has these bytes. */
static ffd_status inspect(const resource_copier *c, const char *target, const file_input *bytes,
                          bool *is_file, bool *is_same, ffd_error *error)
{
    *is_same = false;
    *is_file = is_there(c, target);
    return *is_file ? ffd_file_compare(target, bytes, is_same, error) : FFD_OK;
}

/* Begins the file of a copy, unless it exists, as it should be where an old copy is replaced. If another
   process is writing the same copy, waits for it. There is no deadlock, because all processes write copies in
   the order of their paths. */
static ffd_status begin_copy(const resource_copier *c, const char *target, const file_input *bytes,
                             bool replaces, bool *exists, ffd_error *error)
{
    const double begin = ffd_clock_seconds();
    for (;;) {
        bool is_file, is_same;
        TRY(inspect(c, target, bytes, &is_file, &is_same, error));
        *exists = replaces ? is_same : is_file;
        if (*exists)
            return FFD_OK;
        const ffd_status status = ffd_output_begin(c->output, target, replaces, error);
        /* The file may also have been created between these two calls. */
        const bool waits = status && (ffd_output_was_busy(c->output) || status == FFD_E_EXISTS);
        if (!waits || ffd_clock_seconds() - begin > MOST_WAITING)
            return status;
        ffd_clock_sleep(LOOK);
    }
}

/* Judges a file that is there. *replaces: it is an earlier run's copy and is to be replaced. */
static ffd_status judge_copy(const resource_copier *c, const resource_kind *kind, const char *target,
                             const file_input *bytes, bool *replaces, ffd_error *error)
{
    bool is_file, is_same, is_own = false;
    *replaces = false;
    /* Looks twice: between the first look and that at the notes, another process may have replaced the
       earlier run's copy by this one. */
    for (int look = 0; look < 2 && !*replaces; look++) {
        TRY(inspect(c, target, bytes, &is_file, &is_same, error));
        if (is_same || !is_file)
            return FFD_OK;
        is_own = c->options->noted && ffd_copies_are_own(c->options->noted, target);
        *replaces = is_own && c->options->resources == FFD_RESOURCES_REFRESH;
    }
    if (*replaces)
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_IO, target,
                         is_own
                             ? "is the copy of an earlier run, and the %s has changed since "
                               "({resources=refresh} copies it anew)"
                             : "already exists and is not the %s to be copied there ({resources=reference} "
                               "copies none)",
                         kind->name);
}

static ffd_status write_copy(const resource_copier *c, const resource_kind *kind, const char *target,
                             const file_input *bytes, ffd_error *error)
{
    bool exists = is_there(c, target), replaces;
    TRY(judge_copy(c, kind, target, bytes, &replaces, error));
    if ((exists && !replaces) || !c->output)
        return FFD_OK;
    char *folder = ffd_path_folder(target);
    const ffd_status status = folder ? ffd_output_folder(c->output, folder, error) : ffd_fail_memory(error);
    ffd_free(folder);
    TRY(status);
    TRY(begin_copy(c, target, bytes, replaces, &exists, error));
    return exists ? judge_copy(c, kind, target, bytes, &replaces, error)
                  : ffd_output_write(c->output, bytes->data, bytes->size, error);
}

/* Returns the mesh's folder without symbolic links; NULL if there is none, or memory runs out. */
static char *resolve_folder(const file_folder *mesh)
{
    char *const folder = ffd_path_folder(mesh->file), *const root = folder ? ffd_path_resolve(folder) : NULL;
    ffd_free(folder);
    return root;
}

/* Returns whether a path in the mesh's folder goes through a symbolic link. */
static bool is_through_link(const file_folder *mesh, const char *path)
{
    if (mesh->resolve)
        return false;
    char *const root = resolve_folder(mesh), *const joined = ffd_path_sibling(mesh->file, path);
    char *const direct = root ? ffd_path_join(root, path) : NULL;
    char *const resolved = joined ? ffd_path_resolve(joined) : NULL;
    const bool same = direct && resolved && strcmp(direct, resolved) == 0;
    ffd_free(root);
    ffd_free(joined);
    ffd_free(direct);
    ffd_free(resolved);
    return !same;
}

bool ffd_resource_is_outside(const file_folder *mesh, const char *path)
{
    if (ffd_path_leads_out(path) || mesh->resolve)
        return ffd_path_leads_out(path);
    char *const root = resolve_folder(mesh), *const joined = ffd_path_sibling(mesh->file, path);
    char *const resolved = joined ? ffd_path_resolve(joined) : NULL;
    char *const relative = root && resolved ? ffd_path_relative(root, resolved) : NULL;
    const bool is_outside = relative && ffd_path_leads_out(relative);
    ffd_free(root);
    ffd_free(joined);
    ffd_free(resolved);
    ffd_free(relative);
    return is_outside;
}

/* Returns the reason why a file in the mesh's folder is not copied, judging by its name alone; NULL: none. */
static const char *left_by_name(const file_folder *mesh, const mesh_resource *resource)
{
    if (!resource->kind->has_name(resource->path))
        return resource->kind->other_name;
    if (ffd_image_is_hidden(resource->path))
        return "is a hidden file or in a hidden folder";
    return ffd_folder_has(mesh, resource->path) ? NULL : "is missing";
}

static const char *left_by_content(const file_folder *mesh, const mesh_resource *resource,
                                   const file_input *bytes)
{
    if (is_through_link(mesh, resource->path))
        return "is reached through a link";
    return resource->kind->has_content(bytes->data, bytes->size) ? NULL : resource->kind->other_content;
}

ffd_status ffd_resource_load(const file_folder *mesh, const mesh_resource *resource, file_input *bytes,
                             const char **left, ffd_error *refused, ffd_error *error)
{
    size_t most = SIZE_MAX;
    *refused = (ffd_error){0};
    *left = NULL;
    if (ffd_path_leads_out(resource->path)) {
        ffd_fail(refused, FFD_E_IO, "it is outside the model's folder");
        return FFD_OK;
    }
    *left = left_by_name(mesh, resource);
    if (*left)
        return FFD_OK;
    const ffd_status status = ffd_folder_load(mesh, resource->path, mesh->file, &most, bytes, refused);
    if (status)
        return status == FFD_E_MEMORY ? ffd_fail_memory(error) : FFD_OK;
    *left = left_by_content(mesh, resource, bytes);
    if (*left)
        ffd_file_unload(bytes);
    return FFD_OK;
}

ffd_status ffd_resource_note(const resource_copier *c, const mesh_resource *resource, ffd_error *error)
{
    if (!c->options->copied)
        return FFD_OK;
    char *const source = ffd_path_sibling(c->mesh.file, resource->path);
    const ffd_status status =
        source ? ffd_paths_add(c->options->copied, source, error) : ffd_fail_memory(error);
    ffd_free(source);
    return status;
}

/* Adds the name of a copy beside the output. */
static ffd_status note_output(const resource_copier *c, const mesh_resource *resource, ffd_error *error)
{
    if (!c->options->outputs)
        return FFD_OK;
    char *const name = ffd_path_sibling(c->options->path, resource->path);
    const ffd_status status = name ? ffd_paths_add(c->options->outputs, name, error) : ffd_fail_memory(error);
    ffd_free(name);
    return status;
}

static ffd_status copy_loaded(const resource_copier *c, const mesh_resource *resource,
                              const file_input *bytes, ffd_error *error)
{
    char *const target = c->options->to_sink ? ffd_path_sibling(c->options->path, resource->path)
                                             : ffd_path_join(c->to, resource->path);
    ffd_status status;
    TRY_END(target ? write_copy(c, resource->kind, target, bytes, error) : ffd_fail_memory(error));
    TRY_END(ffd_resource_note(c, resource, error));
    TRY_END(note_output(c, resource, error));
    if (c->options->noted && !c->options->to_sink)
        TRY_END(ffd_copies_add(c->options->noted, target, bytes->data, bytes->size, error));
end:
    ffd_free(target);
    return status;
}

ffd_status ffd_resource_copy(const resource_copier *c, const mesh_resource *resource, ffd_error *refused,
                             ffd_error *error)
{
    file_input bytes = {0};
    const char *left;
    TRY(ffd_resource_load(&c->mesh, resource, &bytes, &left, refused, error));
    if (refused->status)
        return FFD_OK;
    if (left) {
        char shown[RESOURCE_SHOWN];
        ffd_name_shown(resource->path, shown, sizeof shown);
        ffd_log_line(c->log, FFD_LOG_WARNING, "the %s \"%s\" %s and was not copied", resource->kind->name,
                     shown, left);
        return FFD_OK;
    }
    ffd_status status = copy_loaded(c, resource, &bytes, error);
    ffd_file_unload(&bytes);
    return status;
}

/* Whether a path of the output leads to a file that is there. */
static bool meets(const resource_copier *c, const char *file, const char *target)
{
    return !c->options->to_sink && ffd_file_same(file, target);
}

ffd_status ffd_resource_check_target(const resource_copier *c, const mesh_resource *resource, bool is_copied,
                                     const char *target, ffd_error *error)
{
    char *source = ffd_path_join(c->from, resource->path), *copy = ffd_path_join(c->to, resource->path);
    ffd_status status;
    TRY_END(source && copy ? FFD_OK : ffd_fail_memory(error));
    if ((!c->mesh.resolve && meets(c, source, target)) ||
        (is_copied && (strcmp(resource->path, ffd_path_name(target)) == 0 || meets(c, copy, target))))
        TRY_END(ffd_fail_file(error, FFD_E_EXISTS, target,
                              "is also the path of the %s \"%s\": give the output another name",
                              resource->kind->name, resource->path));
end:
    ffd_free(source);
    ffd_free(copy);
    return status;
}

/* Whether a relative path leads from the output's folder to a file, and if it leads out of the mesh's folder,
   to that one. */
static bool is_reached(const resource_copier *c, const char *path)
{
    char *const from = ffd_path_join(c->from, path), *const to = ffd_path_join(c->to, path);
    const bool reached = from && to && is_there(c, to) &&
                         (!ffd_path_leads_out(path) || (!c->mesh.resolve && ffd_file_same(from, to)));
    ffd_free(from);
    ffd_free(to);
    return reached;
}

static ffd_status copy(const resource_copier *c, const mesh_resource *resource, ffd_error *error)
{
    ffd_error refused;
    char shown[RESOURCE_SHOWN];
    if (ffd_path_leads_out(resource->path) && is_reached(c, resource->path))
        return FFD_OK;
    TRY(ffd_resource_copy(c, resource, &refused, error));
    ffd_name_shown(resource->path, shown, sizeof shown);
    if (refused.status)
        ffd_log_line(c->log, FFD_LOG_WARNING, "the %s \"%s\" cannot be copied: %s", resource->kind->name,
                     shown, refused.message);
    return FFD_OK;
}

static void log_unreached(const resource_copier *c, const mesh_resource *resource)
{
    char shown[RESOURCE_SHOWN];
    ffd_name_shown(resource->path, shown, sizeof shown);
    if (!is_reached(c, resource->path))
        ffd_log_line(c->log, FFD_LOG_WARNING,
                     "the output does not reach the %s \"%s\" ({resources=copy} copies it)",
                     resource->kind->name, shown);
}

ffd_status ffd_resources_bring(const resource_copier *c, const resource_list *list, bool copies, bool is_stay,
                               const char *target, ffd_error *error)
{
    for (size_t i = 0; i < list->count; i++)
        TRY(ffd_resource_check_target(c, &list->resources[i], copies || is_stay, target, error));
    for (size_t i = 0; i < list->count && !is_stay; i++) {
        if (copies)
            TRY(copy(c, &list->resources[i], error));
        else
            log_unreached(c, &list->resources[i]);
    }
    return FFD_OK;
}
