/* spec_set.h - values for the placeholders {"$": "NAME"} in the moves of a lattice file. Declares a function
   of file.c too. */
#ifndef FFD_LATTICE_FILE_SPEC_SET_H
#define FFD_LATTICE_FILE_SPEC_SET_H

#include "lattice/file/spec_seeds.h"
#include "json/json_setting.h"

/* A value multiplied by a factor. */
typedef struct spec_product {
    char *text;
    json_setting value; /* parsed from the text */
} spec_product;

/* All zeros: empty. */
typedef struct spec_values {
    json_setting *values; /* one for each setting, then one for each parameter; parsed when first used */
    size_t count;
    json_substitute *substitutes; /* one for each placeholder */
    size_t substitute_count, substitute_capacity;
    spec_product **products; /* for placeholders with a factor */
    size_t product_count, product_capacity;
    spec_origins origins; /* of the placeholders, if the settings request derivatives */
    intern_table open;    /* names of placeholders without a value */
    intern_table names;   /* of the parameters, with the same numbers */
    intern_table set;     /* distinct names of the settings */
    size_t *settings;     /* the first setting of each of these */
} spec_values;

/* Substitutes the placeholders anywhere in count lists of moves (values of the file's tree, ascending) by the
   values of the settings, or by the defaults of the spec's parameters, and marks the settings that are used.
   values must outlive the reading of the file; the caller frees it, also after a failure. Errors:
   FFD_E_INVALID for a placeholder without a value (unless the settings allow it) and for a value out of its
   bounds, FFD_E_MEMORY. */
ffd_status ffd_spec_set(json_file *file, const uint32_t *moves, size_t count, const spec_settings *settings,
                        lattice_spec *spec, spec_values *values);
/* Writes the message that these placeholders (at least one) have no values. */
void ffd_spec_describe_open(const intern_table *open, char *text, size_t capacity);
/* Adds to open the names of the placeholders in a file or a text that have no value. Errors: those of
   ffd_lattice_load_rest. */
ffd_status ffd_lattice_list_open(const ffd_lattice_source *source, const ffd_setting *values, size_t count,
                                 bool *used, intern_table *open, ffd_error *error);
/* Frees the values and empties them. */
void ffd_spec_values_free(spec_values *values);

#endif
