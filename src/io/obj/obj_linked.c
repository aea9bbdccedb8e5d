#include "io/obj/obj_linked.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/obj/resource/obj_paths.h"
#include "io/obj/resource/resource_names.h"
#include <stdio.h>
#include <string.h>

/* How many names follow a keyword: one, which may hold blanks; one and then arguments; or several. */
typedef enum name_form { NAME_LINE, NAME_FIRST, NAME_EACH } name_form;

static const struct {
    const char *keyword;
    name_form form;
} statements[] = {
    {"call", NAME_FIRST}, {"maplib", NAME_EACH}, {"shadow_obj", NAME_LINE}, {"trace_obj", NAME_LINE}};

/* Returns the number of the statement; -1: it is none of these. */
static int find_statement(text_word keyword)
{
    for (int i = 0; i < (int)(sizeof statements / sizeof *statements); i++)
        if (ffd_text_is(keyword, statements[i].keyword))
            return i;
    return -1;
}

bool ffd_obj_names_file(text_word keyword)
{
    return find_statement(keyword) >= 0;
}

/* Names, each once, and for each the number of the statement that has it first. */
typedef struct linked_names {
    intern_table names;
    byte_buffer statements;
} linked_names;

static ffd_status add_name(const obj_document *d, linked_names *found, text_word name, int statement,
                           ffd_error *error)
{
    const size_t before = found->names.count, size = (size_t)(name.last - name.first);
    const char number = (char)statement;
    if (size == 0 || memchr(name.first, 0, size))
        return FFD_OK;
    const ffd_status status = ffd_obj_add_name(&found->names, name.first, size, d->file.name, error);
    if (!status && found->names.count > before)
        ffd_buffer_append(&found->statements, &number, 1);
    return found->statements.failed ? ffd_fail_memory(error) : status;
}

/* Takes the names of the statement that the scan is at. */
static ffd_status take_names(const obj_document *d, obj_scan *scan, int statement, linked_names *found,
                             ffd_error *error)
{
    const name_form form = statements[statement].form;
    text_word word, line = {0};
    ffd_status status = FFD_OK;
    for (bool goes_on = true; goes_on && !status && ffd_obj_scan_word(scan, &word);) {
        line = (text_word){line.first ? line.first : word.first, word.last};
        if (form != NAME_LINE)
            status = add_name(d, found, word, statement, error);
        goes_on = form != NAME_FIRST;
    }
    return status || form != NAME_LINE ? status : add_name(d, found, line, statement, error);
}

static ffd_status find_names(const obj_document *d, linked_names *found, ffd_error *error)
{
    obj_walk walk;
    ffd_status status = FFD_OK;
    if (!d->names_files)
        return FFD_OK;
    ffd_obj_document_walk(d, &walk);
    while (!status && ffd_obj_walk_next(&walk)) {
        const int statement = walk.scan.keyword == OBJ_OTHER ? find_statement(walk.scan.name) : -1;
        if (statement >= 0)
            status = take_names(d, &walk.scan, statement, found, error);
    }
    return status;
}

static void free_names(linked_names *found)
{
    ffd_intern_free(&found->names);
    ffd_buffer_free(&found->statements);
}

ffd_status ffd_obj_leave_linked(const obj_document *d, const char *from, const char *to, left_out *left,
                                ffd_error *error)
{
    linked_names found = {0};
    ffd_status status = find_names(d, &found, error);
    for (uint32_t i = 0; i < found.names.count && !status; i++) {
        char why[40], *path;
        snprintf(why, sizeof why, "of %s", statements[(int)found.statements.data[i]].keyword);
        status = ffd_obj_find_path(from, "", ffd_intern_key(&found.names, i), &path, error);
        if (!status && path) /* an absolute name leads there from everywhere */
            status = ffd_left_add_unreached(left, to, path, why, error);
        ffd_free(path);
    }
    free_names(&found);
    return status;
}

ffd_status ffd_obj_list_linked(const mesh_document *document, path_list *files, ffd_error *error)
{
    const obj_document *const d = ffd_obj_of(document);
    linked_names found = {0};
    if (!d->file.path)
        return FFD_OK;
    char *const folder = ffd_path_folder(d->file.path);
    ffd_status status = folder ? find_names(d, &found, error) : ffd_fail_memory(error);
    for (uint32_t i = 0; i < found.names.count && !status; i++) {
        char *path, *file = NULL;
        status = ffd_obj_find_path(folder, "", ffd_intern_key(&found.names, i), &path, error);
        if (!status && path)
            file = ffd_path_beside(d->file.path, path);
        if (!status && path)
            status = file ? ffd_paths_add(files, file, error) : ffd_fail_memory(error);
        ffd_free(path);
        ffd_free(file);
    }
    free_names(&found);
    ffd_free(folder);
    return status;
}
