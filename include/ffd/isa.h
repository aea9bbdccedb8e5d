/* isa.h - the instruction sets that the kernels are compiled for. */
#ifndef FFD_ISA_H
#define FFD_ISA_H

#include <ffd/export.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which instructions the kernels use. It changes the speed and never a byte of a result. */
typedef enum ffd_isa {
    FFD_ISA_AUTO,   /* the best that this processor has */
    FFD_ISA_SCALAR, /* one number at a time; every processor */
    FFD_ISA_SSE2,
    FFD_ISA_AVX2,
    FFD_ISA_AVX512 /* with its parts F, DQ and VL */
} ffd_isa;

/* Whether this build and this processor can run it. Thread-safe. */
FFD_API bool ffd_isa_available(ffd_isa isa);

#ifdef __cplusplus
}
#endif

#endif
