/* morphs.h - the options --morph and --clip. */
#ifndef FFD_CLI_MORPHS_H
#define FFD_CLI_MORPHS_H

#include "cli/job.h"

/* Setters of a cli_job. */

/* Adds NAME=LATTICE as a morph target. */
bool cli_add_morph(void *settings, const cli_option *option, const char *value);
/* Adds an animation of weights. */
bool cli_add_clip(void *settings, const cli_option *option, const char *value);

/* Sets the morph targets of desc. Returns false if memory runs out, after a complaint. */
bool cli_morphs_describe(cli_job *job, ffd_deform_desc *desc);

#endif
