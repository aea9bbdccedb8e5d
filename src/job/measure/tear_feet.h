/* tear_feet.h - the point of a lattice's volume whose displacement a place gets: its foot. Internal to
   tear_field.h. */
#ifndef FFD_JOB_MEASURE_TEAR_FEET_H
#define FFD_JOB_MEASURE_TEAR_FEET_H

#include "job/measure/tear_place.h"

typedef struct field_foot {
    bool found;  /* false: none acts; the other members are not set */
    bool inside; /* the volume holds the place; else the foot is the nearest point of the border */
    size_t link;
    bool on_seam;         /* it was moved there, and the displacement does not follow the place */
    boundary_point point; /* inside: only its u,v,w are set */
} field_foot;

/* Finds the border point of a link that is nearest to x, within the link's falloff. Errors: FFD_E_MEMORY. */
ffd_status ffd_foot_on_border(const tear_field *field, size_t link, const double x[3], field_foot *foot,
                              ffd_error *error);
/* Computes the displacement at a foot, and its derivative by the place. */
void ffd_foot_displacement(const tear_field *field, const field_foot *foot, double delta[3],
                           double gradient[9]);
/* Adjusts the feet of two neighbouring places in one link. Beside a seam both are moved onto it, each on its
   own face. Where points outside stay, and a place is outside, one foot serves for both unless a seam is
   between. */
void ffd_feet_join(const tear_field *field, field_foot *first, field_foot *second);
/* Returns why the displacements at two neighbouring feet of a link may differ. */
ffd_tear_cause ffd_feet_cause(const tear_field *field, const field_foot *first, const field_foot *second);

#endif
