/* fuzz_ply.c - the fuzz target of PLY files. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_PLY, data, size);
    return 0;
}
