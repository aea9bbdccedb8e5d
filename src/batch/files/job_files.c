#include "batch/files/job_files.h"
#include "base/file/folder.h"
#include <stdio.h>
#include <string.h>

/* Returns the format that an option of the job gives, or else that of a path. */
static ffd_format format_of(const batch_job *job, const char *option, const char *path)
{
    const char *const value = ffd_job_option(job, option);
    char name[24];
    if (!value)
        return ffd_format_from_name(path);
    snprintf(name, sizeof name, "x.%.20s", value);
    return ffd_format_from_name(name);
}

job_kind ffd_job_kind(const batch_job *job)
{
    job_kind kind = {.input = job->words.data};
    kind.from = format_of(job, "input-format", kind.input);
    kind.to = !job->target  ? FFD_FORMAT_AUTO
              : job->output ? format_of(job, "output-format", job->target)
                            : kind.from;
    kind.source = ffd_format_table(kind.from);
    kind.format = ffd_format_table(kind.to);
    kind.is_kept = kind.format && kind.format == kind.source;
    kind.has_sidecars = kind.format && kind.format->name_sidecar;
    return kind;
}

bool ffd_job_has_copies(const batch_job *job, const job_kind *kind)
{
    const char *const resources = ffd_job_option(job, "resources");
    return job->output && kind->format && kind->is_kept && kind->format->find_resources &&
           !(resources && strcmp(resources, "reference") == 0) &&
           ffd_folders_differ(kind->input, job->target);
}

size_t ffd_job_count_sidecars(const job_kind *kind)
{
    return kind->has_sidecars && !kind->is_kept ? kind->format->count_sidecars(NULL, kind->from, kind->to)
                                                : 0;
}
