/* unversioned.c - the version alone, for tests: they are not linked anew for each commit. */
#include "base/build.h"
#include <ffd/version.h>

const char ffd_build_text[] = FFD_VERSION;
