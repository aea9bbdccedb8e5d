/* fuzz_gltf.c - the fuzz target of glTF as JSON text. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_GLTF, data, size);
    return 0;
}
