/* spec_set.h - values for the placeholders {"$": "NAME"} in the moves of a lattice file. Declares a function
   of file.c too. */
#ifndef FFD_LATTICE_FILE_SPEC_SET_H
#define FFD_LATTICE_FILE_SPEC_SET_H

#include "lattice/file/spec_seeds.h"
#include "json/json_setting.h"

/* A value times a number. */
typedef struct spec_product {
    char *text;
    json_setting value; /* of the text */
} spec_product;

/* All zeros: empty. */
typedef struct spec_values {
    json_setting *values; /* one for each setting, then one for each parameter; parsed if it is used */
    size_t count;
    json_substitute *substitutes; /* one for each placeholder */
    size_t substitute_count, substitute_capacity;
    spec_product **products; /* of placeholders with a factor */
    size_t product_count, product_capacity;
    spec_origins origins; /* of placeholders, where the settings ask for what comes from them */
    intern_table open;    /* names of placeholders without a value */
    intern_table names;   /* of the parameters, numbered as they are */
} spec_values;

/* Makes the file's readers read these values, or the defaults of the spec's parameters, instead of the
   placeholders that are somewhere within moves (a value of the file's tree, or JSON_NONE), and marks those
   that are used. The values must outlive the reading; free them after a failure too. Errors: FFD_E_INVALID
   for a placeholder without a value (unless the settings allow it) and for a value outside its bounds,
   FFD_E_MEMORY. */
ffd_status ffd_spec_set(json_file *file, uint32_t moves, const spec_settings *settings, lattice_spec *spec,
                        spec_values *values);
/* Writes a message that these placeholders (at least one) have no values. */
void ffd_spec_describe_open(const intern_table *open, char *text, size_t capacity);
/* Adds the names of a file's placeholders that have no value. Errors: those of ffd_lattice_load_rest. */
ffd_status ffd_lattice_list_open(const char *path, const ffd_setting *values, size_t count, bool *used,
                                 intern_table *open, ffd_error *error);
/* Leaves them empty. */
void ffd_spec_values_free(spec_values *values);

#endif
