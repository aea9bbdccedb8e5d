/* gltf_compare_json.h - compares the JSON of two glTF files. */
#ifndef FFD_IO_GLTF_GLTF_COMPARE_JSON_H
#define FFD_IO_GLTF_GLTF_COMPARE_JSON_H

#include "io/gltf/read/gltf_document.h"
#include "mesh/difference.h"

/* The first number of an accessor's "min" or "max" that differs in the second file. */
typedef struct gltf_bound {
    uint32_t in_a, in_b; /* JSON values; 0: none */
} gltf_bound;

typedef struct gltf_comparer {
    const gltf_document *a, *b;
    ffd_comparison *result;
    /* For each accessor of a. */
    uint8_t *kinds;  /* ffd_difference_kind: what its elements are */
    uint8_t *states; /* a gltf_elements */
    gltf_bound *bounds;
    /* For each bufferView of a. */
    bool *is_same;     /* all its bytes are equal, decoded if they can be */
    bool *is_unpacked; /* it is Draco data: its elements are compared instead */
    /* The JSON differs in accessors, bufferViews or meshes: elements are not compared. */
    bool other_storage;
    memory_budget budget; /* for visiting elements; a copy of a's */
    ffd_error *error;
} gltf_comparer;

/* What is known of an accessor's elements, besides the bytes of their bufferViews. */
typedef enum gltf_elements { GLTF_NOT_COMPARED, GLTF_ALL_SAME, GLTF_DIFFER } gltf_elements;

/* Compares the JSON. Ignores the bounds of elements that may differ by a tolerance, and stores differing
   bounds of other measurable elements in c->bounds. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_compare_json(gltf_comparer *c);
/* Adds the difference of a bound to the result. */
void ffd_gltf_differ_in_bound(gltf_comparer *c, const gltf_bound *bound);

#endif
