/* places.h - the places of a mesh: what is at a point but is not a vertex, such as joints, cameras and
   sockets. They can follow the deformation. */
#ifndef FFD_MESH_PLACES_H
#define FFD_MESH_PLACES_H

#include "mesh/mesh.h"

/* A thing at a point of the file that is not a vertex: a joint, a camera and so on. */
typedef struct mesh_place {
    double at[3];    /* position in the space of the lattice */
    unsigned kinds;  /* a set of PLACE_BIT; 0: no kind, but follow moves it */
    bool stays;      /* follow does not move it, even if it moves its parent */
    bool partial;    /* because its mesh is selected only in part */
    bool unselected; /* it, or what it places, is not selected: this stays */
    unsigned holds;  /* a set of PLACE_HOLDS: sizes that do not follow */
    size_t index;    /* for mesh_place_calls.name */
} mesh_place;
#define PLACE_BIT(kind) (1u << (kind)) /* the bit of an ffd_behind_kind */

/* Radii of a spring bone; the offset of the eyes; a direction to another place. */
enum { PLACE_HOLDS_SPRING = 1, PLACE_HOLDS_EYES = 2, PLACE_HOLDS_AIM = 4 };

typedef struct mesh_places {
    mesh_place *list;
    size_t count;
} mesh_places;

/* The deformation at a place. */
typedef struct mesh_place_move {
    bool moves;         /* a vertex there would move */
    bool singular;      /* the gradient there is unreliable */
    double to[3];       /* where a vertex there would move to */
    double gradient[9]; /* F - I there; 0 where nothing moves */
    double became[3];   /* position of the place in the output */
} mesh_place_move;

/* The result of follow. */
typedef struct mesh_following {
    uint64_t written;  /* nodes whose transforms change */
    uint64_t sheared;  /* nodes that rotate with their parents, because another rotation would shear them */
    uint64_t singular; /* nodes that stay, with their descendants, because their matrices are not
                          invertible */
    uint64_t partial;  /* nodes that stay because their meshes are selected only in part */
    uint64_t unscaled; /* nodes with sizes that do not follow: physics shapes, spring bones, offsets of eyes,
                          splats */
    /* Nodes that stay because they are not selected, below a node that moves or on joints that move. */
    uint64_t unselected;
    double unselected_by; /* the largest distance from where that node would carry one of them */
} mesh_following;

/* Lists the places of the file that belong to the selection, in the order of the file. all: also those
   without a kind and those that are not selected, for follow. The caller frees places->list, also after a
   failure. */
typedef ffd_status mesh_list_places_function(const mesh_document *document, bool all, mesh_places *places,
                                             ffd_error *error);
/* Returns the name of a place, which the caller frees; NULL if memory runs out. */
typedef char *mesh_place_name_function(const mesh_document *document, size_t index);
/* Counts the skins with a marked place (one byte each) among their joints, and the marked places that are
   joints of none of these (loose). */
typedef ffd_status mesh_count_skins_function(const mesh_document *document, const mesh_places *places,
                                             const uint8_t *marks, uint64_t *count, uint64_t *loose,
                                             ffd_error *error);
/* Moves all places with the deformation, and their animations and the skins. To be called after
   begin_results, which resets it, and before vertices are written, because it may set `carried` of parts.
   Fills became. Errors: FFD_E_MEMORY, FFD_E_LIMIT, and those of the file's content. */
typedef ffd_status mesh_follow_function(mesh_document *document, const mesh_places *places,
                                        mesh_place_move *moves, const mesh_log *log,
                                        mesh_following *following, ffd_error *error);

/* In place of the number of a piece or a node. */
#define MESH_NONE UINT32_MAX

/* Finds which places are those of pieces that move as one: a place whose vertices (those of its mesh, or that
   follow it as a joint with more than half of their weight; if it has none, those of all below it) are all of
   one piece; and one without vertices below such a place. pieces: of each vertex of the document its piece,
   or MESH_NONE; those that are not selected do not count. of_places: filled likewise for each place. Errors:
   FFD_E_MEMORY. */
typedef ffd_status mesh_place_pieces_function(const mesh_document *document, const mesh_places *places,
                                              const uint32_t *pieces, uint32_t *of_places, ffd_error *error);
/* Finds for each vertex of the document the nearest node above it whose rotation an animation changes, by the
   index for mesh_place_calls.name, or MESH_NONE: the node of its mesh, or the joint that it follows with more
   than half of its weight, or a node above that. Joints some of whose vertices follow others too bend what
   they carry: these vertices have none. Animations that cannot be read turn nothing. *nodes: allocated if
   there is one, else NULL; the caller frees it. Errors: FFD_E_MEMORY. */
typedef ffd_status mesh_find_turned_function(mesh_document *document, uint32_t **nodes, ffd_error *error);

struct mesh_place_calls {
    mesh_list_places_function *list;
    mesh_place_name_function *name;
    mesh_count_skins_function *count_skins;
    mesh_follow_function *follow;
    mesh_place_pieces_function *find_pieces;
    mesh_find_turned_function *find_turned;
};

#endif
