/* run_files.h - the files that the jobs of a run read and write: what each command must know of the others.
   Files are known by their places (base/file/place.h), so that one has the same entry under all its names,
   before and after it is replaced. */
#ifndef FFD_BATCH_FILES_RUN_FILES_H
#define FFD_BATCH_FILES_RUN_FILES_H

#include "base/file/file_users.h"
#include "base/file/input.h"
#include "base/memory/file_table.h"
#include "batch/manifest/batch_job.h"
#include <ffd/job.h>

/* An image or material library that is copied with an output. */
typedef struct copied_file {
    char *source;
    uint64_t line; /* of the first job that copies it */
} copied_file;

/* The first two files of a list that jobs write, each by another job: every job has a conflict with one of
   them, but the job of a single one. */
typedef struct read_conflicts {
    size_t count;
    size_t files[2];
    uint64_t lines[2];
} read_conflicts;

/* What a worker has found in a mesh: the files that it names, and what its output has beside it. */
typedef struct mesh_scan {
    char *input; /* path of the mesh; NULL: none */
    ffd_format from, to;
    file_stamp stamp;
    size_t sidecars;          /* number of files beside the output */
    path_list named, copies;  /* copies: those that may be copied with the output */
    read_conflicts conflicts; /* of named */
} mesh_scan;

/* The files of the meshes that the box of a lattice goes round. */
typedef struct known_lattice {
    path_list files;
    read_conflicts conflicts;
} known_lattice;

/* The lattices that workers have scanned. */
typedef struct known_lattices {
    intern_table paths;
    known_lattice *list; /* one for each path */
    size_t capacity;
} known_lattices;

/* Paths whose places are remembered. */
enum { PLACES_KEPT = 8 };

typedef struct kept_place {
    char *path; /* NULL: empty */
    hash128 place;
} kept_place;

/* The folders that outputs are written to. */
typedef struct output_folders {
    intern_table exact; /* their places, */
    intern_table known; /* and with those of all folders above them */
    char *last;         /* the folder that was added last */
    char *asked;        /* the folder that was asked for last, */
    bool holds_outputs; /* and the answer */
} output_folders;

/* Whether the models of a folder of outputs are among the users. */
typedef enum folder_survey {
    SURVEY_NONE,  /* not asked for */
    SURVEY_ASKED, /* a worker scans */
    SURVEY_DONE,
    SURVEY_FAILED /* each job scans by itself */
} folder_survey;

typedef struct surveyed_folders {
    intern_table places;
    uint8_t *states; /* folder_survey of each */
    size_t capacity;
} surveyed_folders;

/* All zeros: none. */
typedef struct run_files {
    const char *manifest; /* for messages; NULL: jobs have no lines */
    const char *base;     /* folder that places are seen from in the journal, without links */
    bool comes_once;      /* outputs of later jobs are not known */
    bool has_odd_outputs; /* some have not the ending of a mesh, or images and libraries are copied */
    file_places places;
    kept_place kept[PLACES_KEPT]; /* of files that jobs read */
    size_t next_kept;
    file_table writes; /* line of the job that writes each file; 0: the run itself */
    file_table reads;  /* line of the first job that reads it */
    file_table copies; /* index in `copied` of each target of a copy */
    copied_file *copied;
    size_t copied_count, copied_capacity;
    output_folders folders;
    mesh_scan scan; /* of the last mesh that was scanned */
    known_lattices lattices;
    file_users users; /* models that name buffers: those of jobs, and those of folders of outputs: */
    surveyed_folders surveyed;
} run_files;

/* Returns the place of a file that is written. */
hash128 ffd_run_place(run_files *files, const char *path);
/* Returns the place of a file that is read, as many others are by the same path. */
hash128 ffd_run_read_place(run_files *files, const char *path);
/* Whether a job writes a file, as an output or as a copy, or the run does. *line: of that job; 0: the run. */
bool ffd_run_writer(const run_files *files, const hash128 *file, uint64_t *line);
/* Stores in a job that a file which it reads or writes is written by the job of a line (0: the run) too.
   role: what the file is for the job, with a blank; or "". */
void ffd_run_refuse(const run_files *files, batch_job *job, const char *role, const char *file,
                    uint64_t line);
/* Stores in a job that a file which it writes is read by the job of a line. */
void ffd_run_refuse_written(const run_files *files, batch_job *job, const char *file, uint64_t line);
/* Stores in a job that it reads one of these files, unless it is the job that writes it. role: as above. */
void ffd_run_refuse_conflict(const run_files *files, batch_job *job, const char *role, const path_list *list,
                             const read_conflicts *conflicts);
/* Notes a file that the run itself reads, so that no job replaces it. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_keep(run_files *files, const char *path, ffd_error *error);
/* Reserves a file that the run itself writes. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_reserve(run_files *files, const char *path, ffd_error *error);
/* Adds the folder of an output. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_add_folder(run_files *files, const char *output, ffd_error *error);
/* Whether an output may be in the folder of a file or below, or copied files may be. */
bool ffd_run_writes_near(run_files *files, const char *path);
/* Returns how far the models of the folder of an output are known. */
folder_survey ffd_run_survey(run_files *files, const char *output);
/* Sets that. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_set_survey(run_files *files, const char *output, folder_survey state, ffd_error *error);
/* Frees everything; leaves all zeros. */
void ffd_run_files_free(run_files *files);

#endif
