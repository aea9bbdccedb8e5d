/* fuzz_vtp.c - the fuzz target of VTK files in XML, of polygonal data. */
#include "fuzz_mesh.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_mesh(FFD_FORMAT_VTP, data, size);
    return 0;
}
