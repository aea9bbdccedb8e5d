/* formats.h - the table of mesh formats. */
#ifndef FFD_IO_FORMATS_H
#define FFD_IO_FORMATS_H

#include "mesh/mesh.h"

/* For messages. */
#define FORMAT_NAMES "obj, gltf, glb, ply, off or stl"

extern const mesh_format ffd_obj_format;  /* io/obj */
extern const mesh_format ffd_ply_format;  /* io/ply */
extern const mesh_format ffd_off_format;  /* io/off */
extern const mesh_format ffd_stl_format;  /* io/stl */
extern const mesh_format ffd_gltf_format; /* io/gltf: .gltf and .glb */

/* The table for a format; NULL for FFD_FORMAT_AUTO. */
const mesh_format *ffd_format_table(ffd_format format);

#endif
