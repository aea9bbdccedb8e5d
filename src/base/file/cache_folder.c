#include "base/file/cache_folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/posix.h"

char *ffd_cache_folder(void)
{
    const char *const caches = getenv("XDG_CACHE_HOME"), *const home = getenv("HOME"),
                      *const local = getenv("LOCALAPPDATA");
    if (caches && ffd_path_is_absolute(caches))
        return ffd_path_join(caches, "ffd");
    if (home && *home && ffd_file_exists(home))
        return ffd_path_join(home, ".cache/ffd");
    return local && *local ? ffd_path_join(local, "ffd") : NULL;
}

void ffd_cache_remove(const char *path)
{
    (void)unlink(path);
}
