#include "io/format_names.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include <string.h>

/* What programs for Gaussian splats write beside PLY. */
static bool is_of_splats(const char *path)
{
    static const char *const endings[] = {".splat", ".ksplat", ".spz", ".sog"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (ffd_path_has_ending(path, endings[i]))
            return true;
    return false;
}

ffd_status ffd_format_refuse_name(const char *path, ffd_error *error)
{
    const char *const ending = ffd_path_ending(path);
    if (strcmp(path, "-") == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "standard input needs {input.format} " FFD_FORMAT_NAMES);
    if (is_of_splats(path))
        return ffd_fail_file(
            error, FFD_E_ARGUMENT, path,
            "\"%s\" is a form of Gaussian splats that is not supported: they are read and written as "
            "uncompressed ply",
            ending);
    if (ffd_folder_is_there(path))
        return ffd_fail_file(error, FFD_E_ARGUMENT, path, "is a folder: name its meshes, such as %.*s/*.obj",
                             (int)(strlen(path) - ffd_is_separator(path[strlen(path) - 1])), path);
    return ffd_fail_file(error, FFD_E_ARGUMENT, path,
                         "the ending \"%s\" is not that of a mesh format (" FFD_FORMAT_NAMES ")", ending);
}

ffd_status ffd_format_check_name(const char *name, ffd_error *error)
{
    return ffd_format_from_name(name) != FFD_FORMAT_AUTO ? FFD_OK : ffd_format_refuse_name(name, error);
}
