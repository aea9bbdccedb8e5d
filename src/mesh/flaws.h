/* flaws.h - what a file has against the specification of its format, but whose meaning is plain: viewers open
   it, and no vertex could stand elsewhere. It is noted, for a warning; or refused, with --strict. */
#ifndef FFD_MESH_FLAWS_H
#define FFD_MESH_FLAWS_H

#include "mesh/mesh_log.h"
#include <stdarg.h>

/* Those of one file. All zeros: none, and none is refused. */
typedef struct mesh_flaws {
    bool strict;                    /* the first one is refused */
    size_t count;                   /* kinds */
    ffd_flaw list[FFD_FLAWS];       /* what they have in common, and the first of each */
    const char *formats[FFD_FLAWS]; /* of their messages: by these, kinds are told apart */
} mesh_flaws;

/* Notes a flaw at a line (from 1; 0: the whole file), or, if they are refused, fails with FFD_E_INVALID
   there. format: a literal, the same for all flaws of a kind. One thread at a time. */
ffd_status ffd_flaw_line(mesh_flaws *flaws, const char *file, size_t line, ffd_error *error,
                         const char *format, ...) FFD_PRINTF(5, 6);
/* The same at a JSON pointer. */
ffd_status ffd_flaw_at(mesh_flaws *flaws, const char *file, const char *pointer, ffd_error *error,
                       const char *format, ...) FFD_PRINTF(5, 6);

/* What the two do, for functions that find out the place for themselves (line 0, pointer "": the whole file).
 */
ffd_status ffd_flaw_note(mesh_flaws *flaws, const char *file, size_t line, const char *pointer,
                         ffd_error *error, const char *format, va_list arguments);
/* Counts a flaw if its kind is known, so that its place need not be found out. Returns whether it is. */
bool ffd_flaw_repeats(mesh_flaws *flaws, const char *format);

/* Warns of each kind. file: in front of the lines; NULL: the log knows it. */
void ffd_flaws_warn(const mesh_flaws *flaws, const char *file, const mesh_log *log);

#endif
