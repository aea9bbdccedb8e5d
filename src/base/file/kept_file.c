#include "base/file/kept_file.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <string.h>

void ffd_kept_put(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input)
{
    char *const name = kept->path || input->mapped ? NULL : ffd_text_copy(path);
    if (name)
        *kept = (kept_file){name, *stamp, *input};
    else
        ffd_file_unload(input);
}

bool ffd_kept_take(kept_file *kept, const char *path, const file_stamp *stamp, file_input *input)
{
    if (!kept || !kept->path || strcmp(kept->path, path) != 0 || !ffd_stamp_equal(&kept->stamp, stamp))
        return false;
    *input = kept->input;
    ffd_free(kept->path);
    *kept = (kept_file){0};
    return true;
}

void ffd_kept_free(kept_file *kept)
{
    ffd_file_unload(&kept->input);
    ffd_free(kept->path);
    *kept = (kept_file){0};
}
