#include "json/json_edit.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static json_edit *add(json_edits *edits, uint32_t begin, uint32_t end)
{
    if (!ffd_grow((void **)&edits->edits, &edits->capacity, edits->count + 1, sizeof *edits->edits)) {
        edits->failed = true;
        return NULL;
    }
    json_edit *edit = &edits->edits[edits->count++];
    *edit = (json_edit){.begin = begin,
                        .end = end,
                        .order = edits->count,
                        .text = edits->pool.size,
                        .buffer = EDIT_NO_BUFFER};
    return edit;
}

void ffd_edits_replace(json_edits *edits, uint32_t begin, uint32_t end, const char *text, size_t size)
{
    json_edit *edit = add(edits, begin, end);
    if (!edit)
        return;
    edit->text_size = size;
    ffd_buffer_append(&edits->pool, text, size);
}

void ffd_edits_format(json_edits *edits, uint32_t begin, uint32_t end, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= sizeof text)
        edits->failed = true;
    else
        ffd_edits_replace(edits, begin, end, text, (size_t)length);
}

void ffd_edits_buffer(json_edits *edits, uint32_t begin, uint32_t end, int buffer)
{
    json_edit *edit = add(edits, begin, end);
    if (edit)
        edit->buffer = buffer;
}

void ffd_edits_join(json_edits *edits, const json_edits *others)
{
    edits->failed = edits->failed || ffd_edits_failed(others);
    for (size_t i = 0; i < others->count && !edits->failed; i++) {
        const json_edit *const edit = &others->edits[i];
        ffd_edits_replace(edits, edit->begin, edit->end,
                          edit->text_size ? others->pool.data + edit->text : "", edit->text_size);
    }
}

static bool is_among(uint32_t value, const uint32_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (values[i] == value)
            return true;
    return false;
}

/* Returns where an element, or a member with its key, begins. */
static uint32_t start_of(const json_value *value)
{
    return value->key_end > value->key_begin ? value->key_begin : value->begin;
}

/* Removes each member together with the comma before it; or with the comma after it, if no earlier member is
   kept. */
void ffd_edits_remove(json_edits *edits, const json_tree *tree, uint32_t container, const uint32_t *gone,
                      size_t gone_count)
{
    bool kept = false;
    uint32_t before = JSON_NONE;
    for (uint32_t v = ffd_json_tree_first(tree, container); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        const uint32_t after = ffd_json_tree_after(tree, v);
        if (!is_among(v, gone, gone_count))
            kept = true;
        else if (kept)
            ffd_edits_replace(edits, tree->values[before].end, tree->values[v].end, "", 0);
        else
            ffd_edits_replace(edits, start_of(&tree->values[v]),
                              after == JSON_NONE ? tree->values[v].end : start_of(&tree->values[after]), "",
                              0);
        before = v;
    }
}

static int compare_edits(const void *a, const void *b)
{
    const json_edit *x = a, *y = b;
    if (x->begin != y->begin)
        return x->begin < y->begin ? -1 : 1;
    if (x->end != y->end)
        return x->end < y->end ? -1 : 1;
    return (x->order > y->order) - (x->order < y->order);
}

void ffd_edits_sort(json_edits *edits)
{
    if (edits->count > 0)
        qsort(edits->edits, edits->count, sizeof *edits->edits, compare_edits);
}

static bool begins_before(const void *edit, const void *begin)
{
    return ((const json_edit *)edit)->begin < *(const uint32_t *)begin;
}

void ffd_edits_apply(const json_edits *edits, const char *text, uint32_t begin, uint32_t end,
                     byte_buffer *out)
{
    uint32_t at = begin;
    if (ffd_edits_failed(edits)) { /* the texts are incomplete */
        out->failed = true;
        return;
    }
    size_t i = lower_bound(&begin, edits->edits, edits->count, sizeof *edits->edits, begins_before);
    for (; i < edits->count && edits->edits[i].end <= end; i++) {
        const json_edit *edit = &edits->edits[i];
        ffd_buffer_append(out, text + at, edit->begin - at);
        if (edit->text_size > 0)
            ffd_buffer_append(out, edits->pool.data + edit->text, edit->text_size);
        at = edit->end;
    }
    ffd_buffer_append(out, text + at, end - at);
}

bool ffd_edits_failed(const json_edits *edits)
{
    return edits->failed || edits->pool.failed;
}

void ffd_edits_free(json_edits *edits)
{
    ffd_free(edits->edits);
    ffd_buffer_free(&edits->pool);
    *edits = (json_edits){0};
}
