/* blender.h - a lattice object of Blender, and the one of this program that does the same inside and outside
   (blender.c; data/blender/ffd_lattice_math.py has the same for scripts in Blender, and tests/blender
   compares them); the files in which add-ons keep it (blender_npz.c, blender_json.c). */
#ifndef FFD_LATTICE_FORMATS_BLENDER_H
#define FFD_LATTICE_FORMATS_BLENDER_H

#include "base/file/input.h"
#include "base/text/text_scan.h"
#include "lattice/formats/format_spec.h"

typedef enum blender_type {
    BLENDER_LINEAR,
    BLENDER_CARDINAL,
    BLENDER_CATMULL_ROM,
    BLENDER_BSPLINE
} blender_type;

typedef struct blender_lattice {
    size_t size[3];
    blender_type type[3];
    double first[3], step[3];                  /* its points at rest: first + i step, in its own space */
    double rotation[9], location[3], scale[3]; /* to the world: rotation by rows */
    double *offsets;                           /* 3 a point, u fastest, in its own space */
} blender_lattice;

/* Finds the type of a word, "KEY_LINEAR". Returns false if there is none of this name. */
bool ffd_blender_type(text_word word, blender_type *type);
/* Sets the rotation of a quaternion w, x, y, z, which need not have the length 1. Returns false if it is 0.
 */
bool ffd_blender_turn(const double quaternion[4], double rotation[9]);
/* Whether a file is JSON of the add-on, not a lattice file. */
bool ffd_blender_is_json(const file_input *file);
/* Makes the spec of the lattice. Errors: FFD_E_INVALID for a scale of 0, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_blender_make(const blender_lattice *from, const char *name, const format_wish *wish,
                            lattice_spec **spec, ffd_error *error);

#endif
