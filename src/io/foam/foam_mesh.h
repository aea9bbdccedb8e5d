/* foam_mesh.h - the mesh that stands in several files of a folder: points, and beside them faces, owner,
   neighbour, boundary and zones, each of which may be missing. Declares foam_files.c, foam_faces.c,
   foam_cells.c, foam_groups.c. */
#ifndef FFD_IO_FOAM_FOAM_MESH_H
#define FFD_IO_FOAM_FOAM_MESH_H

#include "io/foam/foam_file.h"
#include "io/volume/volume_document.h"
#include "mesh/linked_files.h"

/* The files beside the points, in the order in which they are read. */
typedef enum foam_side {
    FOAM_FACES,
    FOAM_OWNER,
    FOAM_NEIGHBOUR,
    FOAM_BOUNDARY,
    FOAM_POINT_ZONES,
    FOAM_FACE_ZONES,
    FOAM_CELL_ZONES
} foam_side;
#define FOAM_SIDES 7

/* The faces of cells: first those between two cells. */
typedef struct foam_faces {
    foam_labels corners;
    size_t *ends; /* count */
    size_t count, capacity;
    size_t inner; /* how many are between two cells */
} foam_faces;

/* The struct of all documents of this format. */
typedef struct foam_document {
    volume_document volume;
    bool is_there[FOAM_SIDES];
    bool is_uniform; /* all points are one, which the file has once */
} foam_document;

typedef struct foam_reader {
    foam_document *d;
    foam_faces faces;
    foam_labels owner, neighbour;
    uint32_t *stamps; /* of each vertex: the number of the last list that has added it to its group */
    uint32_t stamp;
    ffd_error *error;
} foam_reader;

static inline const uint32_t *foam_corners(const foam_faces *faces, size_t face, size_t *count)
{
    const size_t first = face ? faces->ends[face - 1] : 0;
    *count = faces->ends[face] - first;
    return faces->corners.values + first;
}

/* Takes what a file has behind its header. */
typedef ffd_status foam_take_function(foam_reader *r, foam_file *f);
/* Reads a file beside the points, if it is there. Errors: those of take, and of reading it. */
ffd_status ffd_foam_read_side(foam_reader *r, foam_side side, foam_take_function *take);
/* The entries of the format's table. */
mesh_list_files_function ffd_foam_list_files, ffd_foam_list_images;
mesh_find_named_function ffd_foam_find_named;
/* Notes, as a flaw, which of these files is missing, and what is not known without it; once the cells are
   made. Errors: FFD_E_INVALID, if flaws are refused. */
ffd_status ffd_foam_note_missing(foam_reader *r);

/* Takes the corners of all faces. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
foam_take_function ffd_foam_take_faces;
foam_take_function ffd_foam_take_owner, ffd_foam_take_neighbour;
/* Gives the document its outer faces and its cells, as far as the files tell them. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_foam_make_cells(foam_reader *r);
/* Adds the patches, and the zones, as groups of vertices. Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY.
 */
foam_take_function ffd_foam_take_patches, ffd_foam_take_point_zones, ffd_foam_take_face_zones,
    ffd_foam_take_cell_zones;

#endif
