#include "batch/manifest/job_description.h"
#include "base/memory/memory.h"
#include <string.h>

static size_t add_text(job_description *description, const char *text)
{
    const size_t begin = description->texts.size;
    ffd_buffer_append(&description->texts, text ? text : "", text ? strlen(text) + 1 : 1);
    return begin;
}

void ffd_description_add(job_description *description, job_part part, const char *name, const char *value)
{
    if (!ffd_grow((void **)&description->statements, &description->capacity, description->count + 1,
                  sizeof *description->statements)) {
        description->texts.failed = true;
        return;
    }
    const size_t name_begin = add_text(description, name), value_begin = add_text(description, value);
    if (!description->texts.failed)
        description->statements[description->count++] = (job_statement){part, name_begin, value_begin};
}

/* Appends the punctuation between values: brackets, commas, colons. */
static void append_punctuation(const char *c, const char *last, byte_buffer *out)
{
    for (; c < last; c++)
        if (!strchr(" \t\r\n", *c))
            ffd_buffer_append(out, c, 1);
}

static void append_compact(const json_tree *tree, uint32_t top, byte_buffer *out)
{
    const char *const text = tree->text, *at = text + tree->values[top].begin;
    for (uint32_t v = top; v < tree->values[top].next; v++) {
        const json_value *const value = &tree->values[v];
        const char *const begin = text + value->begin;
        const bool is_container = value->kind == JSON_ARRAY || value->kind == JSON_OBJECT;
        const char *const end = is_container ? begin : text + value->end;
        if (v != top && value->key_end > value->key_begin) {
            append_punctuation(at, text + value->key_begin, out);
            ffd_buffer_append(out, text + value->key_begin, value->key_end - value->key_begin);
            at = text + value->key_end;
        }
        append_punctuation(at, begin, out);
        /* JSON's -0 as an integer becomes 0. */
        const bool is_zero = end - begin == 2 && memcmp(begin, "-0", 2) == 0;
        ffd_buffer_append(out, is_zero ? begin + 1 : begin, (size_t)(end - begin) - is_zero);
        at = end;
    }
    append_punctuation(at, text + tree->values[top].end, out);
}

void ffd_description_set(job_description *description, const char *name, const json_tree *tree,
                         uint32_t value)
{
    byte_buffer text = {0};
    append_compact(tree, value, &text);
    char *const compact = ffd_buffer_finish(&text);
    if (compact)
        ffd_description_add(description, JOB_SETTING, name, compact);
    else
        description->texts.failed = true;
    ffd_free(compact);
    ffd_buffer_free(&text);
}

const char *ffd_description_name(const job_description *description, const job_statement *statement)
{
    return description->texts.data + statement->name;
}

const char *ffd_description_value(const job_description *description, const job_statement *statement)
{
    return description->texts.data + statement->value;
}

const char *ffd_description_find(const job_description *description, job_part part)
{
    for (size_t i = 0; i < description->count; i++)
        if (description->statements[i].part == part)
            return ffd_description_value(description, &description->statements[i]);
    return NULL;
}

const char *ffd_description_wrong(const job_description *description, const char *name)
{
    for (size_t i = 0; i < description->count; i++)
        if (description->statements[i].part == JOB_WRONG &&
            strcmp(ffd_description_name(description, &description->statements[i]), name) == 0)
            return ffd_description_value(description, &description->statements[i]);
    return NULL;
}

void ffd_description_free(job_description *description)
{
    ffd_free(description->statements);
    ffd_buffer_free(&description->texts);
    *description = (job_description){0};
}
