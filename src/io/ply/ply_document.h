/* ply_document.h - a PLY file as a mesh document: one part, in the lattice's space. Declares ply_document.c,
   ply_roles.c, ply_faces.c, ply_splats.c.

   Every row of element vertex is a vertex, in the order of the file; its normal is nx ny nz. Their numbers
   are held as doubles (each one that its type has); all else stays in the file's bytes, which are read again
   where it is needed. */
#ifndef FFD_IO_PLY_PLY_DOCUMENT_H
#define FFD_IO_PLY_PLY_DOCUMENT_H

#include "io/ply/ply_walk.h"
#include "io/text/file_document.h"
#include "splat/harmonics.h"

/* What is marked of what becomes of a splat. */
enum { PLY_SPLAT_CHANGES = 1, PLY_SPLAT_TURNS = 2, PLY_SPLAT_MIRRORS = 4 };

/* Numbers of a rotation and its sizes, in the order of their slots. */
#define PLY_ELLIPSOID ((size_t)(PLY_REST_SLOT - PLY_ROTATION_SLOT))

typedef struct ply_document {
    file_document file;
    ply_header header;
    const ply_element *vertex;
    const ply_element *face;             /* NULL: no element names vertices */
    const ply_property *face_corners;    /* its list vertex_indices or vertex_index */
    const ply_element *strips;           /* tristrips; NULL: there are none */
    const ply_property *strip_corners;   /* their list of vertices; NULL: none has any */
    const ply_property *face_normals[3]; /* nx ny nz of the faces, with a fraction; NULL: there are none */
    bool has_whole_face_normals;         /* those of a whole type, which are kept */
    bool renew_normals;                  /* of faces, with the results */
    ply_type types[PLY_SLOT_COUNT];      /* by slot */
    bool has_fixed_rows;            /* binary, without lists: vertices are of one size, and have by slot */
    size_t offsets[PLY_SLOT_COUNT]; /* where in a row the number is; PLY_NOWHERE: there is none */
    bool has_normals, has_whole_normals; /* the latter: nx ny nz of a whole type, which are not shown */
    size_t behind;                       /* offset after the last row */
    int threads;                         /* for writing */
    splat_ellipsoid *splats; /* one a vertex, where the part has ellipsoids and no fixed rows; else NULL */
    /* Results of splats: PLY_ELLIPSOID numbers each, which are in one of the two, by what their types need;
       and quaternions for harmonics, which are turned when they are written, where there are any. NULL before
       begin_results. */
    float *float_splats;
    double *double_splats;
    double (*new_turns)[4];
    uint8_t *splat_marks; /* of each vertex: which of its results there are */
    size_t rest_count;    /* properties f_rest_0 and so on, whether they turn or not */
    bool has_plain_rests; /* those that turn are little-endian floats of fixed rows, in their order */
} ply_document;

#define PLY_NOWHERE SIZE_MAX

/* A row of fixed size. */
static inline const char *ply_row(const ply_document *document, size_t vertex)
{
    const size_t begin = document->vertex->begin + vertex * document->vertex->least;
    return (const char *)document->file.input.data + begin;
}

static inline const ply_document *ffd_ply_of(const mesh_document *document)
{
    return (const ply_document *)document;
}

/* Begins a walk at the rows of an element. */
void ffd_ply_document_walk(const ply_document *document, const ply_element *element, ply_walk *walk);
/* Refuses an index that is of no vertex. what, row: "face" or "strip" and its number; word: the index, of the
   type. */
ffd_status ffd_ply_refuse_vertex(const ply_document *document, const ply_walk *walk, const char *what,
                                 uint64_t row, ply_type type, text_word word, ffd_error *error);

/* Decides what the elements and properties are. */
ffd_status ffd_ply_find_roles(ply_document *document, ffd_error *error);

/* Pairs of names that programs have for the texture coordinates of vertices. */
#define PLY_TEXCOORD_NAMES 3
extern const char *const ffd_ply_texcoord_names[PLY_TEXCOORD_NAMES][2];

/* The element whose rows are lines: "edge" with vertex1 and vertex2. NULL if there is none. */
const ply_element *ffd_ply_find_edges(const ply_document *document);

/* Refuses corners of faces that are not numbers of vertices. */
ffd_status ffd_ply_check_faces(const ply_document *document, ffd_error *error);

/* Finds the properties of Gaussian splats. */
void ffd_ply_find_splats(ply_document *document);
/* Where the number of a slot from PLY_ROTATION_SLOT to before PLY_REST_SLOT goes. */
double *ffd_ply_splat_number(splat_ellipsoid *splat, size_t slot);
/* What becomes of such a number of a vertex that is marked, as its type holds it. */
static inline double ply_new_splat_number(const ply_document *document, size_t vertex, size_t slot)
{
    const size_t at = PLY_ELLIPSOID * vertex + slot - PLY_ROTATION_SLOT;
    return document->float_splats ? (double)document->float_splats[at] : document->double_splats[at];
}
/* Makes room for the results of splats, of which none is changed. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_ply_begin_splats(ply_document *document, ffd_error *error);
/* How directions turn at a vertex whose marks say that they do. */
splat_turn ffd_ply_turn_of(const ply_document *document, size_t vertex);
/* The slot of a coefficient of a channel. */
static inline size_t ply_rest_slot(const ply_document *document, int channel, int coefficient)
{
    const int functions = harmonics_count(document->file.part.form.degree);
    return PLY_REST_SLOT + (size_t)(channel * functions + coefficient);
}
/* Whether the coefficients of a channel are numbers of their types: others stay as they were. */
bool ffd_ply_rests_fit(const ply_document *document, const double coefficients[HARMONICS_MOST], int channel);

/* The entries of the format's table. */
mesh_warn_function ffd_ply_warn;
mesh_read_splats_function ffd_ply_read_splats;
mesh_write_splats_function ffd_ply_write_splats;
mesh_open_function ffd_ply_open;
mesh_close_function ffd_ply_close;
mesh_begin_results_function ffd_ply_begin_results;
mesh_write_function ffd_ply_write_positions;
mesh_write_function ffd_ply_write_normals;
mesh_save_function ffd_ply_save;
mesh_mark_used_function ffd_ply_mark_used;
mesh_faces_function ffd_ply_faces;
mesh_mixed_faces_function ffd_ply_mixed_faces;
mesh_model_function ffd_ply_model;
mesh_describe_function ffd_ply_describe;
mesh_compare_function ffd_ply_compare;

#endif
