#include <ffd/version.h>

const char *ffd_version(void)
{
    return FFD_VERSION;
}
