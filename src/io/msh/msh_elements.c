/* msh_elements.c - the elements of a mesh of Gmsh, as cells with their points in VTK's order. */
#include "base/system/deadline.h"
#include "io/msh/msh_reader.h"
#include <inttypes.h>

/* The most points of an element of the types below. */
#define MOST_POINTS 286
/* The bytes of an element, at least. */
#define LEAST_TEXT 4

typedef struct element_type {
    uint8_t kind;         /* of the cell; 0: not supported */
    uint16_t count;       /* points */
    const uint8_t *order; /* of the points from `first` on, in VTK's order; NULL: the same */
    uint8_t first;
} element_type;

/* By Gmsh's manual, "Node ordering", and VTK's file formats. */
static const uint8_t tetra10[] = {9, 8};
static const uint8_t hexahedron[] = {8,  11, 13, 9,  16, 18, 19, 17, 10, 12,
                                     14, 15, 22, 23, 21, 24, 20, 25, 26};
static const uint8_t wedge[] = {6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};
static const uint8_t pyramid[] = {5, 8, 10, 6, 7, 9, 11, 12, 13};

/* From order 3 on they are Lagrange's, of which only the corners are used. */
enum { CURVE = 68, TRIANGLES = 69, QUADS = 70, TETRAS = 71, HEXAHEDRA = 72, WEDGES = 73, PYRAMIDS = 74 };
/* clang-format off */
static const element_type types[] = {
    [1] = {CELL_LINE, 2, NULL, 0},
    [2] = {CELL_TRIANGLE, 3, NULL, 0},
    [3] = {CELL_QUAD, 4, NULL, 0},
    [4] = {CELL_TETRA, 4, NULL, 0},
    [5] = {CELL_HEXAHEDRON, 8, NULL, 0},
    [6] = {CELL_WEDGE, 6, NULL, 0},
    [7] = {CELL_PYRAMID, 5, NULL, 0},
    [8] = {21, 3, NULL, 0},
    [9] = {22, 6, NULL, 0},
    [10] = {28, 9, NULL, 0},
    [11] = {24, 10, tetra10, 8},
    [12] = {29, 27, hexahedron, 8},
    [13] = {32, 18, wedge, 6},
    [14] = {PYRAMIDS, 14, pyramid, 5},
    [15] = {CELL_VERTEX, 1, NULL, 0},
    [16] = {23, 8, NULL, 0},
    [17] = {25, 20, hexahedron, 8},
    [18] = {26, 15, wedge, 6},
    [19] = {27, 13, pyramid, 5},
    [20] = {TRIANGLES, 9, NULL, 0}, [21] = {TRIANGLES, 10, NULL, 0}, [22] = {TRIANGLES, 12, NULL, 0},
    [23] = {TRIANGLES, 15, NULL, 0}, [24] = {TRIANGLES, 15, NULL, 0}, [25] = {TRIANGLES, 21, NULL, 0},
    [26] = {35, 4, NULL, 0}, [27] = {CURVE, 5, NULL, 0}, [28] = {CURVE, 6, NULL, 0},
    [29] = {TETRAS, 20, NULL, 0}, [30] = {TETRAS, 35, NULL, 0}, [31] = {TETRAS, 56, NULL, 0},
    [36] = {QUADS, 16, NULL, 0}, [37] = {QUADS, 25, NULL, 0}, [38] = {QUADS, 36, NULL, 0},
    [42] = {TRIANGLES, 28, NULL, 0}, [43] = {TRIANGLES, 36, NULL, 0}, [44] = {TRIANGLES, 45, NULL, 0},
    [45] = {TRIANGLES, 55, NULL, 0}, [46] = {TRIANGLES, 66, NULL, 0},
    [47] = {QUADS, 49, NULL, 0}, [48] = {QUADS, 64, NULL, 0}, [49] = {QUADS, 81, NULL, 0},
    [50] = {QUADS, 100, NULL, 0}, [51] = {QUADS, 121, NULL, 0},
    [62] = {CURVE, 7, NULL, 0}, [63] = {CURVE, 8, NULL, 0}, [64] = {CURVE, 9, NULL, 0},
    [65] = {CURVE, 10, NULL, 0}, [66] = {CURVE, 11, NULL, 0},
    [71] = {TETRAS, 84, NULL, 0}, [72] = {TETRAS, 120, NULL, 0}, [73] = {TETRAS, 165, NULL, 0},
    [74] = {TETRAS, 220, NULL, 0}, [75] = {TETRAS, 286, NULL, 0},
    [90] = {WEDGES, 40, NULL, 0}, [91] = {WEDGES, 75, NULL, 0},
    [92] = {HEXAHEDRA, 64, NULL, 0}, [93] = {HEXAHEDRA, 125, NULL, 0}, [94] = {HEXAHEDRA, 216, NULL, 0},
    [118] = {PYRAMIDS, 30, NULL, 0}, [119] = {PYRAMIDS, 55, NULL, 0},
};
/* clang-format on */

