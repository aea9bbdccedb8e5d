/* foam_files.c - the files beside the points. Their names are always the same, so that links among them are
   followed as that to the points is: cases often share all but these. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/foam/foam_mesh.h"
#include <stdio.h>
#include <string.h>

#define LONGEST_NAME 16

static const char *const names[FOAM_SIDES] = {
    [FOAM_FACES] = "faces",
    [FOAM_OWNER] = "owner",
    [FOAM_NEIGHBOUR] = "neighbour",
    [FOAM_BOUNDARY] = "boundary",
    [FOAM_POINT_ZONES] = "pointZones",
    [FOAM_FACE_ZONES] = "faceZones",
    [FOAM_CELL_ZONES] = "cellZones",
};

/* Loads a file that is there, in memory or in the folder. */
static ffd_status load(const foam_document *d, const char *name, const char *path, file_input *input,
                       ffd_error *error)
{
    const file_folder *const folder = &d->volume.file.base.folder;
    size_t most = 0;
    return folder->resolve ? ffd_folder_load(folder, name, path, &most, input, error)
                           : ffd_file_load(path, input, error);
}

static ffd_status take_side(foam_reader *r, const char *path, const file_input *input,
                            foam_take_function *take)
{
    foam_file file = {.name = path, .error = r->error};
    TRY(ffd_foam_begin(&file, input->data, input->size));
    return take(r, &file);
}

ffd_status ffd_foam_read_side(foam_reader *r, foam_side side, foam_take_function *take)
{
    const file_document *const d = &r->d->volume.file;
    file_input input = {0};
    if (!d->path || !ffd_folder_has(&d->base.folder, names[side]))
        return FFD_OK;
    char *const path = ffd_path_sibling(d->path, names[side]);
    if (!path)
        return ffd_fail_memory(r->error);
    ffd_status status;
    TRY_END(load(r->d, names[side], path, &input, r->error));
    ffd_budget_add_file(&r->d->volume.file.base.budget, input.size, 0);
    r->d->is_there[side] = true;
    TRY_END(take_side(r, path, &input, take));
end:
    ffd_file_unload(&input);
    ffd_free(path);
    return status;
}

static ffd_status add_sibling(const char *path, foam_side side, path_list *files, ffd_error *error)
{
    char *const sibling = ffd_path_sibling(path, names[side]);
    const ffd_status status = sibling ? ffd_paths_add(files, sibling, error) : ffd_fail_memory(error);
    ffd_free(sibling);
    return status;
}

ffd_status ffd_foam_list_files(const mesh_document *document, path_list *files, ffd_error *error)
{
    const foam_document *const d = (const foam_document *)document;
    for (size_t s = 0; s < FOAM_SIDES; s++)
        if (d->is_there[s])
            TRY(add_sibling(d->volume.file.path, (foam_side)s, files, error));
    return FFD_OK;
}

ffd_status ffd_foam_list_images(const mesh_document *document, path_list *files, ffd_error *error)
{
    (void)document; /* has none */
    (void)files;
    (void)error;
    return FFD_OK;
}

ffd_status ffd_foam_find_named(const char *path, const file_input *bytes, const mesh_named *named,
                               ffd_error *error)
{
    (void)bytes; /* name no files */
    for (size_t s = 0; s < FOAM_SIDES && named->files; s++)
        TRY(add_sibling(path, (foam_side)s, named->files, error));
    return FFD_OK;
}

/* Whether a file is there that is compressed. */
static bool is_packed(const foam_document *d, foam_side side)
{
    char name[LONGEST_NAME + 4];
    snprintf(name, sizeof name, "%s.gz", names[side]);
    return d->volume.file.path && ffd_folder_has(&d->volume.file.base.folder, name);
}

ffd_status ffd_foam_note_missing(foam_reader *r)
{
    foam_document *const d = r->d;
    file_document *const file = &d->volume.file;
    if (!d->volume.lacks_cells)
        return FFD_OK;
    const foam_side missing = !d->is_there[FOAM_FACES]   ? FOAM_FACES
                              : !d->is_there[FOAM_OWNER] ? FOAM_OWNER
                                                         : FOAM_NEIGHBOUR;
    return ffd_flaw_line(
        &file->base.flaws, file->name, 0, r->error, "the file %s is not beside it%s: the mesh is taken as %s",
        names[missing],
        is_packed(d, missing) ? " (only compressed, which is not read: unpack it with gunzip)" : "",
        d->volume.has_outer ? "its points and outer faces, without cells"
                            : "its points alone, without faces and cells");
}
