/* inline.h - forces inlining. A compiler can keep the sums of a kernel in registers only if degrees and
   options are compile-time constants, so kernels are inlined into callers that pass constants. */
#ifndef FFD_BASE_INLINE_H
#define FFD_BASE_INLINE_H

#define ALWAYS_INLINE inline __attribute__((always_inline))

#endif
