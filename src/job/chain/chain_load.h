/* chain_load.h - reads the lattices of a chain, makes what they are searched with, and frees them. */
#ifndef FFD_JOB_CHAIN_CHAIN_LOAD_H
#define FFD_JOB_CHAIN_CHAIN_LOAD_H

#include "job/chain/chain.h"
#include "mesh/mesh_log.h"

/* The lattice files of a chain, with the values of their placeholders. */
typedef struct chain_files {
    const char *const *paths; /* count */
    const ffd_lattice *const
        *objects; /* count, each in place of its file, or NULL; or NULL: there are none */
    size_t count;
    const ffd_setting *set; /* set_count, or NULL */
    size_t set_count;
    bool rest_only;               /* a placeholder without a value does not matter (ffd_lattice_load_rest) */
    bool derives;                 /* the lattices are to say what comes from placeholders */
    const ffd_source *mesh;       /* of the job: meshes that lattices name are read likewise, and lattices
                                     take of its memory; NULL where they name none */
    const ffd_shared_box *shared; /* what "box": "mesh" goes round; NULL: the mesh of the job */
    const mesh_log *log;          /* gets the flaws of meshes that lattices name; NULL: they are not wanted */
} chain_files;

/* Makes a chain of these lattice files. share may be NULL; else it must outlive the chain, and gets what the
   chain made by ffd_cache_put_chain. */
ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_share *share, lattice_chain *chain, ffd_error *error);

/* Whether the lattice files can be read, with these values for their placeholders. Errors: as of
   ffd_chain_load, but for what only a mesh shows. */
ffd_status ffd_chain_check(const chain_files *files, ffd_error *error);

/* Frees what the chain owns: what is lent stays. Leaves an empty chain. */
void ffd_chain_free(lattice_chain *chain);

/* A chain of one link of another one, which has neither boxes nor seams yet and lends the link. */
lattice_chain ffd_chain_link_alone(const lattice_chain *whole, size_t link);
/* Frees what such a chain has made for itself. */
void ffd_chain_end_alone(lattice_chain *alone);

/* Makes the locator and border of a link whose lattice is fitted. */
ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error);

#endif
