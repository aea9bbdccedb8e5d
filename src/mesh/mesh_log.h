/* mesh_log.h - the log of a mesh. */
#ifndef FFD_MESH_MESH_LOG_H
#define FFD_MESH_MESH_LOG_H

#include "base/fail.h"
#include <ffd/job.h>

typedef struct mesh_log {
    ffd_log_function function; /* may be NULL */
    void *user;
} mesh_log;

/* A log for one of several morph targets. */
typedef struct mesh_log_label {
    mesh_log log; /* log that receives the lines */
    char name[80];
} mesh_log_label;

/* Returns a log that adds the name of the morph target before each line. It is valid as long as label, which
   is filled. */
mesh_log ffd_log_morph(const mesh_log *log, const char *name, mesh_log_label *label);

/* Writes a line to a log. Does nothing if the log is NULL or has no function. */
void ffd_log_line(const mesh_log *log, ffd_log_level level, const char *format, ...) FFD_PRINTF(3, 4);

#endif
