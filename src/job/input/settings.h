/* settings.h - the rules among the settings of a job (public: ffd/settings.h), and settings as bytes
   (setting_bytes.c). */
#ifndef FFD_JOB_INPUT_SETTINGS_H
#define FFD_JOB_INPUT_SETTINGS_H

#include "base/text/buffer.h"
#include <ffd/settings.h>

/* What one setting, where it is set, demands. */
typedef enum job_relation {
    JOB_NEEDS,       /* that the other one is set */
    JOB_EXCLUDES,    /* that it is not */
    JOB_NEEDS_FILES, /* that neither the mesh nor the output is in memory; there is no other one */
} job_relation;

/* A setting is a member, alone or with the word of a value: "outside=extend"; "=several" of a list: more than
   one. */
typedef struct job_rule {
    const char *setting;
    job_relation relation;
    const char *other;
    const char *why; /* the message, with members in braces; NULL: the usual one */
} job_rule;

/* In the order in which they are checked; the last has no setting. */
extern const job_rule ffd_job_rules[];

/* Whether a member is a list. */
bool ffd_member_is_list(const ffd_member *member);
/* Whether it is set. */
bool ffd_member_is_set(const ffd_deform_desc *desc, const ffd_member *member);
/* A part of ffd_deform_desc. */
typedef struct member_piece {
    size_t offset, size;
} member_piece;
/* The most pieces of a member. */
#define MEMBER_PIECES 6
/* Returns the number of pieces that a member is made of, which is not a list. */
size_t ffd_member_pieces(const ffd_member *member, member_piece pieces[MEMBER_PIECES]);
/* Copies such a member from one description to another. */
void ffd_member_copy(const ffd_member *member, const ffd_deform_desc *from, ffd_deform_desc *to);

/* Which members ffd_settings_write writes. */
typedef enum settings_use {
    SETTINGS_ALL,    /* with all that they name, for ffd_settings_take */
    SETTINGS_CONTENT /* those that can change a byte of the output; of files only that they are there */
} settings_use;

/* Appends the members that are set, for a process of this program on this machine. Objects are left out. */
void ffd_settings_write(const ffd_deform_desc *desc, settings_use use, byte_buffer *bytes);
/* Fills desc, as ffd_deform_desc_init leaves it, from what was written at *at with SETTINGS_ALL, and moves
 *at behind it. Texts stay where they are, in `at`; ffd_deform_desc_clear frees the lists. Errors:
 *FFD_E_MEMORY.
 */
ffd_status ffd_settings_take(const char **at, ffd_deform_desc *desc, ffd_error *error);

/* Whether a setting of a rule, or of a list of members, is set. */
bool ffd_setting_is_set(const ffd_deform_desc *desc, const char *setting);

#endif
