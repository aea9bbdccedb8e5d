/* info.c - the job of `ffd info`. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "job/info_lattice.h"
#include "job/info_mesh.h"
#include "job/info_text.h"
#include "job/input/source.h"

static ffd_status write_facts(const ffd_source *file, byte_buffer *out, ffd_error *error)
{
    const bool lattice = file->format == FFD_FORMAT_AUTO && ffd_path_has_ending(file->path, ".json");
    json_text json;
    ffd_json_begin(&json, out);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "format", "ffd-info");
    ffd_json_count(&json, "version", 1);
    ffd_json_string(&json, "file", file->path);
    ffd_json_string(&json, "kind", lattice ? "lattice" : "mesh");
    const ffd_status status =
        lattice ? ffd_info_lattice(file->path, &json, error) : ffd_info_mesh(file, &json, error);
    if (status != FFD_OK)
        return status;
    ffd_json_end(&json, '}');
    return out->failed ? ffd_fail_memory(error) : FFD_OK;
}

ffd_status ffd_info_run(const ffd_source *file, bool json, char **text, ffd_error *error)
{
    byte_buffer facts = {0};
    *text = NULL;
    ffd_status status = write_facts(file, &facts, error);
    if (status == FFD_OK && !json)
        status = ffd_info_render(facts.data, facts.size, text, error);
    else if (status == FFD_OK) {
        *text = ffd_buffer_finish(&facts);
        status = *text ? FFD_OK : ffd_fail_memory(error);
    }
    if (status != FFD_OK && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(file));
    ffd_buffer_free(&facts);
    return status;
}

void ffd_text_free(char *text)
{
    ffd_free(text);
}
