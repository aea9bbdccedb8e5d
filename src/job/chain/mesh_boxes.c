#include "job/chain/mesh_boxes.h"
#include "base/memory/memory.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"
#include <string.h>

static void free_box(mesh_box *box)
{
    ffd_paths_free(&box->meshes);
    ffd_paths_free(&box->files);
    ffd_paths_free(&box->warnings);
    ffd_free(box->stamps);
    *box = (mesh_box){0};
}

static ffd_status list_meshes(const ffd_lattice *lattice, path_list *meshes, ffd_error *error)
{
    for (size_t i = 0; i < ffd_lattice_get_mesh_count(lattice); i++) {
        char *path;
        TRY(ffd_lattice_get_mesh(lattice, i, &path, error));
        const ffd_status status = ffd_paths_add(meshes, path, error);
        ffd_free(path);
        TRY(status);
    }
    return FFD_OK;
}

static bool is_same(const path_list *a, const path_list *b)
{
    if (a->count != b->count)
        return false;
    for (size_t i = 0; i < a->count; i++)
        if (strcmp(a->paths[i], b->paths[i]) != 0)
            return false;
    return true;
}

static const mesh_box *find(const mesh_boxes *kept, const path_list *meshes, const ffd_source *like)
{
    const hash128 rules = ffd_source_rules(like);
    for (size_t i = 0; i < MESH_BOXES; i++) {
        const mesh_box *const box = &kept->boxes[i];
        if (box->files.count > 0 && box->space == like->space && ffd_hash_equal(&box->rules, &rules) &&
            is_same(&box->meshes, meshes) && ffd_stamps_hold(box->files.paths, box->stamps, box->files.count))
            return box;
    }
    return NULL;
}

/* Collects a warning, to be repeated for later jobs that find the box in the cache. */
static void keep_line(void *user, ffd_log_level level, const char *line)
{
    (void)level; /* all lines are warnings */
    ffd_paths_add(user, line, NULL);
}

/* The stamp of the mesh file is taken before it is read, those of the files that it refers to right after. */
static ffd_status add_mesh(mesh_box *box, const char *path, const ffd_source *like, shown_box *shown,
                           ffd_error *error)
{
    static const file_stamp none = {0};
    const mesh_log log = {keep_line, &box->warnings};
    ffd_source source = *like;
    file_stamp stamp;
    source.path = path;
    source.format = FFD_FORMAT_AUTO;
    source.bytes = (ffd_bytes){0};
    source.resolve = NULL;
    if (!ffd_file_stamp(path, &stamp))
        stamp = none;
    TRY(ffd_shown_box_add(shown, &source, NULL, 0, &box->files, &log, error));
    if (!ffd_grow((void **)&box->stamps, &box->stamp_capacity, box->files.count, sizeof *box->stamps))
        return ffd_fail_memory(error);
    for (size_t first = box->stamp_count; box->stamp_count < box->files.count; box->stamp_count++) {
        file_stamp *const own = &box->stamps[box->stamp_count];
        *own = stamp;
        if (box->stamp_count > first && !ffd_file_stamp(box->files.paths[box->stamp_count], own))
            *own = none;
    }
    return FFD_OK;
}

/* Measures the meshes of a box. */
static ffd_status measure(mesh_box *box, const ffd_source *like, ffd_error *error)
{
    shown_box shown;
    ffd_shown_box_clear(&shown);
    box->space = like->space;
    box->rules = ffd_source_rules(like);
    for (size_t i = 0; i < box->meshes.count; i++)
        TRY(add_mesh(box, box->meshes.paths[i], like, &shown, error));
    box->extent = ffd_shown_box_extent(&shown);
    return FFD_OK;
}

static ffd_status copy(const mesh_box *box, fit_extent *extent, path_list *files, const mesh_log *log,
                       ffd_error *error)
{
    *extent = box->extent;
    for (size_t i = 0; i < box->warnings.count; i++)
        ffd_log_line(log, FFD_LOG_WARNING, "%s", box->warnings.paths[i]);
    for (size_t i = 0; i < box->files.count; i++)
        TRY(ffd_paths_add(files, box->files.paths[i], error));
    return FFD_OK;
}

ffd_status ffd_mesh_box_find(mesh_boxes *kept, const ffd_lattice *lattice, const ffd_source *like,
                             fit_extent *extent, path_list *files, const mesh_log *log, ffd_error *error)
{
    mesh_box made = {0};
    ffd_status status;
    TRY_END(list_meshes(lattice, &made.meshes, error));
    const mesh_box *const known = find(kept, &made.meshes, like);
    if (known) {
        free_box(&made);
        return copy(known, extent, files, log, error);
    }
    TRY_END(measure(&made, like, error));
    TRY_END(copy(&made, extent, files, log, error));
    free_box(&kept->boxes[kept->next]);
    kept->boxes[kept->next] = made;
    kept->next = (kept->next + 1) % MESH_BOXES;
    return FFD_OK;
end:
    free_box(&made);
    return status;
}

void ffd_mesh_boxes_free(mesh_boxes *kept)
{
    for (size_t i = 0; i < MESH_BOXES; i++)
        free_box(&kept->boxes[i]);
}
