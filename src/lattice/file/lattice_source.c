#include "lattice/file/lattice_source.h"
#include "base/file/input.h"

static bool is_in_memory(const ffd_lattice_source *source)
{
    return source->object || source->text.data;
}

bool ffd_lattice_is_stream(const ffd_lattice_source *source)
{
    return !is_in_memory(source) && ffd_file_is_stream(source->path);
}

const char *ffd_lattice_file(const ffd_lattice_source *source)
{
    return is_in_memory(source) || ffd_file_is_stream(source->path) ? NULL : source->path;
}

const char *ffd_lattice_name(const ffd_lattice_source *source)
{
    return is_in_memory(source) ? source->path : ffd_file_display_name(source->path);
}
