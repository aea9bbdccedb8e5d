/* obj_file.h - opens OBJ text from memory and saves it to memory. */
#ifndef FFD_TESTS_OBJ_FILE_H
#define FFD_TESTS_OBJ_FILE_H

#include "base/file.h"
#include "io/formats.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const mesh_format *const obj = &ffd_obj_format;

/* Opens bytes (which must stay) as if they were the file `name`. */
static inline ffd_status open_bytes(const void *bytes, size_t size, const char *name,
                                    mesh_document **document, ffd_error *error)
{
    file_input input = {.data = bytes, .size = size};
    const ffd_source source = {.path = name, .format = FFD_FORMAT_OBJ};
    return obj->open(&input, &source, document, error);
}

/* Saves into the file `path` and reads that. */
static inline ffd_status save_bytes(mesh_document *document, const char *path, file_input *saved,
                                    ffd_error *error)
{
    const mesh_save_options options = {.path = path, .format = FFD_FORMAT_OBJ, .force = true};
    const mesh_log log = {0};
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (status)
        return status;
    status = obj->save(document, &options, output, &log, error);
    if (status == FFD_OK)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status == FFD_OK ? ffd_file_load(path, saved, error) : status;
}

static inline bool same_bytes(const file_input *file, const void *bytes, size_t size)
{
    return file->size == size && memcmp(file->data, bytes, size) == 0;
}

/* A path for the saved files of this process; remove_saved takes it away again. */
static inline const char *saved_path(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/ffd-test-obj-%ld.obj", (long)getpid());
    return path;
}

static inline int remove_saved(void **state)
{
    (void)state;
    remove(saved_path());
    return 0;
}

#endif
