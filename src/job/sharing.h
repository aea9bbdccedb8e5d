/* sharing.h - the models that share buffers with the output of a job: those of its folder, its own input, and
   those that the run knows (ffd_output_set). */
#ifndef FFD_JOB_SHARING_H
#define FFD_JOB_SHARING_H

#include "job/report/output_set.h"
#include "mesh/mesh.h"

typedef struct job_sharing {
    const mesh_document *document;
    const char *input;       /* its file */
    known_users own, *known; /* own: of a job without a record of the run */
    bool has_input;          /* the files of the document are among them */
    mesh_sharing sharing;
} job_sharing;

/* Prepares for saving a document. Folders are read when the first file there would be replaced. *used: for
   mesh_save_options; NULL where the output, in the format `to`, has no other files. Call ffd_sharing_end in
   every case. */
void ffd_sharing_begin(job_sharing *sharing, const ffd_deform_desc *desc, const mesh_document *document,
                       const char *output, ffd_format to, const mesh_sharing **used);
/* Frees what belongs to the job. */
void ffd_sharing_end(job_sharing *sharing);

#endif
