/* inline.h - functions that must be inlined: a compiler can keep a kernel's sums in registers only where it
   knows the degrees and what is asked for. */
#ifndef FFD_BASE_INLINE_H
#define FFD_BASE_INLINE_H

#define ALWAYS_INLINE inline __attribute__((always_inline))

#endif
