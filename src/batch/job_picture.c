#include "batch/job_picture.h"
#include "base/fail.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "job/chain/job_cache.h"
#include "job/figures/figure_values.h"
#include "job/input/source.h"

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

ffd_status ffd_job_picture_write(const char *path, const ffd_deform_desc *desc, const ffd_view_desc *look,
                                 bool force, ffd_job_result *result)
{
    ffd_deform_desc job = *desc;
    ffd_view_desc view = *look;
    char *folder;
    size_t made;
    job.output_list = NULL; /* the outputs are those of the job itself */
    job.cache = NULL;       /* draw the mesh at rest; a mesh of the cache may have results */
    view.job = &job;
    view.output = path;
    view.force = force;
    ffd_result_clear(result);
    ffd_status status;
    TRY_END(make_folder(path, &folder, &made, &result->error));
    TRY_END(ffd_view_run(&view, result, NULL));
end:
    if (status && !result->picture && folder)
        ffd_folder_unmake(folder, made);
    ffd_free(folder);
    return result->status = status;
}
