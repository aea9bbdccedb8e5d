/* resource_bring.h - copies the files that a text format names beside its output, and warns about those that
   the output does not reach. */
#ifndef FFD_MESH_RESOURCE_RESOURCE_BRING_H
#define FFD_MESH_RESOURCE_RESOURCE_BRING_H

#include "mesh/resource/resource_copy.h"

/* Copies the sorted files of a list beside the output, or (copies false) warns of those that the output does
   not reach. What cannot be copied is named in a warning. is_stay: mesh and output are in one folder, so that
   nothing is done but the check: target, the output's path, may not be that of a file or of its copy.
   Errors: FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_resources_bring(const resource_copier *copier, const resource_list *list, bool copies,
                               bool is_stay, const char *target, ffd_error *error);

#endif
