#include "io/obj/resource/obj_libraries.h"
#include "base/memory/memory.h"
#include "base/text/text_scan.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_paths.h"
#include "io/obj/resource/obj_statements.h"
#include <string.h>

/* The longest statement that may be a single name. */
#define NAME_MAX_SIZE ((size_t)4096)

/* Whether a file beside the OBJ file has just this name. */
static bool is_file(const file_folder *mesh, const char *name, size_t size)
{
    char text[NAME_MAX_SIZE + 1];
    if (size > NAME_MAX_SIZE)
        return false;
    memcpy(text, name, size);
    text[size] = 0;
    return ffd_mtl_has_name(text) && ffd_folder_has(mesh, text);
}

/* A name as far as it is known: from its first word to its last one. */
typedef struct name_words {
    const char *first, *last_word, *end;
} name_words;

/* Adds a name that ends like a library's. If there is only a file of its last word, the words before are
   another name. */
static ffd_status add_words(intern_table *names, const name_words *name, const file_folder *mesh,
                            ffd_error *error)
{
    const size_t size = (size_t)(name->end - name->first), last = (size_t)(name->end - name->last_word);
    if (last == size || is_file(mesh, name->first, size) || !is_file(mesh, name->last_word, last))
        return ffd_obj_add_name(names, name->first, size, mesh->file, error);
    const char *end = name->last_word;
    while (ffd_text_is_blank(end[-1]))
        end--;
    TRY(ffd_obj_add_name(names, name->first, (size_t)(end - name->first), mesh->file, error));
    return ffd_obj_add_name(names, name->last_word, last, mesh->file, error);
}

static bool ends_library(text_word word)
{
    char ending[8] = {0};
    const size_t size = (size_t)(word.last - word.first), kept = size < 5 ? size : 5;
    memcpy(ending, word.last - kept, kept);
    return ffd_mtl_has_name(ending);
}

/* Cuts the arguments of a statement into names. */
static ffd_status split(intern_table *names, const char *text, size_t size, const file_folder *mesh,
                        ffd_error *error)
{
    text_scan scan;
    text_word word;
    name_words name = {0};
    while (size > 0 && ffd_text_is_blank(text[size - 1]))
        size--;
    while (size > 0 && ffd_text_is_blank(*text)) {
        text++;
        size--;
    }
    if (is_file(mesh, text, size))
        return ffd_obj_add_name(names, text, size, mesh->file, error);
    ffd_text_begin(&scan, text, size, false);
    while (ffd_text_word(&scan, &word)) {
        name = (name_words){name.first ? name.first : word.first, word.first, word.last};
        if (ends_library(word)) {
            TRY(add_words(names, &name, mesh, error));
            name.first = NULL;
        }
    }
    if (name.first)
        TRY(ffd_obj_add_name(names, name.first, (size_t)(name.end - name.first), mesh->file, error));
    return FFD_OK;
}

bool ffd_obj_names_libraries(const file_input *input)
{
    return ffd_obj_has_statement(input, "mtllib");
}

ffd_status ffd_obj_list_libraries(const file_input *input, const file_folder *mesh, intern_table *names,
                                  ffd_error *error)
{
    intern_table statements = {0};
    ffd_status status;
    TRY_END(ffd_obj_list_statements(input, mesh->file, "mtllib", &statements, error));
    for (uint32_t i = 0; i < statements.count; i++) {
        const char *const text = ffd_intern_key(&statements, i);
        TRY_END(split(names, text, strlen(text), mesh, error));
    }
end:
    ffd_intern_free(&statements);
    return status;
}
