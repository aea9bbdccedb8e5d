/* fuzz_stl.c - the fuzz target of STL files. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_STL, data, size);
    return 0;
}
