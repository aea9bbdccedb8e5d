/* readers.h - the readers and writers of all formats but JSON (data/schema/lattice.md 12), by their kind in
   readers.c: csv.c, npy.c, plot3d.c, prm.c, su2.c, cage.c, vtk.c, vts.c, blender_npz.c, blender_json.c,
   preview.c. */
#ifndef FFD_LATTICE_FORMATS_READERS_H
#define FFD_LATTICE_FORMATS_READERS_H

#include "base/file/input.h"
#include "base/file/output.h"
#include "lattice/formats/formats.h"
#include "lattice/lattice.h"

/* Reads a lattice. name: for messages. The caller frees *spec, also after a failure. Errors: FFD_E_INVALID,
   of text with the line; FFD_E_UNSUPPORTED, FFD_E_ARGUMENT, FFD_E_LIMIT, FFD_E_MEMORY. */
typedef ffd_status format_reader(const file_input *file, const char *name, const format_wish *wish,
                                 lattice_spec **spec, ffd_error *error);
/* Writes a lattice with control points into an output that has begun: both states, or if the format holds
   one, that at rest. Errors: FFD_E_IO, FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
typedef ffd_status format_writer(const ffd_lattice *lattice, file_output *output, ffd_error *error);

format_reader ffd_lattice_read_csv, ffd_lattice_read_npy, ffd_lattice_read_plot3d, ffd_lattice_read_prm,
    ffd_lattice_read_su2, ffd_lattice_read_cage, ffd_lattice_read_vtk, ffd_lattice_read_vts,
    ffd_lattice_read_npz, ffd_lattice_read_blender_json;
format_writer ffd_lattice_write_csv, ffd_lattice_write_npy, ffd_lattice_write_plot3d, ffd_lattice_write_prm,
    ffd_lattice_write_cage, ffd_lattice_write_vtk, ffd_lattice_write_vts, ffd_lattice_write_preview;

/* Returns the reader of a format; NULL: it is JSON, or is not read. */
format_reader *ffd_format_reader(const lattice_format *format);
/* Returns its writer; NULL: it is JSON, or is not written. */
format_writer *ffd_format_writer(const lattice_format *format);

#endif
