/* reads.h - the files that a job reads: its outputs must not replace them. The other files that the job
   itself names are checked by each command. */
#ifndef FFD_JOB_READS_H
#define FFD_JOB_READS_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Returns whether a mesh is the file at a path. */
bool ffd_job_reads_mesh(const ffd_source *source, const char *path);
/* Returns whether the embedding of a job is that file. */
bool ffd_job_reads_embedding(const ffd_deform_desc *desc, const char *path);
/* Returns the file of the job's weights; NULL: there is none. */
const char *ffd_job_weight_file(const ffd_deform_desc *desc);
/* Returns whether it is that file. */
bool ffd_job_reads_weights(const ffd_deform_desc *desc, const char *path);
/* Returns whether one of the lattices (NULL: there are none) is the file at a path. */
bool ffd_job_reads_lattice(const ffd_lattice_source *lattices, size_t count, const char *path);
/* Refuses (FFD_E_EXISTS) an output in the place of a file that a mesh names: a buffer, an image, a material
   library, a file of an extension. document: the open mesh; NULL: its file is read, if there is something to
   replace. */
ffd_status ffd_job_check_mesh_files(const char *output, const ffd_source *source,
                                    const mesh_document *document, ffd_error *error);
/* The same for the meshes that the box of a lattice goes round, and their buffers, which box_files has. */
ffd_status ffd_job_check_box(const char *output, const path_list *box_files,
                             const ffd_lattice_source *lattice, ffd_error *error);
/* The same for all lattices of a chain. */
ffd_status ffd_job_check_box_files(const char *output, const lattice_chain *chain,
                                   const ffd_lattice_source *lattices, ffd_error *error);

#endif
