#include "cli/commands.h"

const cli_command *const cli_commands[] = {&cli_deform,         &cli_batch,        &cli_check,
                                           &cli_embed,          &cli_compare,      &cli_info,
                                           &cli_view,           &cli_edit,         &cli_jacobian,
                                           &cli_animate,        &cli_fit,          &cli_lattice_new,
                                           &cli_lattice_refine, &cli_lattice_set,  &cli_lattice_convert,
                                           &cli_report_merge,   &cli_report_junit, NULL};
