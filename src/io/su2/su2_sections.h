/* su2_sections.h - the sections of an SU2 mesh: lines KEY= VALUE, some with further lines behind them. */
#ifndef FFD_IO_SU2_SU2_SECTIONS_H
#define FFD_IO_SU2_SU2_SECTIONS_H

#include "base/fail.h"
#include "base/text/text_scan.h"
#include <stdint.h>

/* Begins comments, to the end of the line. */
#define SU2_COMMENT '%'

typedef enum su2_kind { SU2_ELEMENTS, SU2_POINTS, SU2_MARKER } su2_kind;

/* Lines of the file. */
typedef struct su2_section {
    su2_kind kind;
    uint64_t count; /* lines */
    text_scan scan; /* where they begin */
    text_word tag;  /* of a marker */
    size_t zone;    /* from 0 */
} su2_section;

typedef struct su2_sections {
    su2_section *list;
    size_t count, capacity;
    uint64_t dimensions, zones;
    bool has_ffd_boxes;
} su2_sections;

/* Finds the sections of a file; the caller frees the list in every case. Errors: FFD_E_INVALID, FFD_E_MEMORY,
   FFD_E_UNSUPPORTED for zones of different dimensions. */
ffd_status ffd_su2_find(const text_scan *file, const char *name, su2_sections *sections, ffd_error *error);
/* Moves to the first word of the next line that is neither empty nor a comment. Returns false at the end. */
bool ffd_su2_line(text_scan *scan);
/* Takes the next word of the line. Returns false if a comment or the end of the line is next. */
bool ffd_su2_word(text_scan *scan, text_word *word);

#endif
