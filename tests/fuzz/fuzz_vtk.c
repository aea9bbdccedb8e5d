/* fuzz_vtk.c - the fuzz target of VTK files of the legacy format. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_VTK, data, size);
    return 0;
}
