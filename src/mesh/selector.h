/* selector.h - selectors of `--only`, `--rigid` and `--uniform`: a kind of thing and a name. */
#ifndef FFD_MESH_SELECTOR_H
#define FFD_MESH_SELECTOR_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum selector_kind {
    SELECT_NODE,
    SELECT_MESH,
    SELECT_MATERIAL,
    SELECT_GROUP,
    SELECT_OBJECT,
    SELECT_JOINT /* not of `--only` */
} selector_kind;
#define SELECTOR_KINDS 6

/* The bit of a kind in a set. */
#define SELECTOR_BIT(kind) (1u << (kind))

typedef struct mesh_selector {
    selector_kind kind;
    const char *name; /* points into the text, after the colon */
    size_t size;
    const char *option; /* the setting that it is of, for messages: "only" */
} mesh_selector;

typedef struct mesh_document mesh_document; /* mesh.h */
typedef struct mesh_listing mesh_listing;   /* listing.h */

/* Restricts moving, counting and writing to what at least one of the selectors names: sets selected and
   skipped of the parts, whose indices and vertices stay. To be called at most once, before results.
   Errors: FFD_E_ARGUMENT (a name that is not in the file). */
typedef ffd_status mesh_select_function(mesh_document *document, const mesh_selector *selectors, size_t count,
                                        ffd_error *error);
/* Sets the marks of the vertices (one byte for each vertex of the document) that a selector names; those of a
   joint follow it with more than half of their weight. Errors: as mesh_select_function. */
typedef ffd_status mesh_mark_function(mesh_document *document, const mesh_selector *selector, uint8_t *marks,
                                      ffd_error *error);
/* Adds to a listing every name that select accepts, with everything that its bearers draw, by kind and in
   the order of the file; and every unnamed thing of a kind that can have names. Errors: FFD_E_MEMORY,
   FFD_E_UNSUPPORTED, and those of the file's content. */
typedef ffd_status mesh_list_things_function(const mesh_document *document, mesh_listing *listing,
                                             ffd_error *error);
/* Writes the selector, such as "node:NAME", of the thing that shows a vertex (by its number in the
   document); "" if it has no name. Returns how many vertices of the thing are marked (one byte for each
   vertex of the document), and clears their marks. */
typedef uint64_t mesh_name_owner_function(const mesh_document *document, uint64_t vertex, uint8_t *marks,
                                          char *name, size_t capacity);

/* The calls of a format whose meshes have things with names. */
typedef struct mesh_selector_calls {
    unsigned kinds, mark_kinds; /* the sets of kinds that select and mark take */
    mesh_select_function *select;
    mesh_mark_function *mark;
    mesh_list_things_function *list;
    mesh_name_owner_function *name_owner;
} mesh_selector_calls;

/* Returns the name of a kind: "node", "mesh", ... */
const char *ffd_selector_kind_name(selector_kind kind);

/* Parses "KIND:NAME", with a kind of the setting's: "only", "rigid" or "uniform". Errors: FFD_E_ARGUMENT,
   with the most similar kind. */
ffd_status ffd_selector_parse(const char *option, const char *text, mesh_selector *selector,
                              ffd_error *error);

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
