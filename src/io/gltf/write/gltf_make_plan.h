/* gltf_make_plan.h - makes the plan of saving. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_MAKE_PLAN_H
#define FFD_IO_GLTF_WRITE_GLTF_MAKE_PLAN_H

#include "io/gltf/write/gltf_plan.h"

/* Makes the plan. plan->version_count is 0 if no value changed. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_make_plan(const gltf_document *document, gltf_plan *plan, ffd_error *error);

#endif
