/* conversion.h - saves a document in a different format. */
#ifndef FFD_JOB_CONVERSION_H
#define FFD_JOB_CONVERSION_H

#include "mesh/mesh.h"

/* Whether saving in a format needs a conversion. .gltf and .glb are one format. */
bool ffd_conversion_needed(const mesh_document *document, ffd_format format);

/* Returns whether meshes of a format cannot become those of another one. */
bool ffd_conversion_keeps(ffd_format format);
/* Refuses a conversion that this build does not support (FFD_E_UNSUPPORTED). */
ffd_status ffd_conversion_check(const mesh_document *document, ffd_format format, ffd_error *error);

/* A conversion whose deformation becomes a morph target. base: the model before the document had results; it
   is consumed. name: of the new target; NULL: base has its targets already. */
typedef struct conversion_morph {
    const char *name;
    mesh_model *base;
} conversion_morph;

/* Writes the document with its results into output, or, if morph is not NULL, with a morph target. Warns of
   what the format cannot hold. Errors: FFD_E_INVALID (a coordinate is too large for the format's number type;
   the message names the file), FFD_E_LIMIT. */
ffd_status ffd_conversion_save(const mesh_document *document, mesh_state state, const conversion_morph *morph,
                               const mesh_save_options *options, file_output *output, const mesh_log *log,
                               ffd_error *error);

#endif
