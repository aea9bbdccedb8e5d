/* run_frames.h - the frames that pictures of jobs on one mesh have in common (--view), and the jobs that have
   ended and wait until these are known. */
#ifndef FFD_BATCH_RUN_FRAMES_H
#define FFD_BATCH_RUN_FRAMES_H

#include "base/file/record_queue.h"
#include "base/memory/intern.h"
#include "batch/pool.h"

/* The jobs on one mesh whose pictures are drawn with equal options. */
typedef struct frame_group {
    uint64_t first, count; /* index of the first job, and how many there are */
    view_frame frame;      /* of those that are not far away */
} frame_group;

/* The jobs on one mesh. */
typedef struct frame_mesh {
    uint64_t jobs;
    uint32_t most; /* index of the group with the most jobs, and of these with the first one */
} frame_mesh;

/* The names that a warning tells. */
#define FRAMES_NAMED 4

/* All zeros: jobs do not wait. */
typedef struct run_frames {
    bool are_common;        /* jobs on one mesh have one */
    bool wait;              /* pictures are drawn when the last job has ended */
    bool are_drawn;         /* it has, */
    bool all_made;          /* and no job was dropped */
    intern_table mesh_keys; /* places */
    frame_mesh *meshes;
    size_t mesh_capacity;
    intern_table group_keys; /* mesh and look (group_key) */
    frame_group *groups;
    size_t group_capacity;
    record_queue tasks;     /* that wait, in the order of the jobs */
    byte_buffer record;     /* scratch memory */
    uint64_t pictures;      /* to be drawn */
    uint64_t left;          /* that have frames of their own, unlike others */
    byte_buffer left_names; /* of the first of these */
} run_frames;

/* Returns a hash of what a picture shows: shown (pool_task) and its frame. */
hash128 ffd_frame_hash(const hash128 *shown, const view_frame *frame);
/* Adds the frame of a job that has ended. mesh: its place. Errors: FFD_E_MEMORY. */
ffd_status ffd_frames_add(run_frames *frames, pool_task *task, const hash128 *mesh, ffd_error *error);
/* Sets the frame that the picture of a job is to be drawn with (order), and own_frame, when all jobs have
   been added. */
void ffd_frames_choose(run_frames *frames, pool_task *task);
/* Lets a job wait; the caller frees the task. Errors: FFD_E_MEMORY. */
ffd_status ffd_frames_put(run_frames *frames, const pool_task *task, ffd_error *error);
/* Takes the next job, into a task of zeros. *found: false if there is none. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_frames_take(run_frames *frames, pool_task *task, bool *found, ffd_error *error);
/* Fills a warning of the pictures that have frames of their own. Returns false if there are none. */
bool ffd_frames_warn(const run_frames *frames, const char *name, ffd_error *note);
/* Frees everything; leaves all zeros. */
void ffd_frames_free(run_frames *frames);

#endif
