#include "io/obj/resource/obj_linked.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/obj/resource/obj_paths.h"
#include "io/obj/resource/obj_statements.h"
#include <stdio.h>
#include <string.h>

/* How many names follow a keyword: one, which may hold blanks; one and then arguments; or several. */
typedef enum name_form { NAME_LINE, NAME_FIRST, NAME_EACH } name_form;

#define STATEMENTS 4
static const struct {
    const char *keyword;
    name_form form;
} statements[STATEMENTS] = {
    {"call", NAME_FIRST}, {"maplib", NAME_EACH}, {"shadow_obj", NAME_LINE}, {"trace_obj", NAME_LINE}};

bool ffd_obj_names_file(text_word keyword)
{
    bool found = false;
    for (int i = 0; i < STATEMENTS && !found; i++)
        found = ffd_text_is(keyword, statements[i].keyword);
    return found;
}

/* Adds the names among the arguments of a statement. */
static ffd_status add_names(const char *arguments, name_form form, const char *file, intern_table *names,
                            ffd_error *error)
{
    text_scan scan;
    text_word word, line = {0};
    ffd_text_begin(&scan, arguments, strlen(arguments), true);
    for (bool goes_on = true; goes_on && ffd_text_word(&scan, &word);) {
        line = (text_word){line.first ? line.first : word.first, word.last};
        goes_on = form != NAME_FIRST;
        if (form != NAME_LINE)
            TRY(ffd_obj_add_name(names, word.first, (size_t)(word.last - word.first), file, error));
    }
    if (form == NAME_LINE && line.first)
        TRY(ffd_obj_add_name(names, line.first, (size_t)(line.last - line.first), file, error));
    return FFD_OK;
}

/* Lists the names of statements of one kind, each once. */
static ffd_status list_names(const file_input *input, const char *file, int statement, intern_table *names,
                             ffd_error *error)
{
    intern_table found = {0};
    ffd_status status;
    TRY_END(ffd_obj_list_statements(input, file, statements[statement].keyword, &found, error));
    for (uint32_t i = 0; i < found.count; i++)
        TRY_END(add_names(ffd_intern_key(&found, i), statements[statement].form, file, names, error));
end:
    ffd_intern_free(&found);
    return status;
}

ffd_status ffd_obj_leave_name(const file_folder *from, const char *name, const char *to, left_out *left,
                              const char *why, ffd_error *error)
{
    char *path;
    TRY(ffd_obj_find_path(from, "", name, &path, error));
    if (!path) /* an absolute name leads there from everywhere */
        return FFD_OK;
    const ffd_status status = ffd_left_add_unreached(left, to, path, why, error);
    ffd_free(path);
    return status;
}

ffd_status ffd_obj_leave_linked(const file_input *input, const char *name, const file_folder *from,
                                const char *to, left_out *left, ffd_error *error)
{
    intern_table names = {0};
    ffd_status status = FFD_OK;
    for (int s = 0; s < STATEMENTS; s++) {
        char why[40];
        snprintf(why, sizeof why, "of %s", statements[s].keyword);
        TRY_END(list_names(input, name, s, &names, error));
        for (uint32_t i = 0; i < names.count; i++)
            TRY_END(ffd_obj_leave_name(from, ffd_intern_key(&names, i), to, left, why, error));
        ffd_intern_free(&names);
    }
end:
    ffd_intern_free(&names);
    return status;
}

/* Adds the path of a file beside the mesh. */
static ffd_status add_sibling(const file_folder *mesh, const char *name, path_list *files, ffd_error *error)
{
    char *path;
    ffd_status status = ffd_obj_find_path(mesh, "", name, &path, error);
    char *const file = path ? ffd_path_sibling(mesh->file, path) : NULL;
    if (path)
        status = file ? ffd_paths_add(files, file, error) : ffd_fail_memory(error);
    ffd_free(path);
    ffd_free(file);
    return status;
}

ffd_status ffd_obj_find_linked(const file_input *input, const char *path, path_list *files, ffd_error *error)
{
    const file_folder mesh = {.file = path};
    intern_table names = {0};
    ffd_status status = FFD_OK;
    for (int s = 0; s < STATEMENTS; s++)
        TRY_END(list_names(input, path, s, &names, error));
    for (uint32_t i = 0; i < names.count; i++)
        TRY_END(add_sibling(&mesh, ffd_intern_key(&names, i), files, error));
end:
    ffd_intern_free(&names);
    return status;
}
