#include "batch/index_entry.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include <string.h>

/* Returns a text of the entry, owned by it. NULL: absent, or memory ran out (*failed). */
static const char *text_of(index_entry *entry, const json_span *tree, const char *key, bool *failed)
{
    const uint32_t value = ffd_json_span_member(tree, 0, key);
    if (value == JSON_NONE || tree->values[value].kind != JSON_STRING)
        return NULL;
    char *const text = ffd_json_span_string(tree, value, NULL);
    *failed = *failed || !text;
    entry->texts[entry->text_count++] = text;
    return text;
}

static bool number_of(const json_span *tree, uint32_t object, const char *key, double *number)
{
    const uint32_t value = ffd_json_span_member(tree, object, key);
    return value != JSON_NONE && ffd_json_span_number(tree, value, number);
}

static void read_figures(const json_span *tree, index_row *row)
{
    static const char *const verdicts[] = {
        [INDEX_FOLDS_NONE] = "none", [INDEX_FOLDS_UNKNOWN] = "unknown", [INDEX_FOLDS_SOME] = "some"};
    const uint32_t displacement = ffd_json_span_member(tree, 0, "displacement"),
                   tear = ffd_json_span_member(tree, 0, "tear"),
                   folds = ffd_json_span_member(tree, 0, "folds");
    const uint32_t verdict = ffd_json_span_member(tree, folds, "verdict");
    row->has_displacement = number_of(tree, displacement, "max", &row->displacement);
    row->has_tear = number_of(tree, tear, "edges", &row->torn_edges) &&
                    number_of(tree, tear, "largest", &row->largest_step);
    row->has_flipped = number_of(tree, 0, "flipped_faces", &row->flipped_faces);
    if (verdict == JSON_NONE || !number_of(tree, folds, "folded_cells", &row->folded_cells) ||
        !number_of(tree, folds, "min_det", &row->min_det))
        return;
    for (int v = INDEX_FOLDS_NONE; v <= INDEX_FOLDS_SOME; v++)
        if (ffd_json_span_string_is(tree, verdict, verdicts[v]))
            row->folds = (index_folds)v;
}

/* Whether the entry has figures. Zeros stand for those of a job that failed early, or that no run has
   recorded. */
static bool has_figures(const json_span *tree)
{
    double vertices = 0;
    return number_of(tree, 0, "vertices", &vertices) && vertices > 0;
}

ffd_status ffd_index_entry_read(const byte_buffer *text, index_entry *entry, ffd_error *error)
{
    const json_input input = {.text = text->data, .size = text->size, .name = "the report"};
    json_span tree;
    bool failed = false;
    *entry = (index_entry){0};
    const ffd_status status = ffd_json_parse(&input, &tree, error);
    if (status)
        return status;
    entry->row.input = text_of(entry, &tree, "input", &failed);
    entry->row.output = text_of(entry, &tree, "output", &failed);
    entry->row.status = text_of(entry, &tree, "status", &failed);
    entry->row.error = text_of(entry, &tree, "error", &failed);
    if (has_figures(&tree))
        read_figures(&tree, &entry->row);
    ffd_json_span_free(&tree);
    return failed ? ffd_fail_memory(error) : FFD_OK;
}

void ffd_index_entry_free(index_entry *entry)
{
    for (size_t i = 0; i < entry->text_count; i++)
        ffd_free(entry->texts[i]);
    *entry = (index_entry){0};
}
