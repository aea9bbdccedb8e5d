#include "base/file/file_folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Does not allocate, so that a file is not missing because memory runs out. A path that is too long for the
   system is that of no file. */
bool ffd_folder_has(const file_folder *folder, const char *name)
{
    ffd_bytes bytes = {0};
    char path[PATH_MAX];
    if (folder->resolve)
        return !folder->resolve(folder->user, name, &bytes) && bytes.data;
    if (!folder->file)
        return false;
    const int length = (int)(ffd_path_name(folder->file) - folder->file);
    const int size = snprintf(path, sizeof path, "%.*s%s", length, folder->file, name);
    return size >= 0 && (size_t)size < sizeof path && ffd_file_exists(path);
}

/* Sets *leads_out to whether a name leads to no file of the folder or below. */
static ffd_status check(const char *name, bool *leads_out, ffd_error *error)
{
    char *const plain = ffd_path_normalize(name);
    *leads_out = plain && (!*plain || ffd_path_is_absolute(plain) || ffd_path_leads_out(plain));
    ffd_free(plain);
    return plain ? FFD_OK : ffd_fail_memory(error);
}

static ffd_status load_given(const file_folder *folder, const char *name, const char *named_by,
                             file_input *input, ffd_error *error)
{
    ffd_bytes bytes = {0};
    bool leads_out;
    TRY(check(name, &leads_out, error));
    if (leads_out)
        return ffd_fail_file(error, FFD_E_IO, named_by, "the file \"%s\" is outside the model's folder",
                             name);
    const ffd_status status = folder->resolve(folder->user, name, &bytes);
    if (status)
        return ffd_fail_file(error, status, named_by, "the file \"%s\" was not given by the caller", name);
    if (!bytes.data)
        return ffd_fail_file(error, FFD_E_IO, named_by, "the file \"%s\" cannot be opened: %s", name,
                             strerror(ENOENT));
    return ffd_file_lend(bytes, named_by, input, error);
}

ffd_status ffd_folder_load(const file_folder *folder, const char *name, const char *named_by, size_t *most,
                           file_input *input, ffd_error *error)
{
    if (folder->resolve)
        return load_given(folder, name, named_by, input, error);
    char *const path = ffd_path_folder(folder->file);
    const ffd_status status =
        path ? ffd_file_load_within(path, name, named_by, most, input, error) : ffd_fail_memory(error);
    ffd_free(path);
    return status;
}

bool ffd_folder_turn_slashes(const file_folder *folder, char *name)
{
    const bool turns = strchr(name, '\\') && !ffd_folder_has(folder, name);
    for (char *c = name; turns && *c; c++)
        *c = (char)(*c == '\\' ? '/' : *c);
    return turns;
}
