/* isa.h - selects among the instruction sets that kernels are compiled for. */
#ifndef FFD_BASE_VECTOR_ISA_H
#define FFD_BASE_VECTOR_ISA_H

#include <ffd/isa.h>

/* FOR_EACH_SIMD(X) is X(ISA, NAME, LANES) for each instruction set with SIMD that this build has kernels for:
   declarations and tables follow from it. LANES: doubles in a register. */
#ifdef FFD_X86
#define FOR_EACH_SIMD(X) X(SSE2, sse2, 2) X(AVX2, avx2, 4) X(AVX512, avx512, 8)
#elif defined(FFD_ARM64)
#define FOR_EACH_SIMD(X) X(NEON, neon, 2)
#else
#define FOR_EACH_SIMD(X)
#endif

/* Returns the widest instruction set that is available; never FFD_ISA_AUTO. */
ffd_isa ffd_isa_best(void);

/* Returns the name of an instruction set as options take it, such as "avx2". */
const char *ffd_isa_name(ffd_isa isa);

/* Returns the best available instruction set for FFD_ISA_AUTO, and others unchanged. */
static inline ffd_isa ffd_isa_resolve(ffd_isa isa)
{
    return isa == FFD_ISA_AUTO ? ffd_isa_best() : isa;
}

#endif
