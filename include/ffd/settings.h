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
    FFD_MEMBER_CHOICE,   /* an enum: the index of one of its words */
    FFD_MEMBER_FORMAT,   /* ffd_format, likewise */
    FFD_MEMBER_COUNT,    /* int, at least 0 */
    FFD_MEMBER_LENGTH,   /* double: at least 0 and finite */
    FFD_MEMBER_DISTANCE, /* a length, and a bool: whether it is a fraction of another one */
    FFD_MEMBER_TIME,     /* double: seconds, at least 0 */
    FFD_MEMBER_MOMENT,   /* double: a time in an animation, finite; and a bool: whether it is given */
    FFD_MEMBER_BYTES,    /* uint64_t: a size in bytes */
    FFD_MEMBER_GATES,    /* unsigned: ffd_gate flags, with the limits of fail_on */
    FFD_MEMBER_TEXT,     /* const char * */
    FFD_MEMBER_SEAM,     /* a choice, and unsigned: faces of ffd_lattice_seal, or FFD_FACES_CUT */
    /* Lists: an array, and the count of its elements, size_t. */
    FFD_MEMBER_TEXTS,
    FFD_MEMBER_SELECTORS, /* of texts "KIND:NAME" */
    FFD_MEMBER_CLIPS,     /* of texts (ffd_clip_check) */
    FFD_MEMBER_VALUES,    /* of ffd_setting */
    FFD_MEMBER_LATTICES,  /* of ffd_lattice_source */
    FFD_MEMBER_MORPHS,    /* of texts: a name for each lattice; NULL: it makes no morph target */
    FFD_MEMBER_OBJECT,    /* a pointer to something else, or a function */
    FFD_MEMBER_WEIGHT /* const char *: a source of weights (ffd_weight_check); a manifest has the file that
                         it may name relative to its own folder */
} ffd_member_kind;

/* What holds for a member, combined with |. */
typedef enum ffd_member_trait {
    FFD_MEMBER_IS_PATH = 1, /* the name of a file, which a manifest has relative to its own folder */
    FFD_MEMBER_IS_IDLE = 2  /* it changes no byte of what a job writes */
} ffd_member_trait;

/* A member of ffd_deform_desc. It is not set while it is 0, false or NULL, a list while it is
   empty, and a moment while its bool is false. */
typedef struct ffd_member {
    const char *name;   /* "falloff", "input.space" */
    const char *option; /* in manifests and for the program: "space"; NULL: neither has it */
    ffd_member_kind kind;
    size_t offset;            /* in ffd_deform_desc */
    size_t second;            /* offset of a list's count, a distance's bool, a seam's faces; or 0 */
    const char *const *words; /* of a choice, format, seam: in the enum's order; of gates: their names, with
                                 "=" where a limit follows; ended by NULL; else NULL */
    unsigned traits;          /* ffd_member_trait flags */
} ffd_member;

/* Returns a member of the table, by its index from 0; NULL behind the last. Thread-safe. */
FFD_API const ffd_member *ffd_deform_member(size_t index);

/* Returns the member of an option, or NULL. Thread-safe. */
FFD_API const ffd_member *ffd_deform_member_of(const char *option);

/* Sets a member to what a text says, in the form that options of `ffd` have: "4G", "0.1r", "folds,tear=2",
   "NAME=VALUE". Lists grow by an element, gates add up, a text is set once, all others to the last value.
   desc may be another struct that has such a member at these offsets. text stays in use, as part of desc;
   NULL: the option of a flag, which takes none. Lists must be empty at first, or made by this function;
   ffd_deform_desc_clear frees them. Different structs may be set in several threads at once. Errors:
   FFD_E_ARGUMENT (the message begins with the member as ffd_spell_members has it, or with a name that begins
   with "-"), FFD_E_MEMORY; desc is as before then. */
FFD_API ffd_status ffd_member_read(const ffd_member *member, void *desc, const char *text, ffd_error *error);
/* Sets all members of the table to what ffd_deform_desc_init sets them to, and frees the lists, which must be
   empty or made by ffd_member_read. */
FFD_API void ffd_deform_desc_clear(ffd_deform_desc *desc);

/* Checks that all settings are in their ranges and fit each other. It looks at no file. All functions that
   run a job begin with it. Thread-safe. Errors: FFD_E_ARGUMENT. */
FFD_API ffd_status ffd_deform_desc_check(const ffd_deform_desc *desc, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
