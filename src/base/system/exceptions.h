/* exceptions.h - memory that C++ exceptions need (C++ behind C). */
#ifndef FFD_BASE_SYSTEM_EXCEPTIONS_H
#define FFD_BASE_SYSTEM_EXCEPTIONS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Gets the calling thread's memory for exceptions, where the C++ runtime came with a module. The C library
   gets it when it is first used, and ends the program if there is none: the first exception may be that
   memory has run out. */
void ffd_exceptions_prepare(void);

#ifdef __cplusplus
}
#endif

#endif
