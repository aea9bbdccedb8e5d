/* info_lattice.h - describes a lattice file for `ffd info`. */
#ifndef FFD_JOB_INFO_LATTICE_H
#define FFD_JOB_INFO_LATTICE_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends the members that describe the lattice file to an open JSON object. Errors: those of loading it, and
   FFD_E_INVALID for a value without a placeholder. */
ffd_status ffd_info_lattice(const ffd_info_desc *desc, json_text *json, ffd_error *error);

#endif
