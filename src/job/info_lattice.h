/* info_lattice.h - what `ffd info` says of a lattice file. */
#ifndef FFD_JOB_INFO_LATTICE_H
#define FFD_JOB_INFO_LATTICE_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends the members that describe the lattice file to an open JSON object. Errors: those of reading it, and
   FFD_E_INVALID for a value that no placeholder of it takes. */
ffd_status ffd_info_lattice(const ffd_info_desc *desc, json_text *json, ffd_error *error);

#endif
