/* pace.h - the search for many points in a lattice that may be slow: it ends at the deadline, and tells how
   long it may take. */
#ifndef FFD_JOB_CHAIN_PACE_H
#define FFD_JOB_CHAIN_PACE_H

#include "job/chain/chain.h"
#include "mesh/mesh_log.h"

/* How fast the searches of one thread are. */
typedef struct chain_pace {
    double points; /* that all threads search */
    int threads;
    const chain_link *links;            /* of the chain, */
    const ffd_lattice_source *lattices; /* and where they come from; NULL: unknown */
    const char *more;                   /* end of the warning */
    mesh_log log;
    uint64_t done;  /* points of this thread, */
    double seconds; /* and what they took */
    bool is_logged;
} chain_pace;

/* As ffd_locator_find of a link. pace: NULL, or warns once, after 100 points or more, if a point takes 10 ms
   and more; only from the thread of the job. Errors: FFD_E_MEMORY, FFD_E_LIMIT (also at the deadline). */
ffd_status ffd_pace_find(const chain_link *link, const double *x, size_t count, chain_pace *pace,
                         ffd_location *locations, ffd_error *error);

#endif
