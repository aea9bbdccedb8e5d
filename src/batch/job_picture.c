#include "batch/job_picture.h"
#include "base/fail.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "batch/hash_cache.h"
#include "job/chain/job_cache.h"
#include "job/figures/figure_values.h"
#include "job/input/source.h"
#include "job/view/view_run.h"

/* Mesh files of at least this many bytes take too much memory to be kept while drawing. */
#define LARGE ((uint64_t)1 << 22)

ffd_status ffd_job_picture_check(const char *path, bool force, ffd_error *error)
{
    return ffd_output_check_with_folder(path, force, error);
}

static bool is_older(const file_stamp *a, const file_stamp *b)
{
    return a->written[0] != b->written[0] ? a->written[0] < b->written[0] : a->written[1] < b->written[1];
}

bool ffd_job_picture_is_current(const char *path, const char *output)
{
    file_stamp picture, mesh;
    return ffd_file_stamp(path, &picture) && ffd_file_stamp(output, &mesh) && !is_older(&picture, &mesh);
}

void ffd_job_picture_drop_mesh(const ffd_deform_desc *desc)
{
    file_stamp stamp;
    if (!desc->cache || !ffd_file_stamp(desc->input.path, &stamp) || stamp.size < LARGE)
        return;
    mesh_document *mesh = ffd_job_cache_take_mesh(desc->cache, desc, false);
    ffd_source_close(&mesh);
}

/* Makes the folder of the picture. *folder: freed with ffd_free. *made: the number of folders made. */
static ffd_status make_folder(const char *path, char **folder, size_t *made, ffd_error *error)
{
    *made = 0;
    *folder = ffd_path_folder(path);
    return *folder ? ffd_folder_make(*folder, made, error) : ffd_fail_memory(error);
}

/* Runs a view of the job. output: the picture or the page. */
static ffd_status run_view(const job_picture *picture, const char *output, const view_frames *frames,
                           ffd_job_result *result)
{
    ffd_deform_desc job = *picture->job;
    ffd_view_desc view = *picture->look;
    job.output_list = NULL; /* the outputs are those of the job itself */
    job.cache = NULL;       /* draw the mesh at rest; a mesh of the cache may have results */
    view.job = &job;
    view.output = output;
    view.force = picture->force;
    ffd_result_clear(result);
    return ffd_view_run_framed(&view, frames, result, NULL);
}

ffd_status ffd_job_picture_measure(const job_picture *picture, view_frame *frame, ffd_job_result *result)
{
    const view_frames frames = {.measured = frame};
    return run_view(picture, picture->path, &frames, result);
}

/* A page has no size in pixels and no frames, and its own way to show an animation. */
static ffd_status write_page(const job_picture *picture, ffd_job_result *result)
{
    const view_frames frames = {0};
    ffd_view_desc look = *picture->look;
    job_picture page = *picture;
    look.width = look.height = look.frames = 0;
    page.look = &look;
    return run_view(&page, picture->page, &frames, result);
}

static bool is_drawn(ffd_status status)
{
    return status == FFD_OK || status == FFD_E_GATE;
}

ffd_status ffd_job_picture_write(const job_picture *picture, ffd_job_result *result)
{
    const view_frames frames = {.frame = picture->frame};
    char *folder;
    size_t made;
    ffd_result_clear(result);
    ffd_status status;
    TRY_END(make_folder(picture->path, &folder, &made, &result->error));
    status = run_view(picture, picture->path, &frames, result);
    if (picture->page && is_drawn(status))
        status = write_page(picture, result);
end:
    if (!is_drawn(status) && folder)
        ffd_folder_unmake(folder, made);
    ffd_free(folder);
    return result->status = status;
}

ffd_status ffd_job_picture_hash(const char *path, const char *page, hash128 *hash, ffd_error *error)
{
    hash128 parts[2];
    TRY(ffd_hash_cache_hash(NULL, path, &parts[0], error));
    if (page)
        TRY(ffd_hash_cache_hash(NULL, page, &parts[1], error));
    *hash = page ? ffd_hash(parts, sizeof parts) : parts[0];
    return FFD_OK;
}
