#include "batch/files/run_files.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

hash128 ffd_run_place(run_files *files, const char *path)
{
    return ffd_place_of(&files->places, path);
}

hash128 ffd_run_read_place(run_files *files, const char *path)
{
    for (size_t i = 0; i < PLACES_KEPT; i++)
        if (files->kept[i].path && strcmp(files->kept[i].path, path) == 0)
            return files->kept[i].place;
    kept_place *const kept = &files->kept[files->next_kept];
    files->next_kept = (files->next_kept + 1) % PLACES_KEPT;
    ffd_free(kept->path);
    *kept = (kept_place){ffd_text_copy(path), ffd_run_place(files, path)};
    return kept->place;
}

bool ffd_run_writer(const run_files *files, const hash128 *file, uint64_t *line)
{
    uint64_t index;
    if (ffd_files_find(&files->writes, file, line))
        return true;
    if (!ffd_files_find(&files->copies, file, &index))
        return false;
    *line = files->copied[index].line;
    return true;
}

static void refuse(const run_files *files, batch_job *job, const char *what)
{
    if (files->manifest)
        ffd_fail_line(&job->error, FFD_E_INVALID, files->manifest, (size_t)job->line, "%s", what);
    else
        ffd_fail_file(&job->error, FFD_E_INVALID, job->input, "%s", what);
}

/* The meshes of a pattern have no lines: they are counted as they come. */
static const char *job_of(const run_files *files)
{
    return files->manifest ? "the job of line" : "job";
}

void ffd_run_refuse(const run_files *files, batch_job *job, const char *role, const char *file, uint64_t line)
{
    char what[600];
    if (line)
        snprintf(what, sizeof what, "%s\"%.400s\" is written by %s %" PRIu64 " too", role, file,
                 job_of(files), line);
    else
        snprintf(
            what, sizeof what,
            "%s\"%.400s\" is the manifest, the table, the report, the depfile, the journal, the index or "
            "the array of this run",
            role, file);
    refuse(files, job, what);
}

void ffd_run_refuse_written(const run_files *files, batch_job *job, const char *file, uint64_t line)
{
    char what[600];
    snprintf(what, sizeof what, "\"%.400s\" is read by %s %" PRIu64, file, job_of(files), line);
    refuse(files, job, what);
}

void ffd_run_refuse_conflict(const run_files *files, batch_job *job, const char *role, const path_list *list,
                             const read_conflicts *conflicts)
{
    for (size_t i = 0; i < conflicts->count && !job->error.status; i++)
        if (conflicts->lines[i] != job->line)
            ffd_run_refuse(files, job, role, list->paths[conflicts->files[i]], conflicts->lines[i]);
}

ffd_status ffd_run_keep(run_files *files, const char *path, ffd_error *error)
{
    const hash128 file = ffd_run_place(files, path);
    return ffd_files_put(&files->writes, &file, 0, error);
}

ffd_status ffd_run_reserve(run_files *files, const char *path, ffd_error *error)
{
    TRY(ffd_run_keep(files, path, error));
    return ffd_run_add_folder(files, path, error);
}

/* Adds a resolved folder and those above it, as far as they are new. Shortens the path. */
static ffd_status add_folders(run_files *files, char *folder, ffd_error *error)
{
    const hash128 own = ffd_run_place(files, folder);
    uint32_t first;
    if (!ffd_intern(&files->folders.exact, &own, sizeof own, &first))
        return ffd_fail_memory(error);
    for (bool goes_on = true; goes_on;) {
        const hash128 place = ffd_run_place(files, folder);
        const size_t known = files->folders.known.count;
        uint32_t index;
        if (!ffd_intern(&files->folders.known, &place, sizeof place, &index))
            return ffd_fail_memory(error);
        char *const slash = strrchr(folder, '/');
        goes_on = index == known && slash && folder[1];
        if (goes_on)
            slash[slash == folder] = 0;
    }
    return FFD_OK;
}

/* Whether a path is in this folder. */
static bool is_in(const char *folder, const char *path)
{
    const size_t length = (size_t)(ffd_path_name(path) - path);
    return folder && strncmp(folder, path, length) == 0 && folder[length] == 0;
}

/* Returns the folder of a path with its last slash, freed by the caller; NULL: memory ran out. */
static char *copy_folder(const char *path)
{
    char *const folder = ffd_text_copy(path);
    if (folder)
        folder[ffd_path_name(path) - path] = 0;
    return folder;
}

