/* check_animations.h - what holds for the animations of any glTF file that opens. */
#ifndef FFD_TESTS_FUZZ_CHECK_ANIMATIONS_H
#define FFD_TESTS_FUZZ_CHECK_ANIMATIONS_H

#include "mesh/mesh.h"

/* Loads each animation of a glTF file that is open in scene space, or it is refused; every value between its
   keys is finite, and the document's memory is given back. A broken promise aborts. */
void check_animations(mesh_document *document);

#endif
