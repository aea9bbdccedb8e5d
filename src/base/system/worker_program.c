#include "base/system/worker_program.h"
#include "base/posix.h"
#include <stdio.h>
#include <string.h>

#ifdef _WIN32
#define PROGRAM "ffd.exe"
#define BETWEEN ";" /* folders in PATH */
#else
#define PROGRAM "ffd"
#define BETWEEN ":"
#endif

/* Absolute, or relative to the folder of the library. */
static const char *const folders[] = {FFD_PROGRAM_FOLDERS};

static bool is_program(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && access(path, X_OK) == 0;
}

static bool is_absolute(const char *folder)
{
#ifdef _WIN32
    if (folder[0] && folder[1] == ':')
        return true;
#endif
    return *folder == '/';
}

/* Relative folders of PATH do not count: the process may have changed its own. */
static bool find_in_path(char path[LONGEST_PATH])
{
    const char *folder = getenv("PATH");
    for (size_t length; folder; folder = folder[length] ? folder + length + 1 : NULL) {
        length = strcspn(folder, BETWEEN);
        if (is_absolute(folder) &&
            snprintf(path, LONGEST_PATH, "%.*s/" PROGRAM, (int)length, folder) < LONGEST_PATH &&
            is_program(path))
            return true;
    }
    return false;
}

ffd_status ffd_worker_program_find(char path[LONGEST_PATH], ffd_error *error)
{
    bool is_known;
    if (ffd_find_near(folders, sizeof folders / sizeof *folders, PROGRAM, path, &is_known) &&
        is_program(path))
        return FFD_OK;
    return find_in_path(path) ? FFD_OK
                              : ffd_fail(error, FFD_E_UNSUPPORTED,
                                         "the program \"" PROGRAM
                                         "\", whose processes do the jobs of a batch, is neither near "
                                         "the library nor in PATH");
}
