#include "base/file/written_files.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

/* The members of a stamp that identify a file. */
typedef struct file_key {
    uint64_t device, inode;
} file_key;

_Static_assert(sizeof(file_key) == 2 * sizeof(uint64_t), "a key has no padding");

static file_key key_of(const file_stamp *stamp)
{
    return (file_key){stamp->device, stamp->inode};
}

bool ffd_written_holds(const written_files *written, const char *path)
{
    file_stamp stamp;
    uint32_t index;
    if (written->count == 0 || !ffd_file_stamp(path, &stamp))
        return false;
    const file_key key = key_of(&stamp);
    /* The inode may be reused after somebody has removed the recorded file, so the paths are compared too. */
    return ffd_intern_find(&written->known, &key, sizeof key, &index) &&
           ffd_file_same(written->paths[index], path);
}

ffd_status ffd_written_add(written_files *written, const file_stamp *stamp, const char *path,
                           ffd_error *error)
{
    const file_key key = key_of(stamp);
    char *const copy = ffd_text_copy(path);
    uint32_t index;
    if (!copy ||
        !ffd_grow((void **)&written->paths, &written->capacity, written->count + 1, sizeof *written->paths) ||
        !ffd_intern(&written->known, &key, sizeof key, &index)) {
        ffd_free(copy);
        return ffd_fail_memory(error);
    }
    if (index < written->count)
        ffd_free(written->paths[index]);
    else
        written->count++;
    written->paths[index] = copy;
    return FFD_OK;
}

void ffd_written_free(written_files *written)
{
    for (size_t i = 0; i < written->count; i++)
        ffd_free(written->paths[i]);
    ffd_free(written->paths);
    ffd_intern_free(&written->known);
    *written = (written_files){0};
}
