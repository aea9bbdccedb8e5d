/* tinygltf_load.c - the functions of gltf_model.h, by the module, which is loaded at the first parsing. */
#include "io/gltf/read/tinygltf_module.h"

ffd_status ffd_gltf_parse_model(const char *text, size_t size, const char *name, gltf_model *model,
                                ffd_error *error)
{
    static module tinygltf = {TINYGLTF_IDENTITY, "glTF", NULL};
    const module_head *head;
    const ffd_status status = ffd_module_load(&tinygltf, &head, error);
    if (status) {
        *model = (gltf_model){0};
        ffd_fail_name_file(error, name);
        return status;
    }
    return ((const tinygltf_module *)head)->parse_model(text, size, name, model, error);
}