ffd_status ffd_run_add_folder(run_files *files, const char *output, ffd_error *error)
{
    output_folders *const folders = &files->folders;
    if (is_in(folders->last, output))
        return FFD_OK;
    ffd_free(folders->last);
    folders->last = copy_folder(output);
    ffd_free(folders->asked);
    folders->asked = NULL;
    char *const resolved = folders->last ? ffd_path_resolve(*folders->last ? folders->last : ".") : NULL;
    ffd_status status = folders->last ? FFD_OK : ffd_fail_memory(error);
    if (resolved) /* a folder that is not there yet holds no mesh */
        status = add_folders(files, resolved, error);
    ffd_free(resolved);
    return status;
}

/* Whether a resolved folder, or one below it, has outputs; or copied files, which go to folders below those
   of outputs. Shortens the path. */
static bool holds_outputs(run_files *files, char *folder)
{
    uint32_t index;
    hash128 place = ffd_run_place(files, folder);
    if (ffd_intern_find(&files->folders.known, &place, sizeof place, &index))
        return true;
    for (char *slash = strrchr(folder, '/'); files->has_odd_outputs && slash && folder[1];
         slash = strrchr(folder, '/')) {
        slash[slash == folder] = 0;
        place = ffd_run_place(files, folder);
        if (ffd_intern_find(&files->folders.exact, &place, sizeof place, &index))
            return true;
    }
    return false;
}

bool ffd_run_writes_near(run_files *files, const char *path)
{
    output_folders *const folders = &files->folders;
    if (files->comes_once)
        return true;
    if (is_in(folders->asked, path))
        return folders->holds_outputs;
    ffd_free(folders->asked);
    folders->asked = copy_folder(path);
    char *const resolved = folders->asked ? ffd_path_resolve(*folders->asked ? folders->asked : ".") : NULL;
    folders->holds_outputs = !resolved || holds_outputs(files, resolved);
    ffd_free(resolved);
    return folders->holds_outputs;
}

static hash128 place_of_folder(run_files *files, const char *output)
{
    char *const folder = ffd_path_folder(output);
    const hash128 place = ffd_run_read_place(files, folder ? folder : "");
    ffd_free(folder);
    return place;
}

folder_survey ffd_run_survey(run_files *files, const char *output)
{
    const hash128 place = place_of_folder(files, output);
    uint32_t index;
    return ffd_intern_find(&files->surveyed.places, &place, sizeof place, &index)
               ? (folder_survey)files->surveyed.states[index]
               : SURVEY_NONE;
}

ffd_status ffd_run_set_survey(run_files *files, const char *output, folder_survey state, ffd_error *error)
{
    surveyed_folders *const surveyed = &files->surveyed;
    const hash128 place = place_of_folder(files, output);
    uint32_t index;
    if (!ffd_grow((void **)&surveyed->states, &surveyed->capacity, surveyed->places.count + 1, 1) ||
        !ffd_intern(&surveyed->places, &place, sizeof place, &index))
        return ffd_fail_memory(error);
    surveyed->states[index] = (uint8_t)state;
    return FFD_OK;
}

static void free_lattices(known_lattices *lattices)
{
    for (size_t i = 0; i < lattices->paths.count; i++)
        ffd_paths_free(&lattices->list[i].files);
    ffd_free(lattices->list);
    ffd_intern_free(&lattices->paths);
}

void ffd_run_files_free(run_files *files)
{
    ffd_files_free(&files->writes);
    ffd_files_free(&files->reads);
    ffd_files_free(&files->copies);
    for (size_t i = 0; i < files->copied_count; i++)
        ffd_free(files->copied[i].source);
    for (size_t i = 0; i < PLACES_KEPT; i++)
        ffd_free(files->kept[i].path);
    ffd_free(files->copied);
    ffd_intern_free(&files->folders.exact);
    ffd_intern_free(&files->folders.known);
    ffd_free(files->folders.last);
    ffd_free(files->folders.asked);
    ffd_free(files->scan.input);
    ffd_paths_free(&files->scan.named);
    ffd_paths_free(&files->scan.copies);
    free_lattices(&files->lattices);
    ffd_users_free(&files->users);
    ffd_intern_free(&files->surveyed.places);
    ffd_free(files->surveyed.states);
    ffd_places_free(&files->places);
    *files = (run_files){0};
}
