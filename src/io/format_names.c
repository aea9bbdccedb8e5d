#include "io/format_names.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
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

ffd_status ffd_format_check_output(ffd_format format, const char *path, ffd_error *error)
{
    if (format != FFD_FORMAT_FOAM || strcmp(ffd_path_name(path), FOAM_NAME) == 0)
        return FFD_OK;
    if (strcmp(ffd_path_name(path), FOAM_PACKED) == 0)
        return ffd_fail_file(error, FFD_E_UNSUPPORTED, path,
                             "compressed files of OpenFOAM are not written: the output is called " FOAM_NAME);
    return ffd_fail_file(error, FFD_E_ARGUMENT, path,
                         "the output of a mesh of OpenFOAM is called " FOAM_NAME ", too");
}

char *ffd_format_rename(const char *path, const char *ending)
{
    char *const named = ffd_path_with_ending(path, ending);
    if (!named || !ffd_path_has_ending(named, ".foam"))
        return named;
    ffd_free(named);
    return ffd_path_sibling(path, FOAM_NAME);
}

/* Finds the file of a mesh of OpenFOAM in its folder, or in that of its case. Returns its name from there, or
   NULL. */
static const char *find_foam(const char *folder)
{
    static const char *const names[] = {FOAM_NAME, "polyMesh/" FOAM_NAME, "constant/polyMesh/" FOAM_NAME,
                                        FOAM_PACKED, "constant/polyMesh/" FOAM_PACKED};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *const path = ffd_path_join(folder, names[i]);
        const bool is_there = path && ffd_file_exists(path);
        ffd_free(path);
        if (is_there)
            return names[i];
    }
    return NULL;
}

static ffd_status refuse_folder(const char *path, ffd_error *error)
{
    const char *const found = find_foam(path);
    return ffd_fail_file(
        error, FFD_E_ARGUMENT, path, "is a folder: name its %s%.*s/%s", found ? "file " : "meshes, such as ",
        (int)(strlen(path) - ffd_is_separator(path[strlen(path) - 1])), path, found ? found : "*.obj");
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
        return refuse_folder(path, error);
    if (ffd_path_has_ending(path, ".foam"))
        return ffd_fail_file(error, FFD_E_ARGUMENT, path,
                             "is no mesh: that of its case is the file constant/polyMesh/" FOAM_NAME
                             " beside it");
    return ffd_fail_file(error, FFD_E_ARGUMENT, path,
                         "the ending \"%s\" is not that of a mesh format (" FFD_FORMAT_NAMES
                         ", whose file is called " FOAM_NAME ")",
                         ending);
}

ffd_status ffd_format_check_name(const char *name, ffd_error *error)
{
    return ffd_format_from_name(name) != FFD_FORMAT_AUTO ? FFD_OK : ffd_format_refuse_name(name, error);
}
