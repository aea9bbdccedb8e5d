/* conversion.h - saves a document in another format than its own. */
#ifndef FFD_JOB_CONVERSION_H
#define FFD_JOB_CONVERSION_H

#include "mesh/mesh.h"

/* Whether the document's own format writes another one. .gltf and .glb are one format. */
bool ffd_conversion_needed(const mesh_document *document, ffd_format format);

/* Refuses (FFD_E_UNSUPPORTED) a conversion that this build does not have. */
ffd_status ffd_conversion_check(const mesh_document *document, ffd_format format, ffd_error *error);

/* The deformation becomes a morph target of this name (NULL: base has its targets), and the shape is that of
   base, which the document's model was before it had results; base is taken. */
typedef struct conversion_morph {
    const char *name;
    mesh_model *base;
} conversion_morph;

/* Writes the document with its results, or with a morph target where morph is not NULL, into output, and
   warns of what the target cannot hold. Errors: FFD_E_INVALID, with the file, for a coordinate that is too
   large for the target's numbers; FFD_E_LIMIT. */
ffd_status ffd_conversion_save(const mesh_document *document, const conversion_morph *morph,
                               const mesh_save_options *options, file_output *output, const mesh_log *log,
                               ffd_error *error);

#endif
