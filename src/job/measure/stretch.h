/* stretch.h - parts that an animation turns, and how unevenly the deformation stretches them: a wheel that is
   no longer round wobbles as it turns (src/maths.md 9.8). */
#ifndef FFD_JOB_MEASURE_STRETCH_H
#define FFD_JOB_MEASURE_STRETCH_H

#include "mesh/mesh.h"
#include "mesh/places.h"

typedef struct turned_parts {
    uint32_t *nodes;  /* of each vertex, as in mesh_find_turned_function; NULL: nothing turns */
    float *stretches; /* as in mesh_pass, filled by the pass; NaN where nothing is known */
} turned_parts;

/* Finds what animations turn. Without memory for it in the budget, nothing is looked at. Call
   ffd_turned_parts_free in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_turned_parts_find(mesh_document *document, turned_parts *turned, ffd_error *error);
/* Frees the arrays; leaves none. */
void ffd_turned_parts_free(turned_parts *turned);

/* Warns, in one line, of the parts that are stretched unevenly: it names the worst. Call it after the pass.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_turned_parts_warn(const mesh_document *document, const turned_parts *turned,
                                 const mesh_log *log, ffd_error *error);

#endif
