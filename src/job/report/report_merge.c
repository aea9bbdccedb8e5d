/* report_merge.c - merges several reports into one, for jobs that ran on several machines. */
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "job/report/report_file.h"
#include "job/report/report_reader.h"
#include <ffd/job.h>
#include <string.h>

/* A report to be merged. It is mapped, so that the system can drop its pages when memory is short. */
typedef struct part {
    file_input file;
    report_reader reader;
} part;

static ffd_status open_part(part *p, const char *path, ffd_error *error)
{
    TRY(ffd_file_map(path, &p->file, error));
    return ffd_report_reader_open(&p->reader, strcmp(path, "-") == 0 ? "standard input" : path,
                                  ffd_report_has_lines(path), p->file.data, p->file.size, error);
}

/* The merged report. */
typedef struct merged_report {
    file_output *output;
    bool lines;
    uint64_t count; /* of entries */
    byte_buffer buffer;
} merged_report;

/* Writes the buffer. */
static ffd_status flush(merged_report *merged, ffd_error *error)
{
    if (merged->buffer.failed)
        return ffd_fail_memory(error);
    const ffd_status status =
        ffd_output_write(merged->output, merged->buffer.data, merged->buffer.size, error);
    merged->buffer.size = 0;
    return status;
}

/* Copies the next entry of a part, if there is one. */
static ffd_status write_next(part *p, merged_report *merged, ffd_error *error)
{
    report_entry_text entry;
    if (!ffd_report_reader_next(&p->reader, &entry))
        return FFD_OK;
    ffd_report_put_entry(merged->lines, merged->count == 0, entry.bytes, entry.size, &merged->buffer);
    merged->count++;
    return flush(merged, error);
}

static ffd_status write_in_order(part *parts, size_t count, merged_report *merged, ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        uint64_t before;
        do {
            before = merged->count;
            TRY(write_next(&parts[i], merged, error));
        } while (merged->count > before);
    }
    return FFD_OK;
}

/* Takes one entry of each part in turn. Shards of one run differ by at most one entry, so an entry after a
   part without one means that that part was truncated. */
static ffd_status write_in_turn(part *parts, size_t count, merged_report *merged, ffd_error *error)
{
    const part *ended = NULL;
    uint64_t before;
    do {
        before = merged->count;
        for (size_t i = 0; i < count; i++) {
            const uint64_t entries = merged->count;
            TRY(write_next(&parts[i], merged, error));
            if (merged->count > entries && ended)
                return ffd_fail_file(
                    error, FFD_E_INVALID, ended->reader.name,
                    "has too few entries for a shard of one run with the others: its run was "
                    "cut off, or had other jobs (without {interleave} they can be joined)");
            if (merged->count == entries && !ended)
                ended = &parts[i];
        }
    } while (merged->count > before);
    return FFD_OK;
}

static ffd_status write_report(part *parts, size_t count, bool interleave, merged_report *merged,
                               ffd_error *error)
{
    ffd_report_begin_text(merged->lines, &merged->buffer);
    ffd_status status;
    TRY_END(flush(merged, error));
    TRY_END((interleave ? write_in_turn : write_in_order)(parts, count, merged, error));
end:
    ffd_report_end_text(merged->lines, merged->count == 0, &merged->buffer);
    return status ? status : flush(merged, error);
}

/* losses: of mapped inputs, before they were opened. */
static ffd_status write_file(part *parts, size_t count, bool interleave, unsigned losses, const char *path,
                             bool force, ffd_error *error)
{
    merged_report merged = {.lines = ffd_report_has_lines(path)};
    TRY(ffd_output_create(&merged.output, error));
    ffd_status status;
    TRY_END(ffd_output_begin(merged.output, path, force, error));
    TRY_END(ffd_mapping_judge(losses, write_report(parts, count, interleave, &merged, error), error));
    TRY_END(ffd_output_commit(merged.output, error));
end:
    ffd_output_destroy(&merged.output);
    ffd_buffer_free(&merged.buffer);
    return status;
}

ffd_status ffd_report_merge_run(const char *const *reports, size_t count, bool interleave, const char *output,
                                bool force, ffd_error *error)
{
    if (count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no report is given");
    TRY(ffd_output_check(output, force, error));
    const unsigned losses = ffd_mapping_losses();
    part *const parts = ffd_alloc_zero(count, sizeof *parts);
    if (!parts)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < count; i++)
        TRY_END(open_part(&parts[i], reports[i], error));
    TRY_END(write_file(parts, count, interleave, losses, output, force, error));
end:
    for (size_t i = 0; i < count; i++)
        ffd_file_unload(&parts[i].file);
    ffd_free(parts);
    /* A report that was written was judged before that. */
    return status ? ffd_mapping_judge(losses, status, error) : FFD_OK;
}
