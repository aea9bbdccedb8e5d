/* formats.h - the formats of lattices: which there are, and what each of them can hold. Their readers and
   writers are in readers.h, so that who asks for names does not link them. */
#ifndef FFD_LATTICE_FORMATS_FORMATS_H
#define FFD_LATTICE_FORMATS_FORMATS_H

#include "lattice/formats/format_spec.h"

/* What holds of a format, combined with |. */
typedef enum format_trait {
    FORMAT_IS_READ = 1,
    FORMAT_IS_WRITTEN = 2,
    FORMAT_HOLDS_BOTH = 4,    /* the states at rest and deformed */
    FORMAT_HOLDS_ALL = 8,     /* knots and weights too */
    FORMAT_TAKES_SIZE = 16,   /* a file may not tell its size */
    FORMAT_TAKES_DEGREE = 32, /* a file may not tell its degrees */
    FORMAT_TAKES_ORDER = 64,  /* a file may have its directions in another order */
    FORMAT_TAKES_BLOCK = 128, /* a file may have several lattices */
    FORMAT_SHOWS = 256,       /* it is to look at: nobody expects the rest of a lattice in it */
    FORMAT_GOES_ON = 512      /* its program's lattices act beyond their box, and z is up there */
} format_trait;

typedef enum format_kind {
    FORMAT_JSON,
    FORMAT_CSV,
    FORMAT_NPY,
    FORMAT_PLOT3D,
    FORMAT_PRM,
    FORMAT_SU2,
    FORMAT_VTK,
    FORMAT_VTS,
    FORMAT_CAGE,
    FORMAT_NPZ,
    FORMAT_BLENDER_JSON,
    FORMAT_PREVIEW,
    FORMAT_KINDS
} format_kind;

typedef struct lattice_format {
    format_kind kind;
    const char *ending; /* ".csv" */
    const char *what;   /* "a table", for messages */
    unsigned traits;
} lattice_format;

/* Returns the format of a file name by its ending; "-" is JSON. NULL: it is none. */
const lattice_format *ffd_lattice_format(const char *name);
/* Returns the format of a file whose ending is .json: a lattice file, or that of an add-on of Blender. */
const lattice_format *ffd_format_of_json(bool is_blender);
/* Room for the endings of all formats. */
#define FORMAT_ENDINGS 120
/* Writes the endings of the formats that are read, or that are written: ".json, .csv or .npy". */
void ffd_format_endings(bool written, char text[FORMAT_ENDINGS]);
/* Refuses what the format has no use for. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_format_check_wish(const lattice_format *format, const char *name, const format_wish *wish,
                                 ffd_error *error);

#endif
