/* isa.h - the instruction sets that the kernels are compiled for. */
#ifndef FFD_ISA_H
#define FFD_ISA_H

#include <ffd/export.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The instruction set of the kernels. It affects the speed only: results are equal to the bit. */
typedef enum ffd_isa {
    FFD_ISA_AUTO,   /* the widest that is available */
    FFD_ISA_SCALAR, /* portable C without SIMD; always available */
    FFD_ISA_SSE2,
    FFD_ISA_AVX2,
    FFD_ISA_AVX512, /* needs AVX-512 F, DQ and VL */
    FFD_ISA_NEON    /* of arm64: every such processor has it */
} ffd_isa;

/* Returns whether this build has kernels for an instruction set and this processor supports it; false for an
   unknown value. Thread-safe. */
FFD_API bool ffd_isa_available(ffd_isa isa);

#ifdef __cplusplus
}
#endif

#endif
