#include "io/obj/resource/obj_libraries.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/resource_names.h"
#include "io/text/text_scan.h"
#include <string.h>

static const char keyword[] = "mtllib";
#define KEYWORD_SIZE (sizeof keyword - 1)

/* The longest statement whose names are looked at, and the longest one that may be a single name. */
#define STATEMENT_MAX ((size_t)1 << 20)
#define NAME_MAX_SIZE ((size_t)4096)
/* Bytes of the file that are in memory at a time. */
#define PIECE ((size_t)1 << 21)

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

/* Whether the line that ends before `end` (its line end is not part of it) goes on in the next one: it ends
   with a backslash, and not in a comment. */
static bool is_continued(const char *first, const char *end)
{
    if (end == first || end[-1] != '\\')
        return false;
    while (end > first && !is_line_end(end[-1])) {
        if (end[-1] == '#')
            return false;
        end--;
    }
    return true;
}

/* Whether the keyword at `at` begins a statement. */
static bool begins_statement(const char *first, const char *at, const char *last)
{
    if ((size_t)(last - at) <= KEYWORD_SIZE || memcmp(at, keyword, KEYWORD_SIZE) != 0 ||
        !is_blank(at[KEYWORD_SIZE]))
        return false;
    while (at > first && is_blank(at[-1]))
        at--;
    if (at == first)
        return true;
    if (!is_line_end(at[-1]))
        return false;
    at -= at[-1] == '\n' && at - first > 1 && at[-2] == '\r' ? 2 : 1;
    return !is_continued(first, at);
}

/* Copies the arguments that follow the keyword, continued lines joined. Returns where the statement ends. */
static const char *take_arguments(const char *at, const char *last, byte_buffer *text)
{
    for (;;) {
        const char *const begin = at;
        while (at < last && !is_line_end(*at))
            at++;
        const bool goes_on = at > begin && at < last && at[-1] == '\\';
        ffd_buffer_append(text, begin, (size_t)(at - begin) - goes_on);
        if (!goes_on || text->size > STATEMENT_MAX)
            return at;
        ffd_buffer_append(text, " ", 1);
        at += *at == '\r' && last - at > 1 && at[1] == '\n' ? 2 : 1;
    }
}

/* Whether a file beside the OBJ file has just this name. */
static bool is_file(const char *path, const char *name, size_t size)
{
    char text[NAME_MAX_SIZE + 1];
    if (size > NAME_MAX_SIZE)
        return false;
    memcpy(text, name, size);
    text[size] = 0;
    char *const beside = ffd_path_beside(path, text);
    const bool is_one = beside && ffd_mtl_has_name(text) && ffd_file_exists(beside);
    ffd_free(beside);
    return is_one;
}

/* A name as far as it is known: from its first word to its last one. */
typedef struct name_words {
    const char *first, *last_word, *end;
} name_words;

/* Adds a name that ends like a library's. If there is only a file of its last word, the words before are
   another name. */
static ffd_status add_words(intern_table *names, const name_words *name, const char *path, ffd_error *error)
{
    const size_t size = (size_t)(name->end - name->first), last = (size_t)(name->end - name->last_word);
    if (last == size || is_file(path, name->first, size) || !is_file(path, name->last_word, last))
        return ffd_obj_add_name(names, name->first, size, path, error);
    const char *end = name->last_word;
    while (is_blank(end[-1]))
        end--;
    const ffd_status status = ffd_obj_add_name(names, name->first, (size_t)(end - name->first), path, error);
    return status ? status : ffd_obj_add_name(names, name->last_word, last, path, error);
}

static bool ends_library(text_word word)
{
    char ending[8] = {0};
    const size_t size = (size_t)(word.last - word.first), kept = size < 5 ? size : 5;
    memcpy(ending, word.last - kept, kept);
    return ffd_mtl_has_name(ending);
}

/* Cuts the arguments of a statement into names. */
static ffd_status split(intern_table *names, const char *text, size_t size, const char *path,
                        ffd_error *error)
{
    text_scan scan;
    text_word word;
    ffd_status status = FFD_OK;
    name_words name = {0};
    while (size > 0 && is_blank(text[size - 1]))
        size--;
    while (size > 0 && is_blank(*text)) {
        text++;
        size--;
    }
    if (is_file(path, text, size))
        return ffd_obj_add_name(names, text, size, path, error);
    ffd_text_begin(&scan, text, size, false);
    while (!status && ffd_text_word(&scan, &word)) {
        name = (name_words){name.first ? name.first : word.first, word.first, word.last};
        if (ends_library(word)) {
            status = add_words(names, &name, path, error);
            name.first = NULL;
        }
    }
    if (!status && name.first)
        status = ffd_obj_add_name(names, name.first, (size_t)(name.end - name.first), path, error);
    return status;
}

/* What was found so far. */
typedef struct found_libraries {
    intern_table statements; /* arguments: some programs repeat a statement for every object */
    intern_table *names;
} found_libraries;

/* Takes the names of the statement whose keyword is at *at, and moves to its end. */
static ffd_status take_statement(found_libraries *found, const char **at, const char *last, const char *path,
                                 ffd_error *error)
{
    byte_buffer text = {0};
    ffd_status status = FFD_OK;
    const size_t before = found->statements.count;
    *at = take_arguments(*at + KEYWORD_SIZE, last, &text);
    if (text.failed)
        status = ffd_fail_memory(error);
    else if (text.size > STATEMENT_MAX)
        status = ffd_fail_file(error, FFD_E_LIMIT, path, "a mtllib statement has more than %zu bytes",
                               STATEMENT_MAX);
    else if (text.size > 0 && !memchr(text.data, 0, text.size))
        status = ffd_obj_add_name(&found->statements, text.data, text.size, path, error);
    if (!status && found->statements.count > before)
        status = split(found->names, text.data, text.size, path, error);
    ffd_buffer_free(&text);
    return status;
}

/* The next statement that begins from `at` on, but before `end`; NULL: there is none. */
static const char *find_statement(const char *first, const char *at, const char *end, const char *last)
{
    while (at < end && (at = memchr(at, keyword[0], (size_t)(end - at)))) {
        if (begins_statement(first, at, last))
            return at;
        at++;
    }
    return NULL;
}

bool ffd_obj_names_libraries(const file_input *input)
{
    const char *first = (const char *)input->data;
    const char *const last = first + ffd_text_size(first, input->size);
    if (ffd_text_has_mark(first, input->size))
        first += TEXT_MARK_SIZE;
    return find_statement(first, first, last, last);
}

ffd_status ffd_obj_list_libraries(const file_input *input, const char *path, intern_table *names,
                                  ffd_error *error)
{
    const char *first = (const char *)input->data;
    const char *const last = first + ffd_text_size(first, input->size);
    found_libraries found = {.names = names};
    size_t released = 0;
    ffd_status status = FFD_OK;
    if (ffd_text_has_mark(first, input->size))
        first += TEXT_MARK_SIZE;
    for (const char *at = first; at < last && !status;) {
        const char *const end = (size_t)(last - at) > PIECE ? at + PIECE : last;
        const char *statement;
        if (input->mapped)
            ffd_file_prefault(at, (size_t)(end - at));
        while (!status && (statement = find_statement(first, at, end, last))) {
            at = statement;
            status = take_statement(&found, &at, last, path, error);
        }
        at = at < end ? end : at;
        ffd_file_release_until(input, at, &released);
    }
    ffd_intern_free(&found.statements);
    ffd_file_release_pages(input, input->data + released, input->size - released);
    return status;
}
