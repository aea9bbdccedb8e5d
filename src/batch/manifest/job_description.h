/* job_description.h - what a job says, in a line of a manifest or a row of a table, before it becomes words
   of a command. */
#ifndef FFD_BATCH_MANIFEST_JOB_DESCRIPTION_H
#define FFD_BATCH_MANIFEST_JOB_DESCRIPTION_H

#include "base/text/buffer.h"
#include "json/json_span.h"

typedef enum job_part {
    JOB_INPUT,   /* a path */
    JOB_OUTPUT,  /* likewise */
    JOB_LATTICE, /* likewise; each of several */
    JOB_MORPH,   /* the name of a morph target, and its lattice */
    JOB_CLIP,    /* an animation of weights; each of several */
    JOB_OPTION,  /* a name and a value */
    JOB_FLAG,    /* the name of an option that takes no value */
    JOB_UNSET,   /* the name of an option that the job does without */
    JOB_SETTING, /* the name of a placeholder and its value as JSON */
    JOB_WRONG    /* the name of a member, and what is wrong with it */
} job_part;

typedef struct job_statement {
    job_part part;
    size_t name, value; /* where these begin in the texts */
} job_statement;

/* All zeros: empty. */
typedef struct job_description {
    job_statement *statements;
    size_t count, capacity;
    byte_buffer texts; /* each ended by 0; failed: memory ran out, and statements are lost */
} job_description;

/* Adds a statement; name or value is NULL for parts that have none. */
void ffd_description_add(job_description *description, job_part part, const char *name, const char *value);
/* Adds the value of a placeholder, without the white space between its parts. */
void ffd_description_set(job_description *description, const char *name, const json_span *tree,
                         uint32_t value);
/* The name or the value of a statement, valid until the next one is added. */
const char *ffd_description_name(const job_description *description, const job_statement *statement);
/* The value of a statement, likewise. */
const char *ffd_description_value(const job_description *description, const job_statement *statement);
/* The value of the first such part; NULL if there is none. */
const char *ffd_description_find(const job_description *description, job_part part);
/* Returns what is wrong with a member; NULL: nothing. */
const char *ffd_description_wrong(const job_description *description, const char *name);
/* Leaves an empty description. */
void ffd_description_free(job_description *description);

#endif
