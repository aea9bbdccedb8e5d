/* exceptions.h - reserves the memory that the first C++ exception of a thread needs (C++ behind a C
   interface). */
#ifndef FFD_BASE_SYSTEM_EXCEPTIONS_H
#define FFD_BASE_SYSTEM_EXCEPTIONS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Allocates the thread-local exception state of the calling thread, if the C++ runtime was loaded with a
   module. The C library allocates it at first use, and aborts the program if that fails; but the first
   exception may be std::bad_alloc. */
void ffd_exceptions_prepare(void);

#ifdef __cplusplus
}
#endif

#endif
