/* report_merge.c - merges several reports into one, for jobs that ran on several machines. */
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "job/report/report_reader.h"
#include <ffd/job.h>
#include <string.h>

/* A report to be joined. What is mapped of it is memory only as long as the system has some to spare. */
typedef struct part {
    file_input file;
    report_reader reader;
} part;

static ffd_status open_part(part *p, const char *path, ffd_error *error)
{
    const ffd_status status = ffd_file_map(path, &p->file, error);
    if (status)
        return status;
    return ffd_report_reader_open(&p->reader, strcmp(path, "-") == 0 ? "standard input" : path, p->file.data,
                                  p->file.size, error);
}

/* Its bytes as they are. Counts it in *written; there may be none left. */
static ffd_status write_next(part *p, file_output *output, uint64_t *written, ffd_error *error)
{
    report_entry_text entry;
    if (!ffd_report_reader_next(&p->reader, &entry))
        return FFD_OK;
    const char *const lead = *written > 0 ? ",\n    " : "\n    ";
    ++*written;
    const ffd_status status = ffd_output_write(output, lead, strlen(lead), error);
    return status ? status : ffd_output_write(output, entry.bytes, entry.size, error);
}

/* Goes through the parts in groups: of each in a group one entry in turn, until there is none left. */
static ffd_status write_entries(part *parts, size_t count, size_t group, file_output *output,
                                uint64_t *written, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t first = 0; !status && first < count; first += group) {
        uint64_t before;
        do {
            before = *written;
            for (size_t i = 0; !status && i < group; i++)
                status = write_next(&parts[first + i], output, written, error);
        } while (!status && *written > before);
    }
    return status;
}

static ffd_status write_report(part *parts, size_t count, size_t group, file_output *output, ffd_error *error)
{
    static const char head[] = "{\n  \"format\": \"ffd-report\",\n  \"version\": 1,\n  \"jobs\": [";
    uint64_t written = 0;
    ffd_status status = ffd_output_write(output, head, sizeof head - 1, error);
    if (!status)
        status = write_entries(parts, count, group, output, &written, error);
    const char *const tail = written > 0 ? "\n  ]\n}\n" : "]\n}\n";
    return status ? status : ffd_output_write(output, tail, strlen(tail), error);
}

static ffd_status write_file(part *parts, size_t count, size_t group, const char *path, bool force,
                             ffd_error *error)
{
    file_output *output = NULL;
    ffd_status status = ffd_output_create(&output, error);
    if (!status)
        status = ffd_output_begin(output, path, force, error);
    if (!status)
        status = write_report(parts, count, group, output, error);
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

ffd_status ffd_report_merge_run(const char *const *reports, size_t count, bool interleave, const char *output,
                                bool force, ffd_error *error)
{
    if (count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no report is given");
    ffd_status status = ffd_output_check(output, force, error);
    if (status)
        return status;
    part *const parts = ffd_alloc_zero(count, sizeof *parts);
    if (!parts)
        return ffd_fail_memory(error);
    for (size_t i = 0; !status && i < count; i++)
        status = open_part(&parts[i], reports[i], error);
    if (!status)
        status = write_file(parts, count, interleave ? count : 1, output, force, error);
    for (size_t i = 0; i < count; i++)
        ffd_file_unload(&parts[i].file);
    ffd_free(parts);
    return status;
}
