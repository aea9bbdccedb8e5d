#include "batch/job_scan.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "batch/files/scan.h"
#include "io/formats.h"
#include "io/users.h"
#include "job/input/source.h"

/* Adds a mesh that the box of a lattice goes round, and its files. */
static ffd_status scan_box_mesh(byte_buffer *found, const char *path, ffd_error *error)
{
    const ffd_source source = {.path = path};
    path_list named = {0};
    ffd_scan_add(found, SCAN_BOX, path);
    const ffd_status status = ffd_hash_cache_list_named(&source, &named, error);
    ffd_scan_add_all(found, SCAN_BOX, &named);
    ffd_paths_free(&named);
    return status;
}

/* Adds the lattices of a job, and the files of the meshes that their boxes go round. *has_boxes: there are
   some. */
static ffd_status scan_lattices(hash_cache *hashes, byte_buffer *found, const ffd_deform_desc *desc,
                                bool *has_boxes, ffd_error *error)
{
    path_list meshes = {0};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < desc->lattice_count; i++) {
        ffd_scan_add(found, SCAN_LATTICE, desc->lattices[i].path);
        TRY_END(ffd_hash_cache_box_meshes(hashes, desc->lattices[i].path, &meshes, error));
        *has_boxes = *has_boxes || meshes.count > 0;
        for (size_t m = 0; m < meshes.count; m++)
            TRY_END(scan_box_mesh(found, meshes.paths[m], error));
        ffd_paths_free(&meshes);
    }
end:
    ffd_paths_free(&meshes);
    return status;
}

ffd_format ffd_job_output_format(const ffd_deform_desc *desc)
{
    ffd_format format = desc->output_format;
    if (desc->in_place && ffd_source_format(&desc->input, &format, NULL))
        return FFD_FORMAT_AUTO;
    return format == FFD_FORMAT_AUTO && desc->output ? ffd_format_from_name(desc->output) : format;
}

/* Adds the models of the output's folder, with the files that they name. */
static ffd_status survey(byte_buffer *found, const ffd_deform_desc *desc, ffd_error *error)
{
    const char *const output = desc->in_place ? desc->input.path : desc->output;
    char *const folder = ffd_path_folder(output);
    path_list pairs = {0};
    ffd_status status;
    TRY_END(folder ? ffd_users_list(folder, &pairs, error) : ffd_fail_memory(error));
    ffd_scan_add(found, SCAN_FOLDER, folder);
    for (size_t i = 0; i + 1 < pairs.count; i += 2) {
        ffd_scan_add(found, SCAN_MODEL, pairs.paths[i]);
        ffd_scan_add(found, SCAN_BUFFER, pairs.paths[i + 1]);
    }
end:
    ffd_paths_free(&pairs);
    ffd_free(folder);
    return status;
}

/* Adds the files that the mesh names. *sidecars: the number of those beside the output. */
static ffd_status scan_mesh(hash_cache *hashes, byte_buffer *found, const ffd_deform_desc *desc,
                            size_t *sidecars, ffd_error *error)
{
    path_list named = {0}, copies = {0};
    ffd_status status;
    TRY_END(ffd_hash_cache_scan(hashes, &desc->input, ffd_job_output_format(desc), sidecars, &named, &copies,
                                error));
    ffd_scan_add_all(found, SCAN_NAMED, &named);
    ffd_scan_add_all(found, SCAN_COPY, &copies);
end:
    ffd_paths_free(&named);
    ffd_paths_free(&copies);
    return status == FFD_E_MEMORY ? status : FFD_OK;
}

ffd_status ffd_job_scan(hash_cache *hashes, const wire_task *task, const ffd_deform_desc *desc,
                        byte_buffer *found, wire_answer *answer, ffd_error *error)
{
    size_t sidecars = 0;
    bool has_boxes = false;
    ffd_status status = FFD_OK;
    answer->scanned = false;
    if (task->order.needs.mesh)
        TRY_END(scan_mesh(hashes, found, desc, &sidecars, error));
    const bool has_names = found->size > 0;
    if (task->order.needs.lattices)
        TRY_END(scan_lattices(hashes, found, desc, &has_boxes, error));
    if (task->order.surveys)
        TRY_END(survey(found, desc, error));
    answer->scanned = sidecars > 0 || has_names || has_boxes || task->order.only_scans || task->order.surveys;
end:
    answer->end.sidecars = sidecars;
    if (!answer->scanned)
        found->size = 0;
    return status;
}
