/* inline.h - functions that are to be one with their callers: only where it knows degrees and wishes can a
   compiler keep a kernel's sums in registers. */
#ifndef FFD_BASE_INLINE_H
#define FFD_BASE_INLINE_H

#define ALWAYS_INLINE inline __attribute__((always_inline))

#endif
