#include "job/chain/seals.h"
#include "author/seal.h"
#include "base/text/words.h"
#include "job/chain/lattice_memory.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <inttypes.h>

#define FACES 6

unsigned ffd_seal_named(const chain_seal *seal, const ffd_lattice *lattice)
{
    unsigned faces = 0;
    for (int a = 0; a < 3; a++)
        if (!ffd_knots_closed(&lattice->knots[a]))
            faces |= 3U << (2 * a);
    return seal->faces == FFD_FACES_ALL ? faces : seal->faces;
}

static ffd_status check_link(const chain_link *link, const chain_seal *seal, ffd_error *error)
{
    const unsigned faces = ffd_seal_named(seal, link->lattice);
    const ffd_status status = faces ? ffd_seal_check(link->lattice, seal->layers - 1, faces, error) : FFD_OK;
    if (status)
        ffd_fail_name_file(error, link->lattice->spec->name);
    return status;
}

ffd_status ffd_seals_begin(lattice_chain *chain, const chain_seal *seal, ffd_error *error)
{
    chain->seal = *seal;
    for (size_t l = 0; l < chain->count && seal->layers > 0; l++) {
        const lattice_spec *const spec = chain->links[l].lattice->spec;
        if (seal->faces != FFD_FACES_CUT)
            TRY(check_link(&chain->links[l], seal, error));
        const ffd_status status = ffd_lattice_memory_take(&chain->memory, spec, 0, error);
        if (status)
            ffd_fail_name_file(error, spec->name);
        TRY(status);
    }
    return FFD_OK;
}

/* Writes faces as "u- v+" to text of 3 characters for each. Returns their number. */
static uint64_t write_faces(unsigned faces, char *text)
{
    uint64_t count = 0;
    *text = 0;
    for (int f = 0; f < FACES; f++) {
        if (!(faces >> f & 1))
            continue;
        if (count++ > 0)
            *text++ = ' ';
        *text++ = "uvw"[f / 2];
        *text++ = "-+"[f % 2];
        *text = 0;
    }
    return count;
}

void ffd_seal_tell(const char *name, int continuity, size_t meshes, unsigned faces, uint64_t vertices,
                   const mesh_log *log)
{
    char shown[100], words[3 * FACES];
    const char *const cut = ffd_plural(meshes, "the mesh cuts", "the meshes cut");
    const uint64_t count = write_faces(faces, words);
    ffd_name_shown(name, shown, sizeof shown);
    if (count == 0)
        ffd_log_line(log, FFD_LOG_INFO, "%s: %s no face: none is held", shown, cut);
    else
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%s: %s %" PRIu64 " %s, held at C%d: %s (%" PRIu64 " %s outside %s an edge to inside)",
                     shown, cut, count, ffd_plural(count, "face", "faces"), continuity, words, vertices,
                     ffd_plural(vertices, "vertex", "vertices"), ffd_plural(vertices, "has", "have"));
}

void ffd_seal_warn(const ffd_lattice *before, const ffd_lattice *sealed, int continuity, const char *name,
                   const mesh_log *log)
{
    char shown[100];
    if (ffd_lattice_is_still(before) || !ffd_lattice_is_still(sealed))
        return;
    ffd_name_shown(name, shown, sizeof shown);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "%s: faces held at C%d leave nothing that moves of %zu x %zu x %zu control points", shown,
                 continuity, sealed->size[0], sealed->size[1], sealed->size[2]);
}

ffd_status ffd_seal_link(lattice_chain *chain, size_t l, unsigned faces, ffd_error *error)
{
    chain_link *const link = &chain->links[l];
    link->held = faces;
    if (!faces)
        return FFD_OK;
    const ffd_status status =
        ffd_lattice_seal(link->lattice, chain->seal.layers - 1, faces, &link->sealed, error);
    if (status)
        ffd_fail_name_file(error, link->lattice->spec->name);
    return status;
}
