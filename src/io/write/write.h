/* write.h - writes a model as a file of a format. target.c finds the writer; each X_write.c is a writer. */
#ifndef FFD_IO_WRITE_WRITE_H
#define FFD_IO_WRITE_WRITE_H

#include "base/file/output.h"
#include "mesh/mesh.h"
#include "mesh/model.h"

typedef struct model_target {
    const char *name;          /* "OBJ" */
    uint32_t holds;            /* a set of model_feature */
    double largest_coordinate; /* the largest that its numbers can hold */
    bool float_texcoords;      /* texture coordinates are float32 */
    bool takes_not_finite;     /* whether readers of the format accept NaN and infinity */
    /* Writes the file, and other files that belong to it, into output. Logs what is stored differently from
       the model without being lost. Written positions do not exceed largest_coordinate, and are finite unless
       takes_not_finite. Errors: FFD_E_LIMIT, FFD_E_MEMORY and those of output. */
    ffd_status (*write)(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error);
} model_target;

/* Returns the target of a format; NULL for FFD_FORMAT_AUTO. */
const model_target *ffd_model_target(ffd_format format);

extern const model_target ffd_obj_target, ffd_ply_target, ffd_off_target, ffd_stl_target, ffd_glb_target,
    ffd_gltf_target;

#endif
