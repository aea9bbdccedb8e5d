/* fuzz_obj.c - the fuzz target of OBJ files, and of the names that they and material libraries give to files.
 */
#include "base/file/input.h"
#include "fuzz_mesh.h"
#include "fuzz_target.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_libraries.h"
#include "promise.h"
#include <string.h>

/* Names are never empty, and end within their file. */
static void check_names(intern_table *names, size_t size)
{
    for (uint32_t i = 0; i < names->count; i++) {
        const size_t length = strlen(ffd_intern_key(names, i));
        PROMISE(length > 0 && length <= size, "a name of %zu bytes in a file of %zu", length, size);
    }
    ffd_intern_free(names);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const file_input input = {.data = data, .size = size};
    intern_table libraries = {0}, maps = {0};
    fuzz_mesh(FFD_FORMAT_OBJ, data, size);
    ffd_obj_list_libraries(&input, &(file_folder){.file = "none/m.obj"}, &libraries, NULL);
    check_names(&libraries, size);
    if (ffd_mtl_has_content(data, size)) {
        ffd_mtl_list_maps(data, size, "m.mtl", &maps, NULL);
        fuzz_library(data, size);
    }
    check_names(&maps, size);
    return 0;
}
