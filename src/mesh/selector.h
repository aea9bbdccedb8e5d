/* selector.h - selectors of `--only`: a kind of thing and a name. */
#ifndef FFD_MESH_SELECTOR_H
#define FFD_MESH_SELECTOR_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum selector_kind {
    SELECT_NODE,
    SELECT_MESH,
    SELECT_MATERIAL,
    SELECT_GROUP,
    SELECT_OBJECT
} selector_kind;
#define SELECTOR_KINDS 5

/* The bit of a kind in a set. */
#define SELECTOR_BIT(kind) (1u << (kind))

typedef struct mesh_selector {
    selector_kind kind;
    const char *name; /* points into the text, after the colon */
    size_t size;
} mesh_selector;

/* Returns the name of a kind: "node", "mesh", ... */
const char *ffd_selector_kind_name(selector_kind kind);

/* Parses "KIND:NAME". Errors: FFD_E_ARGUMENT, with the most similar kind. */
ffd_status ffd_selector_parse(const char *text, mesh_selector *selector, ffd_error *error);

/* Returns whether this is the name of the selector. */
bool ffd_selector_is(const mesh_selector *selector, const char *name, size_t size);

/* Checks that a format has the kind of a selector. kinds: the set of kinds of the format. Errors:
   FFD_E_ARGUMENT. */
ffd_status ffd_selector_check_kind(const mesh_selector *selector, unsigned kinds, const char *format_name,
                                   const char *file, ffd_error *error);

/* Finds the name in a file that is most similar to a missing name; names are offered one by one. */
typedef struct selector_nearest {
    const mesh_selector *selector; /* set by the caller; all other members 0 */
    bool offered;
    size_t distance;
    char name[120]; /* most similar name so far, the first if several; truncated */
} selector_nearest;

/* Offers a name; keeps it if it is more similar than those before. */
void ffd_selector_offer(selector_nearest *nearest, const char *name, size_t size);
/* Fails with FFD_E_ARGUMENT and a message that suggests the most similar name. */
ffd_status ffd_selector_unknown(const selector_nearest *nearest, const char *file, ffd_error *error);

#endif
