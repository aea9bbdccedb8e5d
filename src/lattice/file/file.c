/* file.c - lattice files: load, save, and fit to a mesh. */
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/text_scan.h"
#include "lattice/build.h"
#include "lattice/copy.h"
#include "lattice/file/lattice_source.h"
#include "lattice/file/spec_parse.h"
#include "lattice/file/spec_set.h"
#include "lattice/file/spec_still.h"
#include "lattice/file/spec_text.h"
#include "lattice/formats/blender.h"
#include "lattice/formats/formats.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <string.h>

/* Makes the lattice of a spec. Takes ownership of the spec, also after a failure. */
static ffd_status build(lattice_spec *spec, ffd_lattice **lattice, ffd_error *error)
{
    const ffd_status status = ffd_spec_build(spec, NULL, lattice, error);
    if (status)
        ffd_spec_free(spec);
    return status;
}

ffd_status ffd_lattice_parse(const char *text, size_t size, const char *name, ffd_lattice **lattice,
                             ffd_error *error)
{
    lattice_spec *spec;
    *lattice = NULL;
    TRY(ffd_spec_parse(text, size, name, NULL, &spec, error));
    return build(spec, lattice, error);
}

ffd_status ffd_lattice_parse_set(const char *text, size_t size, const char *name, const ffd_setting *values,
                                 size_t count, bool *used, ffd_lattice **lattice, ffd_error *error)
{
    const spec_settings settings = {.values = values, .used = used, .count = count, .derives = true};
    lattice_spec *spec;
    *lattice = NULL;
    TRY(ffd_spec_parse(text, size, name, &settings, &spec, error));
    return build(spec, lattice, error);
}

ffd_status ffd_lattice_list_parameters(const char *text, size_t size, const char *name,
                                       ffd_parameter_function function, void *user, ffd_error *error)
{
    const spec_settings settings = {.may_be_open = true};
    lattice_spec *spec;
    bool goes_on = true;
    TRY(ffd_spec_parse(text, size, name, &settings, &spec, error));
    for (size_t i = 0; goes_on && i < spec->parameter_count; i++) {
        const spec_parameter *const from = &spec->parameters[i];
        const ffd_parameter parameter = {sizeof parameter, from->name, from->value, from->unit,
                                         from->comment,    from->min,  from->max};
        goes_on = function(user, &parameter);
    }
    ffd_spec_free(spec);
    return FFD_OK;
}

ffd_status ffd_lattice_load(const char *path, ffd_lattice **lattice, ffd_error *error)
{
    return ffd_lattice_load_set(path, NULL, 0, NULL, lattice, error);
}

/* A lattice file is JSON whatever its name. Who gives one of another program is told what reads it. */
static ffd_status refuse_other(const char *path, const file_input *input, ffd_error *error)
{
    text_scan scan;
    const lattice_format *const format = ffd_lattice_format(path);
    ffd_text_begin(&scan, input->data, input->size, false);
    if (!format || format->kind == FORMAT_JSON || !(format->traits & FORMAT_IS_READ) ||
        (ffd_text_find(&scan) && *scan.at == '{'))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_INVALID, path,
                         "is not JSON: of %s `ffd lattice convert` makes a lattice file", format->what);
}

/* Reads the file. *size is its size. */
static ffd_status load_file(const char *path, const spec_settings *settings, lattice_spec **spec,
                            size_t *size, ffd_error *error)
{
    file_input input;
    const unsigned losses = ffd_mapping_losses();
    TRY(ffd_file_load(path, &input, error));
    *size = input.size;
    ffd_status status = refuse_other(path, &input, error);
    if (!status)
        status = ffd_spec_parse((const char *)input.data, input.size, path, settings, spec, error);
    if (status == FFD_E_INVALID && ffd_blender_is_json(&input))
        status = ffd_fail_file(error, FFD_E_INVALID, path,
                               "is no lattice file: of %s `ffd lattice convert` makes one",
                               ffd_format_of_json(true)->what);
    ffd_file_unload(&input);
    return ffd_mapping_judge(losses, status, error);
}

ffd_status ffd_spec_load(const ffd_lattice_source *source, const spec_settings *settings, lattice_spec **spec,
                         size_t *size, ffd_error *error)
{
    const ffd_bytes *const text = &source->text;
    *spec = NULL;
    *size = text->size;
    ffd_status status;
    TRY_END(text->data ? ffd_spec_parse(text->data, text->size, source->path, settings, spec, error)
                       : load_file(source->path, settings, spec, size, error));
    if ((*spec)->mesh_count > 0 && !ffd_lattice_file(source))
        TRY_END(ffd_fail(
            error, FFD_E_ARGUMENT,
            "the lattice's box goes round meshes named relative to its file: it cannot be read from %s",
            text->data ? "memory" : ffd_file_display_name(source->path)));
end:
    if (status) {
        ffd_spec_free(*spec);
        *spec = NULL;
    }
    return status;
}

static ffd_status load(const char *path, const spec_settings *settings, ffd_lattice **lattice,
                       ffd_error *error)
{
    lattice_spec *spec;
    size_t size;
    *lattice = NULL;
    const ffd_status status =
        ffd_spec_load(&(ffd_lattice_source){.path = path}, settings, &spec, &size, error);
    return status ? status : build(spec, lattice, error);
}

