/* mesh_boxes.h - boxes round the meshes that lattice files name ("box": {"meshes": [..]}). They are kept from
   job to job while the files stay as they are. */
#ifndef FFD_JOB_CHAIN_MESH_BOXES_H
#define FFD_JOB_CHAIN_MESH_BOXES_H

#include "base/file/input.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>
#include <ffd/lattice.h>

typedef struct mesh_box {
    path_list meshes;
    ffd_space space;
    hash128 rules;      /* by which they are read (ffd_source_rules) */
    path_list files;    /* that the meshes were read from */
    file_stamp *stamps; /* files.count */
    size_t stamp_count, stamp_capacity;
    ffd_bounds bounds;
    path_list warnings; /* lines that tell the meshes' flaws */
} mesh_box;

/* How many boxes are kept. */
enum { MESH_BOXES = 8 };

/* All zeros: none. */
typedef struct mesh_boxes {
    mesh_box boxes[MESH_BOXES];
    size_t next; /* to be replaced */
} mesh_boxes;

/* Finds the bounds that the meshes of a lattice file have, adds their files to files, and says their flaws in
   log, which may be NULL. like: how they are read (its path and format are not used). Errors: those of
   reading them. */
ffd_status ffd_mesh_box_find(mesh_boxes *kept, const ffd_lattice *lattice, const ffd_source *like,
                             ffd_bounds *bounds, path_list *files, const mesh_log *log, ffd_error *error);
/* Leaves no boxes. */
void ffd_mesh_boxes_free(mesh_boxes *kept);

#endif
