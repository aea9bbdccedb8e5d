#include "io/obj/resource/obj_statements.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "base/text/text_scan.h"
#include "io/obj/resource/obj_paths.h"
#include <string.h>

/* The longest statement whose arguments are looked at. */
#define STATEMENT_MAX ((size_t)1 << 20)
/* Bytes of the file that are in memory at a time. */
#define PIECE ((size_t)1 << 21)

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
static bool begins_statement(const char *first, const char *at, const char *last, const char *keyword)
{
    const size_t size = strlen(keyword);
    if ((size_t)(last - at) <= size || memcmp(at, keyword, size) != 0 || !ffd_text_is_blank(at[size]))
        return false;
    while (at > first && ffd_text_is_blank(at[-1]))
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

/* Adds the arguments of the statement whose keyword is at *at, and moves to its end. */
static ffd_status take_statement(intern_table *statements, const char *keyword, const char **at,
                                 const char *last, const char *path, ffd_error *error)
{
    byte_buffer text = {0};
    ffd_status status = FFD_OK;
    *at = take_arguments(*at + strlen(keyword), last, &text);
    if (text.failed)
        status = ffd_fail_memory(error);
    else if (text.size > STATEMENT_MAX)
        status = ffd_fail_file(error, FFD_E_LIMIT, path, "a %s statement has more than %zu bytes", keyword,
                               STATEMENT_MAX);
    else if (text.size > 0 && !memchr(text.data, 0, text.size))
        status = ffd_obj_add_name(statements, text.data, text.size, path, error);
    ffd_buffer_free(&text);
    return status;
}

/* The next statement that begins from `at` on, but before `end`; NULL: there is none. */
static const char *find_statement(const char *first, const char *at, const char *end, const char *last,
                                  const char *keyword)
{
    while (at < end && (at = memchr(at, keyword[0], (size_t)(end - at)))) {
        if (begins_statement(first, at, last, keyword))
            return at;
        at++;
    }
    return NULL;
}

bool ffd_obj_has_statement(const file_input *input, const char *keyword)
{
    const char *first = (const char *)input->data;
    const char *const last = first + ffd_text_size(first, input->size);
    if (ffd_text_has_mark(first, input->size))
        first += TEXT_MARK_SIZE;
    return find_statement(first, first, last, last, keyword);
}

ffd_status ffd_obj_list_statements(const file_input *input, const char *path, const char *keyword,
                                   intern_table *statements, ffd_error *error)
{
    const char *first = (const char *)input->data;
    const char *const last = first + ffd_text_size(first, input->size);
    size_t released = 0;
    if (ffd_text_has_mark(first, input->size))
        first += TEXT_MARK_SIZE;
    ffd_status status = FFD_OK;
    for (const char *at = first; at < last;) {
        const char *const end = (size_t)(last - at) > PIECE ? at + PIECE : last;
        const char *statement;
        if (input->mapped)
            ffd_file_prefault(at, (size_t)(end - at));
        while ((statement = find_statement(first, at, end, last, keyword))) {
            at = statement;
            TRY_END(take_statement(statements, keyword, &at, last, path, error));
        }
        at = at < end ? end : at;
        ffd_file_release_until(input, at, &released);
    }
end:
    ffd_file_release_pages(input, input->data + released, input->size - released);
    return status;
}
