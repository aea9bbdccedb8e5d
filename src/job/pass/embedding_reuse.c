#include "job/input/embedding_file.h"
#include "job/pass/pass.h"

ffd_status ffd_embedding_reuse(const char *path, const mesh_document *document, const ffd_lattice *lattice,
                               int threads, embedding_file *file, ffd_error *error)
{
    hash128 positions;
    const hash128 rest = ffd_embedding_hash_lattice(lattice);
    const ffd_status status = ffd_embedding_hash_positions(document, threads, &positions, error);
    if (status)
        return status;
    return ffd_embedding_open(path, (size_t)ffd_pass_vertex_count(document), &positions, &rest, file, error);
}
