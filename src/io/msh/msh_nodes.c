/* msh_nodes.c - the nodes of a mesh of Gmsh, and their tags. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/msh/msh_reader.h"
#include <inttypes.h>
#include <stdlib.h>

/* The bytes of a node, at least: in text its tag and coordinates of a digit each. */
#define LEAST_TEXT 8
#define LEAST_BINARY 28

static ffd_status make_nodes(msh_reader *r, uint64_t count)
{
    TRY(ffd_volume_make_points(r->d, count, msh_line(r), r->error));
    r->tags = ffd_alloc((size_t)count, sizeof *r->tags);
    return r->tags ? FFD_OK : ffd_fail_memory(r->error);
}

static void add_tag(msh_reader *r, uint64_t tag)
{
    r->tags[r->tag_count] = (msh_tag){tag, (uint32_t)r->tag_count};
    r->tag_count++;
}

/* Reads the coordinates of nodes. width: numbers of a node, of which the first three are x y z; before:
   bytes, or words, in front of these. */
static ffd_status add_piece(msh_reader *r, size_t vertex, uint64_t count, size_t width, size_t before)
{
    const char *last;
    size_t line;
    const number_run run = {.type = NUMBER_DOUBLE,
                            .is_text = !r->is_binary,
                            .is_big = r->is_big,
                            .count = (size_t)count,
                            .width = 3,
                            .before = before,
                            .stride = 8 * width + before,
                            .has_lines = true,
                            .first = r->scan.at,
                            .last = r->scan.last,
                            .line = msh_line(r)};
    TRY(ffd_volume_add_piece(r->d, MESH_POSITIONS, vertex, &run, &last, &line, r->error));
    r->scan.at = last;
    r->scan.line = line;
    return FFD_OK;
}

/* Takes the number of a node in binary, its coordinates, the dimension and tag of its entity, and its
   parameters there: one on a curve, two on a surface. */
static ffd_status take_parametric(msh_reader *r, size_t *parameters)
{
    uint64_t tag;
    int64_t dimension, entity;
    TRY(ffd_msh_size(r, "the number of a node", &tag));
    TRY(ffd_msh_skip(r, 3));
    TRY(ffd_msh_int(r, "the dimension of an entity", &dimension));
    TRY(ffd_msh_int(r, "the tag of an entity", &entity));
    if (dimension < 0 || dimension > 3)
        return MSH_REFUSE(r, "the dimension of an entity is %" PRId64, dimension);
    *parameters = dimension == 3 ? 0 : (size_t)dimension;
    add_tag(r, tag);
    return ffd_msh_skip(r, *parameters);
}

/* Reads the coordinates of nodes that begin at a place, and comes back. */
static ffd_status add_parametric(msh_reader *r, const text_scan *begin, size_t vertex, uint64_t count,
                                 size_t parameters)
{
    const text_scan here = r->scan;
    r->scan = *begin;
    TRY(add_piece(r, vertex, count, 4 + parameters, 4)); /* dimension and tag are as long as a number */
    r->scan = here;
    return FFD_OK;
}

/* Takes parametric nodes in binary. Nodes that follow each other and have as many parameters are a piece. */
static ffd_status take_all_parametric(msh_reader *r, uint64_t count)
{
    text_scan begin = r->scan;
    size_t vertex = 0, parameters = 0, found = 0;
    for (size_t i = 0; i < count; i++, parameters = found) {
        const text_scan before = r->scan;
        TRY(ffd_deadline_check_at(i, r->error));
        TRY(take_parametric(r, &found));
        if (i == vertex || found == parameters)
            continue;
        TRY(add_parametric(r, &begin, vertex, i - vertex, parameters));
        begin = before;
        vertex = i;
    }
    return count ? add_parametric(r, &begin, vertex, count - vertex, parameters) : FFD_OK;
}

/* number x y z, in text behind it what else a line has */
static ffd_status take_old(msh_reader *r, bool is_parametric)
{
    uint64_t count, tag;
    /* In binary, too, this number is text. */
    const bool is_binary = r->is_binary;
    r->is_binary = false;
    ffd_status status =
        ffd_msh_count(r, "the number of nodes", is_binary ? LEAST_BINARY : LEAST_TEXT, &count);
    if (!status && !ffd_text_next_line(&r->scan) && count)
        status = MSH_REFUSE(r, "the file ends before the nodes");
    r->is_binary = is_binary;
    TRY(status);
    TRY(make_nodes(r, count));
    if (is_binary && is_parametric)
        return take_all_parametric(r, count);
    const text_scan first = r->scan;
    const char *at = r->scan.at;
    TRY(add_piece(r, 0, count, 3, is_binary ? 4 : 1));
    const text_scan last = r->scan;
    r->scan = first;
    for (uint64_t i = 0; i < count; i++, at += LEAST_BINARY) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        if (is_binary)
            r->scan.at = at;
        TRY(ffd_msh_size(r, "the number of a node", &tag));
        add_tag(r, tag);
        if (!is_binary)
            ffd_text_next_line(&r->scan);
    }
    r->scan = last;
    return FFD_OK;
}

