/* lattice_new.c - the job of `ffd lattice new`. */
#include "base/memory/memory.h"
#include "job/input/source.h"
#include <math.h>
#include <string.h>

/* The positions of all vertices in the lattice's space (free with ffd_free); NULL when there is no memory. */
static double *all_positions(const mesh_document *document, uint64_t count)
{
    double *xyz = count <= SIZE_MAX ? ffd_alloc((size_t)count, 3 * sizeof *xyz) : NULL;
    size_t first = 0;
    for (size_t part = 0; xyz && part < document->part_count; part++) {
        if (document->parts[part].repeats_positions)
            continue;
        const size_t vertices = document->parts[part].vertex_count;
        ffd_source_positions(document, part, 0, vertices, xyz + 3 * first);
        first += vertices;
    }
    return xyz;
}

static ffd_status create_round(const ffd_source *mesh, const ffd_lattice_desc *desc, ffd_lattice **lattice,
                               ffd_error *error)
{
    static const ffd_bounds everywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    mesh_document *document;
    ffd_status status = ffd_source_open(mesh, 0, &document, error);
    if (status != FFD_OK)
        return status;
    const uint64_t count = ffd_mesh_vertex_count(document);
    double *xyz = NULL;
    status = ffd_mesh_check(document, error);
    if (status == FFD_OK && document->format->check_reach)
        status = document->format->check_reach(document, &everywhere, error);
    if (status == FFD_OK) {
        xyz = all_positions(document, count);
        status = xyz ? ffd_lattice_create(desc, xyz, (size_t)count, lattice, error) : ffd_fail_memory(error);
    }
    ffd_free(xyz);
    ffd_source_close(&document);
    /* Other failures are of the description, not of the mesh. */
    if (status == FFD_E_INVALID)
        ffd_fail_name_file(error, ffd_source_name(mesh));
    return status;
}

ffd_status ffd_lattice_new_run(const ffd_source *mesh, const ffd_lattice_desc *desc, const char *output,
                               bool force, ffd_error *error)
{
    if (!ffd_output_is_stream(output) && ffd_file_same(mesh->path, output))
        return ffd_fail_file(error, FFD_E_ARGUMENT, output, "the lattice would replace its mesh");
    ffd_lattice *lattice = NULL;
    ffd_status status = ffd_output_check(output, force, error);
    if (status == FFD_OK)
        status = create_round(mesh, desc, &lattice, error);
    if (status == FFD_OK)
        status = ffd_lattice_save(lattice, output, force, error);
    ffd_lattice_destroy(&lattice);
    return status;
}
