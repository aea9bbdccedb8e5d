/* report_figures.h - the figures of a job as members of a report's entry (data/schema/formats.md 2), as the
   table of figures says (job/figures). */
#ifndef FFD_JOB_REPORT_REPORT_FIGURES_H
#define FFD_JOB_REPORT_REPORT_FIGURES_H

#include "json/json_text.h"
#include "json/json_tree.h"
#include <ffd/result.h>

/* Writes all figures; stable: without times. */
void ffd_figures_write(json_text *json, const ffd_job_result *result, bool stable);
/* Writes the member `folds` of any entry. */
void ffd_figures_write_folds(json_text *json, const ffd_folds *folds);
/* Writes null for the figures that every entry has, of a job that was not run. */
void ffd_figures_write_unknown(json_text *json);
/* Reads the counts, numbers and names of an entry. A number that it does not have becomes NaN. Texts and
   arrays are left out. */
void ffd_figures_read(const json_tree *tree, uint32_t entry, ffd_job_result *result);

#endif
