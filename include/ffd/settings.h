/* settings.h - the settings of a job as a table: the members of ffd_deform_desc that the user of a front end
   chooses, what they may be, and which of them exclude or need each other. A front end reads its own settings
   by this table, and has refusals worded for it by ffd_spell_members. */
#ifndef FFD_SETTINGS_H
#define FFD_SETTINGS_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/job.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The type of a member, and its range. */
typedef enum ffd_member_kind {
    FFD_MEMBER_FLAG = 0, /* bool */
    FFD_MEMBER_CHOICE,   /* an enum: the number of one of its words */
    FFD_MEMBER_FORMAT,   /* ffd_format, likewise */
    FFD_MEMBER_COUNT,    /* int, at least 0 */
    FFD_MEMBER_LENGTH,   /* double: at least 0 and finite */
    FFD_MEMBER_TIME,     /* double: seconds, at least 0 */
    FFD_MEMBER_BYTES,    /* uint64_t: a size in bytes */
    FFD_MEMBER_GATES,    /* unsigned: ffd_gate flags */
    FFD_MEMBER_TEXT,     /* const char * */
    FFD_MEMBER_LIST,     /* an array, and the number of its elements, size_t */
    FFD_MEMBER_OBJECT    /* a pointer to something else, or a function */
} ffd_member_kind;

/* A member of ffd_deform_desc. It is not set while it is 0, false or NULL, and a list while it is empty. */
typedef struct ffd_member {
    const char *name; /* "falloff", "input.space" */
    ffd_member_kind kind;
    size_t offset;            /* in ffd_deform_desc */
    size_t count;             /* of a list: the offset of its number; else 0 */
    const char *const *words; /* of a choice or format: in the order of the enum, ended by NULL; else NULL */
} ffd_member;

/* Returns a member of the table, by its number from 0; NULL behind the last. Thread-safe. */
FFD_API const ffd_member *ffd_deform_member(size_t index);

/* Checks that all settings are in their ranges and fit each other. It looks at no file. All functions that
   run a job begin with it. Thread-safe. Errors: FFD_E_ARGUMENT. */
FFD_API ffd_status ffd_deform_desc_check(const ffd_deform_desc *desc, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
