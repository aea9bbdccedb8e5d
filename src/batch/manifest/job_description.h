/* job_description.h - the content of a manifest line or table row, before it becomes a job. */
#ifndef FFD_BATCH_MANIFEST_JOB_DESCRIPTION_H
#define FFD_BATCH_MANIFEST_JOB_DESCRIPTION_H

#include "base/text/buffer.h"
#include "json/json_tree.h"

typedef enum job_part {
    JOB_INPUT,   /* value: a path */
    JOB_OUTPUT,  /* value: a path */
    JOB_LATTICE, /* value: a path; repeatable */
    JOB_MORPH,   /* name: of the morph target; value: the path of its lattice */
    JOB_CLIP,    /* value: an animation of weights; repeatable */
    JOB_OPTION,  /* an option with its value */
    JOB_FLAG,    /* an option without a value */
    JOB_UNSET,   /* an option of the batch that this job turns off */
    JOB_LOOK,    /* an option of its picture, with its value; a flag has "true" or "false" */
    JOB_SETTING, /* a placeholder, and its value as JSON */
    JOB_WRONG    /* name: of a member; value: what is wrong with it */
} job_part;

typedef struct job_statement {
    job_part part;
    size_t name, value; /* offsets into texts */
} job_statement;

/* All zeros: empty. */
typedef struct job_description {
    job_statement *statements;
    size_t count, capacity;
    byte_buffer texts; /* each terminated by 0; failed: memory ran out, and statements are missing */
} job_description;

/* Adds a statement. name or value is NULL if the part has none. */
void ffd_description_add(job_description *description, job_part part, const char *name, const char *value);
/* Adds a placeholder's value, with the white space between its parts removed. */
void ffd_description_set(job_description *description, const char *name, const json_tree *tree,
                         uint32_t value);
/* Returns the name of a statement, valid until the next one is added. */
const char *ffd_description_name(const job_description *description, const job_statement *statement);
/* Returns the value of a statement, valid until the next one is added. */
const char *ffd_description_value(const job_description *description, const job_statement *statement);
/* Returns the value of the first statement of this part; NULL: there is none. */
const char *ffd_description_find(const job_description *description, job_part part);
/* Returns what is wrong with a member; NULL: nothing. */
const char *ffd_description_wrong(const job_description *description, const char *name);
/* Frees the statements; leaves an empty description. */
void ffd_description_free(job_description *description);

#endif
