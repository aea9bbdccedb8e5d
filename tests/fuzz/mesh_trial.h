/* mesh_trial.h - how a fuzz target opens the bytes of a mesh, and deforms them. */
#ifndef FFD_TESTS_FUZZ_MESH_TRIAL_H
#define FFD_TESTS_FUZZ_MESH_TRIAL_H

#include "mesh/mesh.h"
#include "work_folder.h"

typedef struct trial {
    ffd_format format;
    ffd_space space;
    ffd_normals normals;
    ffd_rig rig;
    bool is_quantized;          /* some positions of the input are whole numbers */
    const char *input, *output; /* names in the work folder */
    char lattice[WORK_PATH];
} trial;

bool trial_is_gltf(ffd_format format);
/* What any file may be refused with, in one line. */
void trial_refusal(ffd_status status, const ffd_error *error);
/* Opens bytes in a block of their own size, so that reading past the end is seen; *block lends it, where
   block is not NULL. NULL: refused, *error says why. */
mesh_document *trial_open(const trial *of, const char *name, const uint8_t *data, size_t size,
                          unsigned char **block, ffd_error *error);
/* The same of what was accepted before. */
mesh_document *trial_open_again(const trial *of, const char *name, const uint8_t *data, size_t size);
/* Deforms the document by of->lattice, saves it as of->output, and closes it. False: refused. */
bool trial_deform(const trial *of, mesh_document *document, uint64_t *moved);

#endif
