/* marks.h - what a pass notes of each point for the count of torn edges: which links leave it, and which
   part of which volume gives its displacement. An edge whose ends have like marks is not torn.

   Layout (mark_layout): planes of one byte a point.
   - Bits. Bit 0: no link may move the point. Bit l + 1: link l leaves the point where it is, because it is
     outside of the link. Blocks count as one link.
   - Owners, of blocks: the block that gives the displacement, in two bytes, the lower one first.
   - Parts, of volumes that are not boxes: where u, v and w are in the domain, a byte each. */
#ifndef FFD_JOB_CHAIN_MARKS_H
#define FFD_JOB_CHAIN_MARKS_H

#include "job/chain/chain.h"

#define KEPT_ALWAYS 1u

static inline size_t ffd_kept_plane(size_t link)
{
    return (link + 1) / 8;
}

static inline uint8_t ffd_kept_bit(size_t link)
{
    return (uint8_t)(1u << (link + 1) % 8);
}

/* An owner's number, and whether it holds the point or is the nearest of all blocks. */
#define OWNER_NONE 0xffffu
#define OWNER_NEAREST 0x8000u

/* Lays out the marks of a chain whose links are fitted. owners: whether blocks note owners; those of which
   some are not boxes always do. */
void ffd_marks_lay_out(lattice_chain *chain, bool owners);

/* Marks a point of a run, if it has marks, as left by a link. */
void ffd_mark_kept(chain_run *run, size_t point, size_t link);
/* Sets the owner of a point, if it has marks and blocks note owners. */
void ffd_mark_owner(const lattice_chain *chain, const chain_run *run, size_t point, unsigned owner);
/* Sets the part of a link that a point is in, if it has marks. uvw: in the link; NULL: the link does not move
   the point, or no single u,v,w can be told. */
void ffd_mark_part(const lattice_chain *chain, size_t link, const chain_run *run, size_t point,
                   const double uvw[3]);

/* Planes of marks of many points. */
typedef struct mark_planes {
    const uint8_t *bytes;
    size_t points; /* size of a plane */
} mark_planes;

/* Whether a link leaves a point. */
static inline bool ffd_marks_keep(const mark_planes *marks, size_t point, size_t link)
{
    return marks->bytes[ffd_kept_plane(link) * marks->points + point] & ffd_kept_bit(link);
}

/* Whether a link moves a point. */
static inline bool ffd_marks_take(const mark_planes *marks, size_t point, size_t link)
{
    return !(marks->bytes[point] & KEPT_ALWAYS) && !ffd_marks_keep(marks, point, link);
}

/* Whether one of the first `links` links moves a point. */
bool ffd_marks_take_any(const mark_planes *marks, size_t point, size_t links);
/* Returns the owner of a point, with OWNER_NEAREST, or OWNER_NONE. */
unsigned ffd_marks_owner(const lattice_chain *chain, const mark_planes *marks, size_t point);
/* Whether two points that the same links move are in like parts of the volumes: equal or neighbouring
   ones. */
bool ffd_marks_are_near(const lattice_chain *chain, const mark_planes *marks, size_t a, size_t b);

#endif
