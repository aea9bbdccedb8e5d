#include "batch/files/job_files.h"
#include "base/file/folder.h"

/* Returns the format that a job gives, or else that of a path. */
static ffd_format format_of(ffd_format given, const char *path)
{
    return given != FFD_FORMAT_AUTO ? given : ffd_format_from_name(path);
}

job_kind ffd_job_kind(const batch_job *job)
{
    job_kind kind = {.input = job->desc.input.path};
    kind.from = format_of(job->desc.input.format, kind.input);
    kind.to = !job->target  ? FFD_FORMAT_AUTO
              : job->output ? format_of(job->desc.output_format, job->target)
                            : kind.from;
    kind.source = ffd_format_table(kind.from);
    kind.format = ffd_format_table(kind.to);
    kind.is_kept = kind.format && kind.format == kind.source;
    kind.has_sidecars = kind.format && kind.format->sidecars && kind.format->sidecars->count;
    return kind;
}

bool ffd_job_has_copies(const batch_job *job, const job_kind *kind)
{
    return job->output && kind->format && kind->is_kept && kind->format->resources &&
           job->desc.resources != FFD_RESOURCES_REFERENCE && ffd_folders_differ(kind->input, job->target);
}

size_t ffd_job_count_sidecars(const job_kind *kind)
{
    return kind->has_sidecars && !kind->is_kept ? kind->format->sidecars->count(NULL, kind->from, kind->to)
                                                : 0;
}
