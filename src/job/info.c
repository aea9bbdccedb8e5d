/* info.c - the job of `ffd info`. */
#include "job/info.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/source.h"
#include <string.h>

void ffd_info_desc_init(ffd_info_desc *desc, size_t size)
{
    const ffd_info_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* Refuses options that do not apply to this kind of file. */
static ffd_status check_desc(const ffd_info_desc *desc, bool lattice, ffd_error *error)
{
    if (!desc->file.path)
        return ffd_fail(error, FFD_E_ARGUMENT, "the description is not complete: it names no file");
    if (!ffd_desc_has_settings(desc->set, desc->set_count))
        return ffd_fail(error, FFD_E_ARGUMENT, "the description is not complete: a setting is NULL");
    if (lattice && desc->parts)
        return ffd_fail_file(error, FFD_E_ARGUMENT, ffd_source_name(&desc->file),
                             "a lattice has no parts ({parts} is for meshes)");
    if (!lattice && desc->set_count > 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, ffd_source_name(&desc->file),
                             "a mesh has no placeholders ({set} is for lattices)");
    return FFD_OK;
}

static ffd_status write_facts(const ffd_info_desc *desc, byte_buffer *out, ffd_error *error)
{
    const ffd_source *const file = &desc->file;
    const bool lattice =
        file->path && file->format == FFD_FORMAT_AUTO && ffd_path_has_ending(file->path, ".json");
    json_text json;
    const ffd_status wrong = check_desc(desc, lattice, error);
    if (wrong)
        return wrong;
    ffd_json_begin(&json, out);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "format", "ffd-info");
    ffd_json_count(&json, "version", 1);
    ffd_json_string(&json, "file", file->path);
    ffd_json_string(&json, "kind", lattice ? "lattice" : "mesh");
    const ffd_status status =
        lattice ? ffd_info_lattice(desc, &json, error) : ffd_info_mesh(desc, &json, error);
    if (status != FFD_OK)
        return status;
    ffd_json_end(&json, '}');
    return out->failed ? ffd_fail_memory(error) : FFD_OK;
}

ffd_status ffd_info_run(const ffd_info_desc *callers, char **text, ffd_error *error)
{
    ffd_info_desc own;
    const ffd_info_desc *const desc = &own;
    byte_buffer facts = {0};
    const unsigned losses = ffd_mapping_losses();
    *text = NULL;
    ffd_info_desc_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, callers, "ffd_info_desc", error));
    job_memory memory = {0};
    ffd_status status;
    TRY_END(ffd_in_memory_source(&memory, &own.file, error));
    TRY_END(ffd_mapping_judge(losses, write_facts(desc, &facts, error), error));
    if (desc->json) {
        *text = ffd_buffer_finish(&facts);
        TRY_END(*text ? FFD_OK : ffd_fail_memory(error));
    } else {
        TRY_END(ffd_info_render(facts.data, facts.size, text, error));
    }
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(&desc->file));
    status = ffd_in_memory_end(&memory, status, error);
    ffd_buffer_free(&facts);
    return status;
}
