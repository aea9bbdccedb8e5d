/* mesh_boxes.h - boxes round the meshes that lattice files name ("box": {"meshes": [..]}), cached from job to
   job while the files do not change. */
#ifndef FFD_JOB_CHAIN_MESH_BOXES_H
#define FFD_JOB_CHAIN_MESH_BOXES_H

#include "base/file/input.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include "lattice/lattice.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>
#include <ffd/lattice.h>

typedef struct mesh_box {
    path_list meshes;
    ffd_space space;
    hash128 rules;      /* of the options with which they were read (ffd_source_rules) */
    path_list files;    /* read for this box */
    file_stamp *stamps; /* files.count entries */
    size_t stamp_count, stamp_capacity;
    fit_extent extent;
    path_list warnings; /* about flaws of the meshes */
} mesh_box;

/* Boxes in the cache. */
enum { MESH_BOXES = 8 };

/* All zeros: empty. */
typedef struct mesh_boxes {
    mesh_box boxes[MESH_BOXES];
    size_t next; /* index of the one to replace next */
} mesh_boxes;

/* Finds the extent of the meshes that a lattice file names. Adds the files read to `files`, and logs flaws of
   the meshes in `log` (may be NULL). like: options for reading them; its path and format are ignored. Errors:
   those of reading the meshes. */
ffd_status ffd_mesh_box_find(mesh_boxes *kept, const ffd_lattice *lattice, const ffd_source *like,
                             fit_extent *extent, path_list *files, const mesh_log *log, ffd_error *error);
/* Frees all boxes. */
void ffd_mesh_boxes_free(mesh_boxes *kept);

#endif
