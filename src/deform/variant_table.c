/* variant_table.c - selects the kernel for many variants. */
#include "deform/variant_kernel.h"

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = &ffd_variant_kernel_##set,

const variant_kernel *ffd_variant_kernel(ffd_isa isa)
{
    static const variant_kernel *const kernels[] = {[FFD_ISA_SCALAR] = &ffd_variant_kernel_scalar,
                                                    FOR_EACH_SIMD(ROW)};
    return kernels[ffd_isa_resolve(isa)];
}
