/* compare_folders.c - ffd_compare_folders: the meshes of two folders, paired by name. */
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "job/compare.h"
#include <string.h>

/* The meshes of a folder, in the order of their names. */
static ffd_status list_meshes(const char *folder, path_list *meshes, ffd_error *error)
{
    path_list files = {0};
    ffd_status status;
    TRY_END(ffd_folder_walk(folder, &files, error));
    for (size_t i = 0; i < files.count; i++)
        if (ffd_format_from_name(files.paths[i]) != FFD_FORMAT_AUTO)
            TRY_END(ffd_paths_add(meshes, files.paths[i], error));
end:
    ffd_paths_free(&files);
    return status;
}

/* The comparison of two folders. */
typedef struct walk {
    const ffd_compare_desc *desc;
    ffd_compared_function file; /* or NULL */
    void *user;
    ffd_folder_comparison *result;
} walk;

static ffd_status give(const walk *w, const ffd_compared_file *file, ffd_error *error)
{
    const ffd_status status = w->file ? ffd_status_known(w->file(w->user, file)) : FFD_OK;
    return status ? ffd_fail_file(error, status, file->name, "was not taken by the caller") : FFD_OK;
}

static ffd_status give_single(const walk *w, const char *name, bool in_a, ffd_error *error)
{
    ++*(in_a ? &w->result->only_a : &w->result->only_b);
    return give(w, &(ffd_compared_file){.name = name, .in_a = in_a, .in_b = !in_a}, error);
}

static ffd_status compare_pair(const walk *w, const char *name, ffd_error *error)
{
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    ffd_error why = {0};
    ffd_compare_desc desc = *w->desc;
    char *const a = ffd_path_join(w->desc->a.path, name), *const b = ffd_path_join(w->desc->b.path, name);
    desc.a.path = a;
    desc.b.path = b;
    ffd_status status = a && b ? ffd_compare_run(&desc, &comparison, &why) : FFD_E_MEMORY;
    if (!a || !b)
        ffd_fail_memory(&why);
    ++*(status ? &w->result->failed : comparison.equal ? &w->result->same : &w->result->different);
    const ffd_compared_file file = {name, true, true, status ? NULL : &comparison, status ? &why : NULL};
    status = give(w, &file, error);
    ffd_free(a);
    ffd_free(b);
    return status;
}

/* Goes through both lists, which are sorted. */
static ffd_status compare_lists(const walk *w, const path_list *a, const path_list *b, ffd_error *error)
{
    for (size_t i = 0, k = 0; i < a->count || k < b->count;) {
        const int order = i == a->count ? 1 : k == b->count ? -1 : strcmp(a->paths[i], b->paths[k]);
        TRY(order == 0  ? compare_pair(w, a->paths[i], error)
            : order < 0 ? give_single(w, a->paths[i], true, error)
                        : give_single(w, b->paths[k], false, error));
        i += order <= 0;
        k += order >= 0;
    }
    return FFD_OK;
}

static ffd_status check_desc(const ffd_compare_desc *desc, ffd_error *error)
{
    if (!desc->a.path || !desc->b.path || desc->a.bytes.data || desc->b.bytes.data)
        return ffd_fail(error, FFD_E_ARGUMENT, "the comparison needs the paths of two folders");
    if (desc->a.format != FFD_FORMAT_AUTO || desc->b.format != FFD_FORMAT_AUTO)
        return ffd_fail(error, FFD_E_ARGUMENT, "the format of a mesh in a folder is that of its ending");
    return ffd_compare_check(desc, error);
}

ffd_status ffd_compare_folders(const ffd_compare_desc *callers, ffd_compared_function file, void *user,
                               ffd_folder_comparison *result, ffd_error *error)
{
    ffd_compare_desc desc;
    ffd_folder_comparison own = {.struct_size = sizeof own};
    path_list a = {0}, b = {0};
    ffd_compare_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_compare_desc", error));
    TRY(ffd_struct_check(sizeof own, result, "ffd_folder_comparison", error));
    const walk w = {&desc, file, user, &own};
    ffd_status status;
    TRY_END(check_desc(&desc, error));
    TRY_END(list_meshes(desc.a.path, &a, error));
    TRY_END(list_meshes(desc.b.path, &b, error));
    TRY_END(compare_lists(&w, &a, &b, error));
    own.equal = own.different + own.failed + own.only_a + own.only_b == 0;
end:
    ffd_paths_free(&a);
    ffd_paths_free(&b);
    ffd_struct_give(&own, sizeof own, result, result->struct_size);
    return status;
}

/* The parts of the JSON text, written as the meshes come. */
typedef struct folder_text {
    byte_buffer files;
    json_text json;
    path_list only_a, only_b;
} folder_text;

/* An ffd_compared_function. */
static ffd_status write_file(void *user, const ffd_compared_file *file)
{
    folder_text *const text = user;
    char line[2048];
    if (!file->in_a || !file->in_b)
        return ffd_paths_add(file->in_a ? &text->only_a : &text->only_b, file->name, NULL);
    ffd_json_object(&text->json, NULL, false);
    ffd_json_string(&text->json, "name", file->name);
    if (file->error) {
        ffd_error_format(file->error, line, sizeof line);
        ffd_json_bool(&text->json, "equal", false);
        ffd_json_string(&text->json, "error", line);
    } else {
        ffd_comparison_write(&text->json, file->comparison);
        ffd_json_null(&text->json, "error");
    }
    ffd_json_end(&text->json, '}');
    return text->files.failed ? FFD_E_MEMORY : FFD_OK;
}

static void write_names(json_text *json, const char *key, const path_list *names)
{
    ffd_json_array(json, key, false);
    for (size_t i = 0; i < names->count; i++)
        ffd_json_string(json, NULL, names->paths[i]);
    ffd_json_end(json, ']');
}

/* The array of files has been written as a member of an object, at its depth. */
static void write_all(const folder_text *text, const ffd_compare_desc *desc, bool equal, byte_buffer *whole)
{
    json_text json;
    const char *const start = memchr(text->files.data, '[', text->files.size);
    ffd_json_begin(&json, whole);
    ffd_comparison_begin(&json, desc->a.path, desc->b.path);
    ffd_json_bool(&json, "equal", equal);
    ffd_json_raw(&json, "files", start, text->files.size - (size_t)(start - text->files.data));
    write_names(&json, "only_a", &text->only_a);
    write_names(&json, "only_b", &text->only_b);
    ffd_json_end(&json, '}');
}

ffd_status ffd_compare_folders_json(const ffd_compare_desc *desc, ffd_folder_comparison *result, char **text,
                                    ffd_error *error)
{
    folder_text parts = {0};
    byte_buffer whole = {0};
    *text = NULL;
    ffd_json_begin(&parts.json, &parts.files);
    ffd_json_object(&parts.json, NULL, false);
    ffd_json_array(&parts.json, "files", false);
    ffd_status status;
    TRY_END(ffd_compare_folders(desc, write_file, &parts, result, error));
    ffd_json_end(&parts.json, ']');
    if (parts.files.failed)
        TRY_END(ffd_fail_memory(error));
    write_all(&parts, desc, result->equal, &whole);
    *text = ffd_buffer_finish(&whole);
    if (!*text)
        TRY_END(ffd_fail_memory(error));
end:
    ffd_buffer_free(&whole);
    ffd_buffer_free(&parts.files);
    ffd_paths_free(&parts.only_a);
    ffd_paths_free(&parts.only_b);
    return status;
}
