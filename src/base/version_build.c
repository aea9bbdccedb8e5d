/* version_build.c - ffd_version_build (public: ffd/version.h). */
#include "base/build.h"
#include <ffd/version.h>

const char *ffd_version_build(void)
{
    return ffd_build_text;
}
