/* meshopt_indices.c - streams of the modes TRIANGLES and INDICES. */
#include "base/little_endian.h"
#include "mesh/meshopt/meshopt_stream.h"
#include <stdbool.h>

#define LATEST 16 /* edges and vertices that are remembered */

/* What the high four bits of a code say, and what the low ones do. */
#define CODE_NO_EDGE 0xf
#define CODE_VERTEX_END 0xd /* below: a remembered vertex */
#define CODE_BEFORE 0xd
#define CODE_TABLE_END 0xe /* below: an entry of the table */
#define CODE_FROM_NEXT 0xfe
#define STORED 0xf /* an index that is written out */

typedef struct triangles {
    meshopt_stream *data;
    const unsigned char *table;
    uint32_t edges[LATEST][2], vertices[LATEST];
    size_t edge_count, vertex_count; /* that were ever remembered */
    uint32_t next, last;
    bool is_broken;
} triangles;

/* Reads a number of seven bits in each byte, the lowest first; false: it is not there or has no end. */
static bool read_number(meshopt_stream *from, uint32_t *number)
{
    *number = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        const unsigned char *byte = meshopt_take(from, 1);
        if (!byte)
            return false;
        *number |= (uint32_t)(*byte & 0x7f) << shift;
        if (!(*byte & 0x80))
            return true;
    }
    return false;
}

/* A difference has its sign in the lowest bit. */
static uint32_t unfold_sign(uint32_t value)
{
    return value >> 1 ^ (0u - (value & 1));
}

static void store_index(unsigned char *bytes, size_t stride, uint32_t index)
{
    if (stride == 2)
        store_u16(bytes, (uint16_t)index);
    else
        store_u32(bytes, index);
}

static uint32_t read_index(triangles *t)
{
    uint32_t index;
    t->is_broken = !read_number(t->data, &index) || t->is_broken;
    t->last += unfold_sign(index);
    return t->last;
}

/* Returns the vertex that was remembered before `age` others. */
static uint32_t recall_vertex(triangles *t, size_t age)
{
    t->is_broken = age >= t->vertex_count || t->is_broken;
    return t->vertices[(t->vertex_count - 1 - age) % LATEST];
}

static void remember_vertex(triangles *t, uint32_t vertex)
{
    t->vertices[t->vertex_count++ % LATEST] = vertex;
}

static void remember_edge(triangles *t, uint32_t from, uint32_t to)
{
    uint32_t *edge = t->edges[t->edge_count++ % LATEST];
    edge[0] = from;
    edge[1] = to;
}

/* A triangle at an edge that is remembered. */
static void read_at_edge(triangles *t, unsigned age, unsigned third, uint32_t corners[3])
{
    const uint32_t *const edge = t->edges[(t->edge_count - 1 - age) % LATEST];
    t->is_broken = age >= t->edge_count || t->is_broken;
    corners[0] = edge[0];
    corners[1] = edge[1];
    if (third == 0)
        corners[2] = t->next++;
    else if (third < CODE_VERTEX_END)
        corners[2] = recall_vertex(t, third);
    else if (third == STORED)
        corners[2] = read_index(t);
    else
        corners[2] = t->last += third == CODE_BEFORE ? UINT32_MAX : 1;
    remember_edge(t, corners[2], corners[1]);
    remember_edge(t, corners[0], corners[2]);
    if (third == 0 || third >= CODE_VERTEX_END)
        remember_vertex(t, corners[2]);
}

/* Returns a corner by four bits: the next vertex, one that is remembered, or (if `may_be_stored`) one that is
   written out. */
static uint32_t read_corner(triangles *t, unsigned how, bool may_be_stored)
{
    if (how == 0)
        return t->next++;
    return how == STORED && may_be_stored ? read_index(t) : recall_vertex(t, how - 1);
}

/* A triangle without a remembered edge. */
static void read_alone(triangles *t, unsigned code, uint32_t corners[3])
{
    const bool is_tabled = (code & 0xf) < CODE_TABLE_END;
    unsigned how = 0;
    if (is_tabled)
        how = t->table[code & 0xf];
    else {
        const unsigned char *byte = meshopt_take(t->data, 1);
        t->is_broken = !byte || t->is_broken;
        how = byte ? *byte : 0;
        if (how == 0)
            t->next = 0;
    }
    const unsigned second = how >> 4, third = how & 0xf;
    corners[0] = is_tabled || code == CODE_FROM_NEXT ? t->next++ : read_index(t);
    corners[1] = read_corner(t, second, !is_tabled);
    corners[2] = read_corner(t, third, !is_tabled);
    remember_edge(t, corners[1], corners[0]);
    remember_edge(t, corners[2], corners[1]);
    remember_edge(t, corners[0], corners[2]);
    remember_vertex(t, corners[0]);
    if (second == 0 || second == STORED)
        remember_vertex(t, corners[1]);
    if (third == 0 || third == STORED)
        remember_vertex(t, corners[2]);
}

/* The two last entries of the table are 0, and none refers to an index that is written out. */
static bool is_table(const unsigned char *table)
{
    bool is_right = table[LATEST - 2] == 0 && table[LATEST - 1] == 0;
    for (size_t i = 0; i < LATEST; i++)
        is_right = is_right && table[i] >> 4 != STORED && (table[i] & 0xf) != STORED;
    return is_right;
}

ffd_status ffd_meshopt_read_triangles(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                      ffd_error *error)
{
    const size_t count = (size_t)view->count / 3, stride = (size_t)view->stride;
    const unsigned char *const codes = meshopt_take(from, count), *const table = from->end;
    triangles t = {.data = from, .table = table};
    if (!codes)
        return ffd_fail(error, FFD_E_INVALID, "the compressed data of mode TRIANGLES ends too early");
    if (!is_table(table))
        return ffd_fail(error, FFD_E_INVALID, "the table of the compressed data of mode TRIANGLES is broken");
    for (size_t i = 0; i < count; i++) {
        uint32_t corners[3];
        if (codes[i] >> 4 == CODE_NO_EDGE)
            read_alone(&t, codes[i], corners);
        else
            read_at_edge(&t, codes[i] >> 4, codes[i] & 0xf, corners);
        if (t.is_broken)
            return ffd_fail(error, FFD_E_INVALID, "triangle %zu of the compressed data is broken", i);
        for (size_t c = 0; c < 3; c++)
            store_index(bytes + (3 * i + c) * stride, stride, corners[c]);
    }
    return FFD_OK;
}

ffd_status ffd_meshopt_read_indices(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                    ffd_error *error)
{
    const size_t count = (size_t)view->count, stride = (size_t)view->stride;
    uint32_t last[2] = {0};
    for (size_t i = 0; i < count; i++) {
        uint32_t index;
        if (!read_number(from, &index))
            return ffd_fail(error, FFD_E_INVALID, "index %zu of the compressed data is broken", i);
        uint32_t *const base = &last[index & 1];
        *base += unfold_sign(index >> 1);
        store_index(bytes + i * stride, stride, *base);
    }
    return FFD_OK;
}
