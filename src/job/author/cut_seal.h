/* cut_seal.h - the faces of a lattice that meshes cut, for a job that makes a lattice. */
#ifndef FFD_JOB_AUTHOR_CUT_SEAL_H
#define FFD_JOB_AUTHOR_CUT_SEAL_H

#include "job/author/author_job.h"
#include "job/pass/cut_faces.h"

/* Finds the faces that any of the job's meshes cuts, and counts its vertices outside (ffd_cut_faces_find).
   The lattice has positions. Errors: those of reading a mesh, of ffd_locator_create and of
   ffd_cut_faces_find. */
ffd_status ffd_author_find_cut(const author_job *job, ffd_lattice *lattice, cut_faces *cut, ffd_error *error);

#endif
