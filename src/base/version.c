/* version.c - the version that the library was built as. */
#include <ffd/version.h>

const char *ffd_version(void)
{
    return FFD_VERSION;
}
