/* write.h - writes a model as a file of a format. */
#ifndef FFD_IO_WRITE_WRITE_H
#define FFD_IO_WRITE_WRITE_H

#include "base/file/output.h"
#include "mesh/mesh.h"
#include "mesh/model.h"

typedef struct model_target {
    const char *name;          /* "OBJ" */
    uint32_t holds;            /* of model_feature */
    double largest_coordinate; /* that its numbers can hold */
    /* Writes the file (and what belongs to it) into output. Positions are finite and not larger than
       largest_coordinate. Errors: FFD_E_LIMIT, FFD_E_MEMORY and those of output. */
    ffd_status (*write)(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        ffd_error *error);
} model_target;

/* NULL for FFD_FORMAT_AUTO. */
const model_target *ffd_model_target(ffd_format format);

extern const model_target ffd_obj_target, ffd_ply_target, ffd_off_target, ffd_stl_target, ffd_glb_target,
    ffd_gltf_target;

#endif