/* dimension, tag, whether it has parameters, and the number of nodes; their tags; their coordinates */
static ffd_status take_block(msh_reader *r, uint64_t nodes)
{
    int64_t dimension, entity, is_parametric;
    uint64_t count, tag;
    TRY(ffd_msh_int(r, "the dimension of an entity", &dimension));
    TRY(ffd_msh_int(r, "the tag of an entity", &entity));
    TRY(ffd_msh_int(r, "whether nodes are parametric", &is_parametric));
    TRY(ffd_msh_count(r, "the number of nodes of an entity", LEAST_TEXT, &count));
    if (dimension < 0 || dimension > 3)
        return MSH_REFUSE(r, "the dimension of an entity is %" PRId64, dimension);
    if (count > nodes - r->tag_count)
        return MSH_REFUSE(r, "the entities have more nodes than the %" PRIu64 " that are stated", nodes);
    const size_t vertex = r->tag_count;
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(ffd_msh_size(r, "the tag of a node", &tag));
        add_tag(r, tag);
    }
    if (is_parametric && dimension > 0 && count > 0)
        r->d->kept = "the nodes have parameters on curves and surfaces, which stay as they are";
    if (!r->is_binary)
        ffd_text_next_line(&r->scan);
    return add_piece(r, vertex, count, 3 + (is_parametric ? (size_t)dimension : 0), 0);
}

static ffd_status take_new(msh_reader *r)
{
    uint64_t blocks, count, least, most;
    TRY(ffd_msh_count(r, "the number of entities", LEAST_TEXT, &blocks));
    TRY(ffd_msh_count(r, "the number of nodes", LEAST_TEXT, &count));
    TRY(ffd_msh_size(r, "the least tag", &least));
    TRY(ffd_msh_size(r, "the greatest tag", &most));
    TRY(make_nodes(r, count));
    for (uint64_t b = 0; b < blocks; b++)
        TRY(take_block(r, count));
    return r->tag_count == count ? FFD_OK
                                 : MSH_REFUSE(r, "%" PRIu64 " nodes are stated, but the entities have %zu",
                                              count, r->tag_count);
}

static int compare_tags(const void *a, const void *b)
{
    const msh_tag *const x = a, *const y = b;
    return x->tag < y->tag ? -1 : x->tag > y->tag;
}

ffd_status ffd_msh_nodes(msh_reader *r, bool is_parametric)
{
    bool is_sorted = true;
    if (r->has_nodes)
        return MSH_REFUSE(r, "there are nodes twice");
    r->has_nodes = true;
    if (is_parametric)
        r->d->kept = "the nodes have parameters on curves and surfaces, which stay as they are";
    TRY(r->is_new ? take_new(r) : take_old(r, is_parametric));
    for (size_t i = 1; i < r->tag_count && is_sorted; i++)
        is_sorted = r->tags[i - 1].tag < r->tags[i].tag;
    if (!is_sorted)
        qsort(r->tags, r->tag_count, sizeof *r->tags, compare_tags);
    for (size_t i = 1; i < r->tag_count; i++)
        if (r->tags[i - 1].tag == r->tags[i].tag)
            return MSH_REFUSE(r, "the node %" PRIu64 " is there twice", r->tags[i].tag);
    return FFD_OK;
}

ffd_status ffd_msh_vertex(msh_reader *r, uint64_t tag, uint32_t *vertex)
{
    /* Most files number their nodes from 1. */
    if (tag > 0 && tag <= r->tag_count && r->tags[tag - 1].tag == tag) {
        *vertex = r->tags[tag - 1].vertex;
        return FFD_OK;
    }
    const msh_tag wanted = {tag, 0};
    const msh_tag *const found =
        r->tag_count ? bsearch(&wanted, r->tags, r->tag_count, sizeof *r->tags, compare_tags) : NULL;
    if (!found)
        return MSH_REFUSE(r, "an element has the node %" PRIu64 ", which is not there", tag);
    *vertex = found->vertex;
    return FFD_OK;
}
