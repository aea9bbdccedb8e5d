/* job_description.h - a default description of a job, for tests to change. */
#ifndef FFD_TESTS_JOB_DESCRIPTION_H
#define FFD_TESTS_JOB_DESCRIPTION_H

#include <ffd/job.h>

/* One lattice, one thread, force. */
static inline ffd_deform_desc describe_job(const char *mesh, const char *output,
                                           const ffd_lattice_source *lattices)
{
    ffd_deform_desc desc;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = mesh;
    desc.output = output;
    desc.lattices = lattices;
    desc.lattice_count = 1;
    desc.threads = 1;
    desc.force = true;
    return desc;
}

#endif
