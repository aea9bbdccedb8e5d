#include "job/author/lattice_file.h"
#include "base/file/mapping.h"
#include "job/chain/lattice_memory.h"
#include "lattice/build.h"
#include "lattice/formats/blender.h"
#include "lattice/formats/readers.h"

const lattice_format *ffd_lattice_source_format(const ffd_lattice_source *source)
{
    const bool is_in_memory = source->object || source->text.data;
    const lattice_format *const format = source->object ? NULL : ffd_lattice_format(source->path);
    return source->object || (is_in_memory && !format) ? ffd_lattice_format("-") : format;
}

ffd_status ffd_lattice_format_check(const lattice_format *format, const char *name, bool written,
                                    ffd_error *error)
{
    char endings[FORMAT_ENDINGS];
    if (format && format->traits & (written ? FORMAT_IS_WRITTEN : FORMAT_IS_READ))
        return FFD_OK;
    ffd_format_endings(written, endings);
    return ffd_fail_file(error, FFD_E_ARGUMENT, name, "has no ending of a lattice that is %s: %s",
                         written ? "written" : "read", endings);
}

ffd_status ffd_lattice_find_format(const ffd_lattice_source *source, const lattice_format **format,
                                   ffd_error *error)
{
    const unsigned losses = ffd_mapping_losses();
    file_input file;
    *format = ffd_lattice_source_format(source);
    if (!*format || (*format)->kind != FORMAT_JSON || source->object ||
        (!source->text.data && ffd_file_reads_once(source->path)))
        return FFD_OK;
    TRY(ffd_file_take(source->path, source->text, &file, error));
    *format = ffd_format_of_json(ffd_blender_is_json(&file));
    const ffd_status status = ffd_mapping_judge(losses, FFD_OK, error);
    ffd_file_unload(&file);
    return status;
}

static ffd_status read_spec(const lattice_format *format, const ffd_lattice_source *source,
                            const format_wish *wish, memory_budget *budget, lattice_spec **spec,
                            ffd_error *error)
{
    file_input file;
    format_wish bounded = *wish;
    memory_budget whole = *budget;
    TRY(ffd_format_check_wish(format, source->path, wish, error));
    TRY(ffd_file_take(source->path, source->text, &file, error));
    ffd_budget_add_file(&whole, file.size, 0);
    bounded.memory = ffd_budget_left(&whole);
    bounded.allowed = ffd_budget_most(&whole);
    ffd_status status = ffd_format_reader(format)(&file, source->path, &bounded, spec, error);
    if (!status)
        status = ffd_lattice_memory_take(budget, *spec, file.size, error);
    ffd_file_unload(&file);
    return status;
}

ffd_status ffd_lattice_read(const lattice_format *format, const ffd_lattice_source *source,
                            const format_wish *wish, memory_budget *budget, ffd_lattice **lattice,
                            ffd_error *error)
{
    const unsigned losses = ffd_mapping_losses();
    lattice_spec *spec = NULL;
    *lattice = NULL;
    ffd_status status =
        ffd_mapping_judge(losses, read_spec(format, source, wish, budget, &spec, error), error);
    if (!status)
        status = ffd_spec_build(spec, NULL, lattice, error);
    if (status)
        ffd_spec_free(spec);
    return status;
}
