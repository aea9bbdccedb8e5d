#include "batch/manifest/job_memory.h"
#include "base/file/input.h"
#include "base/text/size.h"
#include "mesh/memory_budget.h"
#include <string.h>

uint64_t ffd_job_memory(const batch_job *job, bool draws)
{
    const char *const option = ffd_job_option(job, "memory"), *word = job->words.data;
    uint64_t asked = 0;
    if (option && !ffd_size_parse(option, &asked))
        asked = 0; /* the job is refused */
    memory_budget budget = ffd_budget_make(draws && asked == 0 ? LEAST_VIEW_MEMORY : asked);
    for (size_t i = 0; i < job->word_count; i++, word += strlen(word) + 1) {
        const char *const path = i == 0 ? word : ffd_word_lattice(word);
        file_stamp stamp;
        if (path && ffd_file_stamp(path, &stamp))
            ffd_budget_add_file(&budget, stamp.size, 0);
    }
    return ffd_budget_most(&budget);
}
