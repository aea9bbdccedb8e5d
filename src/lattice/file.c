/* file.c - lattice files: load, save, and fit to a mesh. */
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "lattice/build.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "lattice/spec_parse.h"
#include "lattice/spec_text.h"

static ffd_status parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                        ffd_lattice **lattice, ffd_error *error)
{
    *lattice = NULL;
    lattice_spec *spec;
    ffd_status status = ffd_spec_parse(text, size, name, settings, &spec, error);
    if (status)
        return status;
    status = ffd_spec_build(spec, NULL, NULL, lattice, error);
    if (status)
        ffd_spec_free(spec);
    return status;
}

ffd_status ffd_lattice_parse(const char *text, size_t size, const char *name, ffd_lattice **lattice,
                             ffd_error *error)
{
    return parse(text, size, name, NULL, lattice, error);
}

ffd_status ffd_lattice_load(const char *path, ffd_lattice **lattice, ffd_error *error)
{
    return ffd_lattice_load_set(path, NULL, 0, NULL, lattice, error);
}

ffd_status ffd_lattice_load_set(const char *path, const ffd_setting *values, size_t count, bool *used,
                                ffd_lattice **lattice, ffd_error *error)
{
    const spec_settings settings = {values, used, count};
    *lattice = NULL;
    file_input input;
    ffd_status status = ffd_file_load(path, &input, error);
    if (status)
        return status;
    status = parse((const char *)input.data, input.size, path, &settings, lattice, error);
    ffd_file_unload(&input);
    return status;
}

ffd_status ffd_lattice_save(const ffd_lattice *lattice, const char *path, bool force, ffd_error *error)
{
    size_t size;
    char *const text = ffd_spec_text(lattice->spec, &size);
    if (!text)
        return ffd_fail_memory(error);
    file_output *output = NULL;
    ffd_status status = ffd_output_create(&output, error);
    if (!status)
        status = ffd_output_begin(output, path, force, error);
    if (!status)
        status = ffd_output_write(output, text, size, error);
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    ffd_free(text);
    return status;
}

bool ffd_lattice_needs_bounds(const ffd_lattice *lattice)
{
    return lattice->spec && lattice->spec->rest == SPEC_BOX_MESH;
}

ffd_status ffd_lattice_fit(ffd_lattice *lattice, const double min[3], const double max[3], ffd_error *error)
{
    if (!ffd_lattice_needs_bounds(lattice))
        return FFD_OK;
    /* Built anew beside the old one, which stays as it is when that fails. */
    ffd_lattice *fitted;
    const ffd_status status = ffd_spec_build(lattice->spec, min, max, &fitted, error);
    if (status)
        return status;
    const ffd_lattice old = *lattice;
    *lattice = *fitted;
    *fitted = old;
    fitted->spec = NULL;
    ffd_lattice_destroy(&fitted);
    return FFD_OK;
}
