/* report_reader.h - goes through a report (data/schema/formats.md 2) entry by entry, whatever its size. */
#ifndef FFD_JOB_REPORT_REPORT_READER_H
#define FFD_JOB_REPORT_REPORT_READER_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct report_reader {
    const char *name;        /* for messages */
    const char *begin, *end; /* the text, not owned */
    const char *at;          /* after the entry that was read last */
    uint64_t jobs;           /* entries read */
    bool lines;              /* JSON Lines: an entry a line, and nothing else */
} report_reader;

typedef struct report_entry_text {
    const char *bytes; /* from { to } */
    size_t size;
} report_entry_text;

/* Reads the whole text once: it must be a report (lines: of JSON Lines), and each of its entries strict JSON
   that says which job it was and how it ended. Then the reader is at the first entry. Errors: FFD_E_INVALID
   with the line, FFD_E_UNSUPPORTED for another version, FFD_E_MEMORY. */
ffd_status ffd_report_reader_open(report_reader *reader, const char *name, bool lines, const void *text,
                                  size_t size, ffd_error *error);
/* The next entry; false after the last. */
bool ffd_report_reader_next(report_reader *reader, report_entry_text *entry);

#endif
