#include "lattice/file/box_meshes.h"
#include "base/memory/memory.h"
#include "lattice/file/spec_parse.h"
#include <string.h>

/* Whether the text may contain the member "meshes", possibly with escapes. */
static bool may_name_meshes(const file_input *input)
{
    static const char key[] = "\"meshes\"";
    const char *at = (const char *)input->data, *const end = at + input->size;
    for (; at < end; at++) {
        if (*at == '\\')
            return true;
        if (*at == '"' && (size_t)(end - at) >= sizeof key - 1 && memcmp(at, key, sizeof key - 1) == 0)
            return true;
    }
    return false;
}

static ffd_status add_mesh(const lattice_spec *spec, size_t i, path_list *meshes, ffd_error *error)
{
    char *mesh;
    TRY(ffd_spec_mesh(spec, i, &mesh, error));
    const ffd_status status = ffd_paths_add(meshes, mesh, error);
    ffd_free(mesh);
    return status;
}

ffd_status ffd_lattice_box_meshes(const char *path, const file_input *bytes, path_list *meshes,
                                  ffd_error *error)
{
    const spec_settings rest_only = {.may_be_open = true};
    lattice_spec *spec = NULL;
    size_t size;
    if (!may_name_meshes(bytes) ||
        ffd_spec_load(&(ffd_lattice_source){.path = path}, &rest_only, &spec, &size, NULL))
        return FFD_OK;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < spec->mesh_count; i++)
        TRY_END(add_mesh(spec, i, meshes, error));
end:
    ffd_spec_free(spec);
    return status;
}
