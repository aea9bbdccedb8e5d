/* selector.h - what `--only` names: a kind of thing and its name. */
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

/* The bit of a kind in a set of kinds. */
#define SELECTOR_BIT(kind) (1u << (kind))

typedef struct mesh_selector {
    selector_kind kind;
    const char *name; /* after the colon; lent by the text */
    size_t size;
} mesh_selector;

/* "node", "mesh", ... */
const char *ffd_selector_kind_name(selector_kind kind);

/* Reads "KIND:NAME". Errors: FFD_E_ARGUMENT, with the nearest kind. */
ffd_status ffd_selector_parse(const char *text, mesh_selector *selector, ffd_error *error);

/* Whether this is the name that is looked for. */
bool ffd_selector_is(const mesh_selector *selector, const char *name, size_t size);

/* Refuses a kind that a format, called format_name, does not have. kinds: the set that it has. */
ffd_status ffd_selector_check_kind(const mesh_selector *selector, unsigned kinds, const char *format_name,
                                   const char *file, ffd_error *error);

/* For a name that a file does not have: the nearest of those that it has, offered one by one. */
typedef struct selector_nearest {
    const mesh_selector *selector; /* set by the caller, the rest zeroed */
    bool offered;
    size_t distance;
    char name[120]; /* the first of equals, cut */
} selector_nearest;

/* Offers a name that the file has: it is kept if it is nearer than those before. */
void ffd_selector_offer(selector_nearest *nearest, const char *name, size_t size);
/* Says so: FFD_E_ARGUMENT. */
ffd_status ffd_selector_unknown(const selector_nearest *nearest, const char *file, ffd_error *error);

#endif
