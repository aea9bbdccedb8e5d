/* flaws.h - violations of a format's specification whose meaning is clear: viewers open the file, and every
   position is certain. They are recorded for a warning, or refused with --strict. */
#ifndef FFD_MESH_FLAWS_H
#define FFD_MESH_FLAWS_H

#include "mesh/mesh_log.h"
#include <stdarg.h>

/* The flaws of a file. All zeros: none, not strict. */
typedef struct mesh_flaws {
    bool strict;                    /* refuse the first flaw */
    size_t count;                   /* kinds */
    ffd_flaw list[FFD_FLAWS];       /* the first flaw of each kind, and their number */
    const char *formats[FFD_FLAWS]; /* format strings of their messages, which identify the kinds */
} mesh_flaws;

/* Records a flaw at a line (from 1; 0: the whole file); if strict, fails with FFD_E_INVALID there. format: a
   literal, the same one for all flaws of a kind. One thread at a time. */
ffd_status ffd_flaw_line(mesh_flaws *flaws, const char *file, size_t line, ffd_error *error,
                         const char *format, ...) FFD_PRINTF(5, 6);
/* The same, with its arguments in a list, also at a JSON pointer (line 0 and pointer "": the whole file). */
ffd_status ffd_flaw_note(mesh_flaws *flaws, const char *file, size_t line, const char *pointer,
                         ffd_error *error, const char *format, va_list arguments);
/* Counts a flaw if its kind is known already, so that its position need not be determined. Returns whether it
   is. */
bool ffd_flaw_repeats(mesh_flaws *flaws, const char *format);

/* Logs a warning for each kind. file: prefix of the lines; NULL: the log adds it. */
void ffd_flaws_warn(const mesh_flaws *flaws, const char *file, const mesh_log *log);

#endif
