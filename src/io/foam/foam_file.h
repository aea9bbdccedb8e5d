/* foam_file.h - reads one file of OpenFOAM: its header FoamFile, lists of whole numbers, entries of
   dictionaries. In binary only the elements of lists are binary. Declares foam_file.c, foam_labels.c. */
#ifndef FFD_IO_FOAM_FOAM_FILE_H
#define FFD_IO_FOAM_FOAM_FILE_H

#include "base/fail.h"
#include "base/text/code_scan.h"
#include "base/text/number_type.h"

typedef struct foam_file {
    const char *name; /* for messages */
    text_scan scan;
    bool is_binary;
    number_type label, scalar; /* in binary */
    text_word class, note;     /* of the header; empty: it has none */
    ffd_error *error;
} foam_file;

/* The line for a message; 0: the file is binary. */
static inline size_t foam_line(const foam_file *f)
{
    return f->is_binary ? 0 : f->scan.line;
}

#define FOAM_REFUSE(f, ...) ffd_fail_line((f)->error, FFD_E_INVALID, (f)->name, foam_line(f), __VA_ARGS__)

/* Begins a file, whose name, bytes and error are set: takes its header. Errors: FFD_E_INVALID;
   FFD_E_UNSUPPORTED for compressed files, other byte orders and sizes. */
ffd_status ffd_foam_begin(foam_file *f, const void *data, size_t size);
/* Checks that the class is one of these. second: NULL: there is one. Errors: FFD_E_INVALID,
   FFD_E_UNSUPPORTED for collated files. */
ffd_status ffd_foam_check_class(const foam_file *f, const char *first, const char *second);
/* Returns what is next, for messages. */
text_shown ffd_foam_next(const foam_file *f);
/* Takes a mark that must be next. what: it is expected for. Errors: FFD_E_INVALID. */
ffd_status ffd_foam_mark(foam_file *f, char mark, const char *what);
/* Takes a word or a string, the name of something. Errors: FFD_E_INVALID. */
ffd_status ffd_foam_name(foam_file *f, const char *what, text_word *name);
/* Takes a whole number. Errors: FFD_E_INVALID. */
ffd_status ffd_foam_whole(foam_file *f, const char *what, uint64_t *value);
/* Moves past the value of an entry: behind its semicolon, or the bracket that ends its dictionary. Errors:
   FFD_E_INVALID. */
ffd_status ffd_foam_skip(foam_file *f);

/* Whole numbers. All zeros: none. The owner frees values with ffd_free. */
typedef struct foam_labels {
    uint32_t *values;
    size_t count, capacity;
} foam_labels;

/* How a list is written. */
typedef enum foam_list {
    FOAM_EMPTY,
    FOAM_ELEMENTS, /* in parentheses */
    FOAM_SAME      /* one for all, in braces */
} foam_list;

/* Takes the number of elements of a list, and the bracket in front of them. least: bytes of an element in
   binary, or of the shortest text, with what separates it from the next one. most: how many elements may be
   equal, written once. Errors: FFD_E_INVALID if the file cannot hold them. */
ffd_status ffd_foam_list(foam_file *f, const char *what, size_t least, uint64_t most, foam_list *list,
                         uint64_t *count);
/* Takes the bracket behind the elements. Errors: FFD_E_INVALID. */
ffd_status ffd_foam_list_end(foam_file *f, const char *what, foam_list list);
/* Appends a list of whole numbers below 2^32 - 1. most: as of ffd_foam_list. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_foam_labels(foam_file *f, const char *what, uint64_t most, foam_labels *labels);

#endif
