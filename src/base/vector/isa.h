/* isa.h - the instruction sets that kernels are compiled for, and which of them this processor has. */
#ifndef FFD_BASE_VECTOR_ISA_H
#define FFD_BASE_VECTOR_ISA_H

#include <ffd/isa.h>

/* The best of this processor. Never FFD_ISA_AUTO. */
ffd_isa ffd_isa_best(void);

/* Its name as options have it: "avx2". */
const char *ffd_isa_name(ffd_isa isa);

/* FFD_ISA_AUTO becomes the best available one; others are returned as they are. */
static inline ffd_isa ffd_isa_resolve(ffd_isa isa)
{
    return isa == FFD_ISA_AUTO ? ffd_isa_best() : isa;
}

#endif