ffd_status ffd_lattice_load_set(const char *path, const ffd_setting *values, size_t count, bool *used,
                                ffd_lattice **lattice, ffd_error *error)
{
    const spec_settings settings = {.values = values, .used = used, .count = count};
    return load(path, &settings, lattice, error);
}

ffd_status ffd_lattice_load_rest(const char *path, const ffd_setting *values, size_t count, bool *used,
                                 ffd_lattice **lattice, ffd_error *error)
{
    const spec_settings settings = {.values = values, .used = used, .count = count, .may_be_open = true};
    return load(path, &settings, lattice, error);
}

ffd_status ffd_lattice_list_open(const ffd_lattice_source *source, const ffd_setting *values, size_t count,
                                 bool *used, intern_table *open, ffd_error *error)
{
    const spec_settings settings = {.values = values, .used = used, .count = count, .may_be_open = true};
    lattice_spec *spec;
    size_t size;
    uint32_t index;
    TRY(ffd_spec_load(source, &settings, &spec, &size, error));
    ffd_status status = FFD_OK;
    for (uint32_t i = 0; i < spec->open.count; i++) {
        const char *const name = ffd_intern_key(&spec->open, i);
        if (!ffd_intern(open, name, strlen(name), &index))
            TRY_END(ffd_fail_memory(error));
    }
end:
    ffd_spec_free(spec);
    return status;
}

/* Returns a spec with the current state of an edited lattice: the result of the moves and of the caller's
   changes as offsets. Its arrays are borrowed from the lattice and its spec. */
static lattice_spec edited_spec(const ffd_lattice *lattice)
{
    lattice_spec spec = *lattice->spec;
    if (lattice->edited)
        ffd_spec_bake(lattice, &spec);
    return spec;
}

ffd_status ffd_lattice_text(const ffd_lattice *lattice, char **text, size_t *size, ffd_error *error)
{
    lattice_spec spec = edited_spec(lattice);
    double *own = NULL;
    *text = NULL;
    if (spec.keys.is_chosen)
        TRY(ffd_spec_still(lattice, &spec, &own, error));
    *text = ffd_spec_text(&spec, size);
    ffd_free(own);
    return *text ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_lattice_write(const ffd_lattice *lattice, file_output *output, const char *path, bool force,
                             ffd_error *error)
{
    size_t size;
    char *text;
    ffd_status status;
    TRY_END(ffd_lattice_text(lattice, &text, &size, error));
    TRY_END(ffd_output_begin(output, path, force, error));
    TRY_END(ffd_output_write(output, text, size, error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_free(text);
    return status;
}

ffd_status ffd_lattice_save(const ffd_lattice *lattice, const char *path, bool force, ffd_error *error)
{
    file_output *output;
    TRY(ffd_output_create(&output, error));
    const ffd_status status = ffd_lattice_write(lattice, output, path, force, error);
    ffd_output_destroy(&output);
    return status;
}

bool ffd_lattice_needs_bounds(const ffd_lattice *lattice)
{
    return lattice->spec && lattice->spec->rest == SPEC_BOX_MESH;
}

size_t ffd_lattice_get_mesh_count(const ffd_lattice *lattice)
{
    return lattice->spec ? lattice->spec->mesh_count : 0;
}

ffd_status ffd_spec_mesh(const lattice_spec *spec, size_t i, char **path, ffd_error *error)
{
    const char *const mesh = spec->meshes[i];
    *path = ffd_path_is_absolute(mesh) ? ffd_text_copy(mesh) : ffd_path_sibling(spec->name, mesh);
    return *path ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_lattice_get_mesh(const ffd_lattice *lattice, size_t i, char **path, ffd_error *error)
{
    const size_t count = ffd_lattice_get_mesh_count(lattice);
    *path = NULL;
    return i < count
               ? ffd_spec_mesh(lattice->spec, i, path, error)
               : ffd_fail(error, FFD_E_ARGUMENT, "there is no mesh %zu: the rest box names %zu", i, count);
}

ffd_status ffd_lattice_fit(ffd_lattice *lattice, const double min[3], const double max[3], ffd_error *error)
{
    fit_extent extent;
    for (int c = 0; c < 3; c++) {
        extent.min[c] = extent.shown_min[c] = min[c];
        extent.max[c] = extent.shown_max[c] = max[c];
    }
    return ffd_lattice_fit_extent(lattice, &extent, error);
}

ffd_status ffd_lattice_fit_extent(ffd_lattice *lattice, const fit_extent *extent, ffd_error *error)
{
    if (!ffd_lattice_needs_bounds(lattice))
        return FFD_OK;
    /* Builds a new lattice first, so that a failure leaves the old one unchanged. */
    ffd_lattice *fitted;
    const lattice_spec now = edited_spec(lattice);
    lattice_spec *const spec = lattice->edited ? ffd_spec_copy(&now) : lattice->spec;
    const ffd_status status = spec ? ffd_spec_build(spec, extent, &fitted, error) : ffd_fail_memory(error);
    if (status) {
        if (lattice->edited)
            ffd_spec_free(spec);
        return status;
    }
    const ffd_lattice old = *lattice;
    *lattice = *fitted;
    *fitted = old;
    fitted->spec = old.edited ? old.spec : NULL;
    ffd_lattice_destroy(&fitted);
    return FFD_OK;
}
