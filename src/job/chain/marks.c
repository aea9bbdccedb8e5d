#include "job/chain/marks.h"
#include "lattice/lattice.h"

/* A direction is cut into so many parts for each span, but at least and at most into these numbers. */
#define PARTS_OF_SPAN 4
#define LEAST_PARTS 64
#define MOST_PARTS 250
/* The mark of a point whose part is not known. */
#define NO_PART 255

static link_parts make_parts(const knot_vector *knots)
{
    const size_t wanted = PARTS_OF_SPAN * knots->span_count;
    const int count = (int)(wanted < LEAST_PARTS ? LEAST_PARTS : wanted > MOST_PARTS ? MOST_PARTS : wanted);
    const double first = ffd_knots_first(knots);
    return (link_parts){first, count / (ffd_knots_last(knots) - first), count};
}

void ffd_marks_lay_out(lattice_chain *chain, bool owners)
{
    mark_layout *const marks = &chain->marks;
    *marks = (mark_layout){.kept = ffd_kept_plane(ffd_chain_layers(chain) - 1) + 1};
    marks->planes = marks->kept;
    for (size_t l = 0; l < chain->count && chain->blocks; l++)
        owners = owners || !chain->links[l].is_convex;
    if (chain->blocks && owners) {
        marks->owners = marks->planes;
        marks->planes += 2;
    }
    marks->parts = marks->planes;
    for (size_t l = 0; l < chain->count; l++) {
        chain_link *const link = &chain->links[l];
        for (int a = 0; a < 3; a++)
            link->parts[a] = make_parts(&link->lattice->knots[a]);
        link->parts_plane = 0;
        if (link->is_convex || marks->parted_count == (chain->blocks ? 1 : MOST_PARTED))
            continue;
        marks->parted[marks->parted_count++] = (uint16_t)l;
        link->parts_plane = marks->planes;
        marks->planes += 3;
    }
    for (size_t l = 0; l < chain->count && chain->blocks && marks->parted_count > 0; l++)
        chain->links[l].parts_plane = marks->parts;
}

void ffd_mark_kept(chain_run *run, size_t point, size_t link)
{
    if (!run->kept)
        return;
    run->kept[ffd_kept_plane(link) * CHAIN_RUN + point] |= ffd_kept_bit(link);
    run->keeps = true;
}

void ffd_mark_owner(const lattice_chain *chain, const chain_run *run, size_t point, unsigned owner)
{
    const size_t plane = chain->marks.owners;
    if (!run->kept || plane == 0)
        return;
    run->kept[plane * CHAIN_RUN + point] = (uint8_t)owner;
    run->kept[(plane + 1) * CHAIN_RUN + point] = (uint8_t)(owner >> 8);
}

static void mark_parts(const chain_link *link, const double uvw[3], uint8_t *marks)
{
    for (size_t a = 0; a < 3; a++) {
        const link_parts *const parts = &link->parts[a];
        const int part = (int)((uvw[a] - parts->first) * parts->scale);
        marks[a * CHAIN_RUN] = (uint8_t)(part < parts->count ? part : parts->count - 1);
    }
}

void ffd_mark_part(const lattice_chain *chain, size_t link, const chain_run *run, size_t point,
                   const double uvw[3])
{
    const chain_link *const of = &chain->links[link];
    if (!run->kept || of->parts_plane == 0)
        return;
    uint8_t *const first = run->kept + of->parts_plane * CHAIN_RUN + point;
    if (uvw && !of->is_convex)
        mark_parts(of, uvw, first);
    else
        first[0] = first[CHAIN_RUN] = first[2 * CHAIN_RUN] = uvw ? 0 : NO_PART;
}

bool ffd_marks_take_any(const mark_planes *marks, size_t point, size_t links)
{
    for (size_t l = 0; l < links; l++)
        if (ffd_marks_take(marks, point, l))
            return true;
    return false;
}

unsigned ffd_marks_owner(const lattice_chain *chain, const mark_planes *marks, size_t point)
{
    const uint8_t *const low = marks->bytes + chain->marks.owners * marks->points;
    if (chain->marks.owners == 0 || !ffd_marks_take(marks, point, 0))
        return OWNER_NONE;
    return low[point] | (unsigned)low[marks->points + point] << 8;
}

/* Whether two marks of a direction are of equal or neighbouring parts. */
static bool are_neighbours(const chain_link *link, int direction, int a, int b)
{
    const int distance = a < b ? b - a : a - b;
    if (distance == 0 || a == NO_PART || b == NO_PART)
        return distance == 0;
    return distance == 1 || (ffd_knots_closed(&link->lattice->knots[direction]) &&
                             distance == link->parts[direction].count - 1);
}

bool ffd_marks_are_near(const lattice_chain *chain, const mark_planes *marks, size_t a, size_t b)
{
    const uint8_t *plane = marks->bytes + chain->marks.parts * marks->points;
    for (size_t index = 0; index < chain->marks.parted_count; index++) {
        const unsigned owner = chain->blocks ? ffd_marks_owner(chain, marks, a) : chain->marks.parted[index];
        if (owner == OWNER_NONE)
            return true;
        const chain_link *const link = &chain->links[owner & ~OWNER_NEAREST];
        for (int d = 0; d < 3; d++, plane += marks->points)
            if (!are_neighbours(link, d, plane[a], plane[b]))
                return false;
    }
    return true;
}
