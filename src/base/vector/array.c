/* array.c - selects the array kernels of an instruction set. */
#include "base/vector/array_kernel.h"

const array_kernel *ffd_array_kernel(ffd_isa isa)
{
    static const array_kernel *const kernels[] = {
        [FFD_ISA_SCALAR] = &ffd_array_kernel_scalar,
#ifdef FFD_X86
        [FFD_ISA_SSE2] = &ffd_array_kernel_sse2,
        [FFD_ISA_AVX2] = &ffd_array_kernel_avx2,
        [FFD_ISA_AVX512] = &ffd_array_kernel_avx512,
#endif
    };
    return kernels[ffd_isa_resolve(isa)];
}
