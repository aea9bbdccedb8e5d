/* array.c - selects the array kernels of an instruction set. */
#include "base/vector/array_kernel.h"

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = &ffd_array_kernel_##set,
const array_kernel *ffd_array_kernel(ffd_isa isa)
{
    static const array_kernel *const kernels[] = {[FFD_ISA_SCALAR] = &ffd_array_kernel_scalar,
                                                  FOR_EACH_SIMD(ROW)};
    return kernels[ffd_isa_resolve(isa)];
}
