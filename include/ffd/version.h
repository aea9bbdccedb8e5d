/* version.h - the version of the library. meson.build reads it from here. */
#ifndef FFD_VERSION_H
#define FFD_VERSION_H

#include <ffd/export.h>

#define FFD_VERSION_MAJOR 0
#define FFD_VERSION_MINOR 3
#define FFD_VERSION_PATCH 0
#define FFD_VERSION "0.3.0"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the version of the loaded library, "MAJOR.MINOR.PATCH"; FFD_VERSION is the version of the headers.
   The string is static. Thread-safe. */
FFD_API const char *ffd_version(void);

#ifdef __cplusplus
}
#endif

#endif
