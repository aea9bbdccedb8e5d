/* fuzz_mesh.h - everything that is done with the bytes of a mesh file. */
#ifndef FFD_TESTS_FUZZ_FUZZ_MESH_H
#define FFD_TESTS_FUZZ_FUZZ_MESH_H

#include <ffd/job.h>
#include <stddef.h>
#include <stdint.h>

/* Opens, describes, checks, deforms and saves the file, and opens what was saved. glTF text may be followed
   by a 0 and the bytes of its buffer "m.bin". A broken promise aborts. */
void fuzz_mesh(ffd_format format, const uint8_t *data, size_t size);
/* Lists the materials of an OBJ file that names the bytes as its library. Beside it is the image "m.png". */
void fuzz_library(const uint8_t *data, size_t size);

#endif
