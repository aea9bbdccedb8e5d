/* fuzz_msh.c - the fuzz target of meshes of Gmsh. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_MSH, data, size);
    return 0;
}
