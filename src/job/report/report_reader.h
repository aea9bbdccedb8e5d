/* report_reader.h - reads a report (data/schema/formats.md 2) of any size entry by entry. */
#ifndef FFD_JOB_REPORT_REPORT_READER_H
#define FFD_JOB_REPORT_REPORT_READER_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct report_reader {
    const char *name;        /* for messages */
    const char *begin, *end; /* the text, not owned */
    const char *at;          /* behind the last entry read */
    uint64_t jobs;           /* entries read */
    bool lines;              /* JSON Lines: one entry a line, and nothing else */
} report_reader;

typedef struct report_entry_text {
    const char *bytes; /* from { to }, in the text */
    size_t size;
} report_entry_text;

/* Validates the whole text: it must be a report (lines: as JSON Lines) whose entries are strict JSON and
   state the job and its outcome. Then the reader is at the first entry. Errors: FFD_E_INVALID with the line,
   FFD_E_UNSUPPORTED for another version, FFD_E_MEMORY. */
ffd_status ffd_report_reader_open(report_reader *reader, const char *name, bool lines, const void *text,
                                  size_t size, ffd_error *error);
/* Reads the next entry. Returns false after the last one. */
bool ffd_report_reader_next(report_reader *reader, report_entry_text *entry);

#endif
