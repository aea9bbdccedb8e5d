/* settings.h - the rules among the settings of a job (public: ffd/settings.h). */
#ifndef FFD_JOB_INPUT_SETTINGS_H
#define FFD_JOB_INPUT_SETTINGS_H

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

/* Whether a setting of a rule, or of a list of members, is set. */
bool ffd_setting_is_set(const ffd_deform_desc *desc, const char *setting);

#endif
