#include "batch/index_entry.h"
#include "base/memory/memory.h"
#include "job/report/report.h"
#include "job/report/report_figures.h"
#include "json/json_parse.h"

/* Returns a text of the entry, owned by it. NULL: absent, or memory ran out (*failed). */
static const char *text_of(index_entry *entry, const json_tree *tree, const char *key, bool *failed)
{
    const uint32_t value = ffd_json_tree_member(tree, 0, key);
    if (value == JSON_NONE || tree->values[value].kind != JSON_STRING)
        return NULL;
    char *const text = ffd_json_tree_string(tree, value, NULL);
    *failed = *failed || !text;
    entry->texts[entry->text_count++] = text;
    return text;
}

static index_state state_of(const json_tree *tree)
{
    const uint32_t status = ffd_json_tree_member(tree, 0, "status");
    const char *const skipped = ffd_report_outcome_name(REPORT_SKIPPED), *const failed =
                                                                             ffd_report_outcome_name(
                                                                                 REPORT_FAILED);
    if (status != JSON_NONE && ffd_json_tree_string_is(tree, status, skipped))
        return INDEX_SKIPPED;
    return status != JSON_NONE && ffd_json_tree_string_is(tree, status, failed) ? INDEX_FAILED : INDEX_DONE;
}

ffd_status ffd_index_entry_read(const byte_buffer *text, index_entry *entry, ffd_error *error)
{
    const json_input input = {.text = text->data, .size = text->size, .name = "the report"};
    json_tree tree;
    bool failed = false;
    *entry = (index_entry){0};
    TRY(ffd_json_parse(&input, &tree, error));
    entry->row.input = text_of(entry, &tree, "input", &failed);
    entry->row.output = text_of(entry, &tree, "output", &failed);
    entry->row.error = text_of(entry, &tree, "error", &failed);
    entry->row.state = state_of(&tree);
    ffd_figures_read(&tree, 0, &entry->figures);
    /* Zeros stand for the figures of a job that failed early, or that no run has recorded. */
    entry->row.figures = entry->figures.vertices > 0 ? &entry->figures : NULL;
    ffd_json_tree_free(&tree);
    return failed ? ffd_fail_memory(error) : FFD_OK;
}

void ffd_index_entry_free(index_entry *entry)
{
    for (size_t i = 0; i < entry->text_count; i++)
        ffd_free(entry->texts[i]);
    *entry = (index_entry){0};
}
