#include "batch/run_view.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/memory/memory.h"
#include "batch/index_entry.h"
#include "batch/manifest/settings.h"
#include "view/index.h"
#include <inttypes.h>
#include <string.h>

struct run_view {
    run_view_desc desc;
    char *page;          /* path of the page */
    char *resolved;      /* the folder with links resolved; as given if it does not exist (dry run) */
    file_output *output; /* of the page; NULL: dry run */
    view_index index;
};

char *ffd_run_view_page_of(const char *folder, uint64_t shard, uint64_t shards)
{
    byte_buffer name = {0};
    if (shards > 1)
        ffd_buffer_format(&name, "index-%" PRIu64 "-of-%" PRIu64 ".html", shard, shards);
    else
        ffd_buffer_text(&name, "index.html");
    char *const text = ffd_buffer_finish(&name);
    char *const path = text ? ffd_path_join(folder, text) : NULL;
    ffd_free(text);
    return path;
}

static ffd_status begin_page(run_view *view, ffd_error *error)
{
    const run_view_desc *const desc = &view->desc;
    TRY(ffd_output_create(&view->output, error));
    TRY(ffd_output_folder(view->output, desc->folder, error));
    TRY(ffd_output_begin(view->output, view->page, desc->force, error));
    return ffd_index_begin(&view->index, desc->name, view->output, error);
}

static ffd_status open_view(run_view *view, ffd_error *error)
{
    const run_view_desc *const desc = &view->desc;
    view->page = ffd_run_view_page_of(desc->folder, desc->shard, desc->shards);
    if (!view->page)
        return ffd_fail_memory(error);
    if (!desc->dry)
        TRY(begin_page(view, error));
    else
        TRY(ffd_output_check_with_folder(view->page, desc->force, error));
    view->resolved = ffd_path_resolve(desc->folder);
    if (!view->resolved)
        view->resolved = ffd_text_copy(desc->folder);
    return view->resolved ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_run_view_create(const run_view_desc *desc, run_view **view, ffd_error *error)
{
    *view = ffd_alloc_zero(1, sizeof **view);
    if (!*view)
        return ffd_fail_memory(error);
    (*view)->desc = *desc;
    const ffd_status status = open_view(*view, error);
    if (status)
        ffd_run_view_destroy(view);
    return status;
}

const char *ffd_run_view_page(const run_view *view)
{
    return view->page;
}

/* Returns the part of an output's path below the folder of outputs. */
static const char *below(const char *out_dir, const char *output)
{
    size_t length = out_dir ? strlen(out_dir) : 0;
    while (length > 1 && out_dir[length - 1] == '/')
        length--;
    if (!length || strncmp(output, out_dir, length) != 0 || output[length] != '/')
        return output;
    return output + length;
}

/* Returns the name of a job below the folder, with an ending; freed by the caller. NULL: out of memory. */
static char *name_job(const char *out_dir, const batch_job *job, const char *ending)
{
    byte_buffer name = {0};
    char *const plain = job->output ? ffd_path_normalize(below(out_dir, job->output)) : NULL;
    const char *start = plain;
    while (start && (*start == '/' || ffd_path_leads_out(start)))
        start += *start == '/' ? 1 : 2;
    if (job->output)
        ffd_buffer_text(&name, start ? start : "");
    else /* of a row of positions */
        ffd_buffer_format(&name, "row-%" PRIu64, job->row);
    ffd_buffer_text(&name, ending);
    char *const text = plain || !job->output ? ffd_buffer_finish(&name) : NULL;
    ffd_buffer_free(&name);
    ffd_free(plain);
    return text;
}

/* *path, *file: as of ffd_run_view_name. *name: the part of the path below the folder. */
static ffd_status name_file(const run_view *view, const batch_job *job, const char *ending, char **path,
                            const char **name, hash128 *file, ffd_error *error)
{
    char *const below_folder = name_job(view->desc.out_dir, job, ending);
    char *const whole = below_folder ? ffd_path_join(view->resolved, below_folder) : NULL;
    *path = below_folder ? ffd_path_join(view->desc.folder, below_folder) : NULL;
    if (whole) /* same identity whether or not folders below exist yet */
        *file = ffd_place_of(NULL, whole);
    if (*path)
        *name = *path + strlen(*path) - strlen(below_folder);
    const bool is_named = whole && *path;
    ffd_free(below_folder);
    ffd_free(whole);
    return is_named ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_run_view_name(const run_view *view, pool_task *task, hash128 files[2], ffd_error *error)
{
    const char *name;
    TRY(name_file(view, &task->job, ".png", &task->picture, &task->picture_name, &files[0], error));
    return view->desc.pages ? name_file(view, &task->job, ".html", &task->page, &name, &files[1], error)
                            : FFD_OK;
}

/* Returns why a job has failed, here or in its worker. */
static ffd_error failure_of(const pool_task *task)
{
    ffd_job_result result;
    if (task->failure.status || task->result.size < sizeof result)
        return task->failure;
    memcpy(&result, task->result.data, sizeof result);
    return result.error;
}

ffd_status ffd_run_view_add(run_view *view, const pool_task *task, const byte_buffer *text, ffd_error *error)
{
    index_entry entry;
    byte_buffer settings = {0};
    if (!view->output)
        return FFD_OK;
    TRY(ffd_index_entry_read(text, &entry, error));
    ffd_settings_show(&task->job.desc, &settings);
    char *const shown = ffd_buffer_finish(&settings);
    const ffd_error failure = failure_of(task);
    entry.row.line = task->job.line;
    entry.row.pointer = failure.pointer;
    entry.row.settings = shown;
    entry.row.picture = task->end.has_picture ? task->picture_name : NULL;
    entry.row.page =
        task->end.has_picture && task->page ? task->page + (task->picture_name - task->picture) : NULL;
    if (task->end.has_picture && task->own_frame)
        entry.row.frame = strcmp(task->own_frame, "far") == 0 ? "it lies far away" : "other options";
    ffd_status status = shown ? ffd_index_add(&view->index, &entry.row, error) : ffd_fail_memory(error);
    ffd_free(shown);
    ffd_index_entry_free(&entry);
    return status;
}

ffd_status ffd_run_view_write(run_view *view, ffd_error *error)
{
    if (!view->output)
        return FFD_OK;
    TRY(ffd_index_end(&view->index, error));
    return ffd_output_commit(view->output, error);
}

void ffd_run_view_destroy(run_view **view)
{
    if (!view || !*view)
        return;
    ffd_output_destroy(&(*view)->output);
    ffd_index_free(&(*view)->index);
    ffd_free((*view)->page);
    ffd_free((*view)->resolved);
    ffd_free(*view);
    *view = NULL;
}
