/* chain_load.h - loads the lattices of a chain, makes their locators, and frees both. */
#ifndef FFD_JOB_CHAIN_CHAIN_LOAD_H
#define FFD_JOB_CHAIN_CHAIN_LOAD_H

#include "job/chain/chain.h"
#include "mesh/mesh_log.h"

/* The lattices of a chain, with the values of their placeholders. */
typedef struct chain_files {
    const ffd_lattice_source *lattices; /* count entries with paths or names */
    size_t count;
    const ffd_setting *set; /* set_count entries, or NULL */
    size_t set_count;
    ffd_lattice **made;           /* count lattices in place of those; the chain takes them; or NULL */
    const double *time;           /* of lattices that have keys; NULL: that of their first */
    bool rest_only;               /* allow placeholders without a value (ffd_lattice_load_rest) */
    bool derives;                 /* keep the derivatives by placeholders */
    const ffd_source *mesh;       /* the job's mesh: meshes that lattices name are read with its options, and
                                     lattices count against its memory; NULL if lattices name no meshes */
    const ffd_shared_box *shared; /* the box for "box": "mesh"; NULL: that of the job's mesh */
    const mesh_log *log;          /* gets warnings about meshes that lattices name; may be NULL */
} chain_files;

/* How the message begins that refuses values of placeholders which no lattice has. */
#define CHAIN_NO_PLACEHOLDER "no lattice has the placeholder"

/* Refuses more lattices than a job may have (FFD_E_LIMIT). */
ffd_status ffd_chain_check_count(size_t count, ffd_error *error);
/* Loads the lattices into a chain. cache: may be NULL; it must outlive the chain, and
   ffd_job_cache_put_chain hands it what the chain has made. */
ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_job_cache *cache, lattice_chain *chain, ffd_error *error);

/* Loads the lattices by themselves, without search structures, into lattices[0 .. files->count - 1], and lays
   their boxes round the meshes that they name, or files->shared; else one that needs the box of a mesh stays
   without positions. memory: the budget that they count against. box_files: gets the files of these meshes.
   After a failure all are NULL. Errors: those of ffd_chain_load. */
ffd_status ffd_chain_load_lattices(const chain_files *files, memory_budget *memory, ffd_lattice **lattices,
                                   path_list *box_files, ffd_error *error);

/* Checks that the lattice files are valid with these values. Errors: those of ffd_chain_load, except what
   depends on the job's mesh. */
ffd_status ffd_chain_check(const chain_files *files, ffd_error *error);

/* Frees all that the chain owns, and leaves an empty chain. */
void ffd_chain_free(lattice_chain *chain);

/* Returns a chain of one link, borrowed from another chain. It has no boxes or seams yet. */
lattice_chain ffd_chain_link_alone(const lattice_chain *whole, size_t link);
/* Frees the boxes and seams that were made for such a chain. */
void ffd_chain_end_alone(lattice_chain *alone);

/* Makes the locator of a link whose lattice is fitted, and its border if the chain extends. Uses the
   cache. */
ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error);
/* Returns whether u,v,w of a link take a search, as the volume is not a box. It has its locator. */
bool ffd_link_searches(const chain_link *link);

#endif