static ffd_status find_type(msh_reader *r, int64_t number, const element_type **type)
{
    if (number > 0 && number < (int64_t)(sizeof types / sizeof *types) && types[number].kind) {
        *type = &types[number];
        return FFD_OK;
    }
    return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, msh_line(r),
                         "elements of the type %" PRId64 " are not supported", number);
}

/* Takes the points of an element. */
static ffd_status take_points(msh_reader *r, const element_type *type)
{
    uint32_t found[MOST_POINTS];
    uint64_t tag;
    for (size_t p = 0; p < type->count; p++) {
        TRY(ffd_msh_size(r, "the node of an element", &tag));
        TRY(ffd_msh_vertex(r, tag, &found[p]));
    }
    for (size_t p = 0; p < type->count; p++) {
        const size_t from = type->order && p >= type->first ? type->order[p - type->first] : p;
        TRY(ffd_cells_word(&r->d->cells, found[from], r->error));
    }
    return ffd_cells_end(&r->d->cells, type->kind, r->d->file.part.vertex_count, r->error);
}

/* A group that points are added to. */
typedef struct group_filler {
    msh_reader *r;
    size_t group;
    ffd_status status;
} group_filler;

static void add_point(void *context, uint32_t point)
{
    group_filler *const filler = context;
    if (!filler->status)
        filler->status = ffd_volume_group_add(filler->r->d, filler->group, point, filler->r->error);
}

/* Adds the points of the cells from `first` on to the physical group of a dimension. */
static ffd_status add_to_group(msh_reader *r, uint64_t dimension, int64_t physical, size_t first)
{
    group_filler filler = {.r = r};
    TRY(ffd_msh_physical(r, dimension, physical, &filler.group));
    for (size_t c = first; c < r->d->cells.count; c++)
        ffd_cell_visit(&r->d->cells, c, add_point, &filler);
    return filler.status;
}

/* The tags and points of an element of version 2. */
static ffd_status take_old_element(msh_reader *r, const element_type *type, int64_t tags)
{
    const size_t cell = r->d->cells.count;
    int64_t physical = 0, tag;
    for (int64_t t = 0; t < tags; t++) {
        TRY(ffd_msh_int(r, "a tag of an element", &tag));
        physical = t == 0 ? tag : physical;
    }
    TRY(take_points(r, type));
    const uint64_t dimension = ffd_cell_kind(type->kind)->dimension;
    return physical ? add_to_group(r, dimension, physical, cell) : FFD_OK;
}

/* In text: number, type, number of tags, tags, points. */
static ffd_status take_old_text(msh_reader *r, uint64_t count)
{
    const element_type *type = NULL;
    int64_t number, kind, tags;
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(ffd_msh_int(r, "the number of an element", &number));
        TRY(ffd_msh_int(r, "the type of an element", &kind));
        TRY(ffd_msh_int(r, "the number of tags", &tags));
        TRY(find_type(r, kind, &type));
        TRY(take_old_element(r, type, tags));
    }
    return FFD_OK;
}

