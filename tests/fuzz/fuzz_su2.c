/* fuzz_su2.c - the fuzz target of SU2 meshes. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_SU2, data, size);
    return 0;
}