/* In binary: type, number of elements and of tags; for each of the elements its number, tags, points. */
static ffd_status take_old_binary(msh_reader *r, uint64_t count)
{
    const element_type *type = NULL;
    int64_t kind, elements, tags, number;
    for (uint64_t i = 0; i < count; i += (uint64_t)elements) {
        TRY(ffd_msh_int(r, "the type of elements", &kind));
        TRY(ffd_msh_int(r, "the number of elements", &elements));
        TRY(ffd_msh_int(r, "the number of tags", &tags));
        TRY(find_type(r, kind, &type));
        if (elements < 1 || (uint64_t)elements > count - i)
            return MSH_REFUSE(r, "a block of %" PRId64 " elements is there, but %" PRIu64 " are left",
                              elements, count - i);
        for (int64_t e = 0; e < elements; e++) {
            TRY(ffd_deadline_check_at((size_t)e, r->error));
            TRY(ffd_msh_int(r, "the number of an element", &number));
            TRY(take_old_element(r, type, tags));
        }
    }
    return FFD_OK;
}

static ffd_status take_old(msh_reader *r)
{
    uint64_t count;
    const bool is_binary = r->is_binary;
    r->is_binary = false; /* this number is always text */
    const ffd_status status = ffd_msh_count(r, "the number of elements", LEAST_TEXT, &count);
    ffd_text_next_line(&r->scan);
    r->is_binary = is_binary;
    TRY(status);
    return is_binary ? take_old_binary(r, count) : take_old_text(r, count);
}

/* The elements of an entity: its dimension and tag, their type and number; for each its tag and points. */
static ffd_status take_block(msh_reader *r, uint64_t *left)
{
    const element_type *type = NULL;
    int64_t dimension, entity, kind;
    const size_t cell = r->d->cells.count;
    uint64_t count, tag;
    TRY(ffd_msh_int(r, "the dimension of an entity", &dimension));
    TRY(ffd_msh_int(r, "the tag of an entity", &entity));
    TRY(ffd_msh_int(r, "the type of elements", &kind));
    TRY(ffd_msh_count(r, "the number of elements", LEAST_TEXT, &count));
    TRY(find_type(r, kind, &type));
    if (count > *left)
        return MSH_REFUSE(r, "the entities have more elements than are stated");
    *left -= count;
    for (uint64_t e = 0; e < count; e++) {
        TRY(ffd_deadline_check_at((size_t)e, r->error));
        TRY(ffd_msh_size(r, "the tag of an element", &tag));
        TRY(take_points(r, type));
    }
    const msh_entity wanted = {(uint64_t)dimension, entity, 0};
    for (size_t i = ffd_msh_find_entity(r, &wanted); ffd_msh_is_entity(r, i, &wanted); i++)
        TRY(add_to_group(r, wanted.dimension, r->entities[i].physical, cell));
    return FFD_OK;
}

static ffd_status take_new(msh_reader *r)
{
    uint64_t blocks, count, least, most;
    TRY(ffd_msh_count(r, "the number of entities", LEAST_TEXT, &blocks));
    TRY(ffd_msh_count(r, "the number of elements", LEAST_TEXT, &count));
    TRY(ffd_msh_size(r, "the least tag", &least));
    TRY(ffd_msh_size(r, "the greatest tag", &most));
    for (uint64_t b = 0; b < blocks; b++)
        TRY(take_block(r, &count));
    return count == 0 ? FFD_OK : MSH_REFUSE(r, "%" PRIu64 " elements that are stated are not there", count);
}

ffd_status ffd_msh_elements(msh_reader *r)
{
    if (!r->has_nodes)
        return MSH_REFUSE(r, "the elements are there before the nodes");
    return r->is_new ? take_new(r) : take_old(r);
}
