/* convert_job.c - the job of `ffd lattice convert`. */
#include "author/part.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/text/words.h"
#include "job/author/author_job.h"
#include "job/author/lattice_file.h"
#include "job/chain/lattice_memory.h"
#include "lattice/formats/readers.h"
#include <stdio.h>
#include <string.h>

void ffd_convert_desc_init(ffd_convert_desc *desc, size_t size)
{
    const ffd_convert_desc defaults = {.struct_size = sizeof defaults, .order = FFD_ORDER_DEFAULT};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

bool ffd_lattice_converts(const char *name)
{
    const lattice_format *const format = ffd_lattice_format(name);
    return format && format->kind != FORMAT_JSON;
}

/* What only JSON has. */
static ffd_status check_table(const author_job *job, ffd_error *error)
{
    if (job->desc.set_count > 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                             "has no placeholders: {set} is not for it");
    if (job->desc.has_time)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                             "has no keys: {time} is not for it");
    if (job->desc.mesh_count > 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                             "does not go round a mesh: {meshes} is not for it");
    return ffd_author_check(job, error);
}

static ffd_status read_other(const author_job *job, const lattice_format *format, const format_wish *wish,
                             author_input *input, ffd_error *error)
{
    char name[100];
    *input = (author_input){.memory = ffd_budget_make(job->desc.reading.memory)};
    TRY(check_table(job, error));
    input->lattices = ffd_alloc_zero(1, sizeof *input->lattices);
    if (!input->lattices)
        return ffd_fail_memory(error);
    TRY(ffd_lattice_read(format, &job->desc.lattice, wish, &input->memory, &input->lattices[0], error));
    input->count = 1;
    const size_t *const size = input->lattices[0]->size;
    ffd_name_shown(job->desc.lattice.path, name, sizeof name);
    if (format->traits & FORMAT_GOES_ON)
        ffd_log_line(
            &job->log, FFD_LOG_WARNING,
            "%s: Blender's lattices act beyond their box ({outside=extend}), and z is up in Blender: for "
            "glTF turn the lattice by -90 degrees about x (`ffd lattice set`)",
            name);
    if (wish->notes->is_rounded)
        ffd_log_line(&job->log, FFD_LOG_WARNING,
                     "%s: VTK writes text with 11 digits: write binary for all of them", name);
    if (wish->notes->found_order)
        ffd_log_line(&job->log, FFD_LOG_WARNING, "%s: %zu x %zu x %zu control points along u, v, w", name,
                     size[0], size[1], size[2]);
    return FFD_OK;
}

static ffd_status read_json(const author_job *job, const format_wish *wish, author_input *input,
                            ffd_error *error)
{
    TRY(ffd_format_check_wish(ffd_lattice_format("-"), job->desc.lattice.path, wish, error));
    return ffd_author_begin(job, input, error);
}

/* Some formats hold one state. */
static ffd_status choose_part(const lattice_format *format, const ffd_lattice *lattice, const char *output,
                              ffd_lattice_part *part, ffd_error *error)
{
    if (format->traits & FORMAT_HOLDS_BOTH) {
        *part = *part == FFD_PART_DEFAULT ? FFD_PART_BOTH : *part;
        return FFD_OK;
    }
    if (*part == FFD_PART_BOTH || (*part == FFD_PART_DEFAULT && !ffd_lattice_is_still(lattice)))
        return ffd_fail_file(error, FFD_E_ARGUMENT, output,
                             "holds one state of a lattice%s: choose rest or deformed ({part})",
                             *part == FFD_PART_BOTH ? ", not both" : ", and this one is deformed");
    *part = *part == FFD_PART_DEFAULT ? FFD_PART_REST : *part;
    return FFD_OK;
}

/* Names what a format of positions alone does not hold, and what it is read as. */
static void warn_of_losses(const author_job *job, const lattice_format *format, const ffd_lattice *made)
{
    char name[100], lost[80] = "";
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &made->knots[a];
        const char *const what = ffd_knots_closed(knots) ? "closed knots" : "knots";
        const bool is_default =
            knots->kind == KNOTS_CLAMPED && knots->degree == ffd_format_degree(made->size[a]);
        const size_t used = strlen(lost);
        if (!is_default)
            snprintf(lost + used, sizeof lost - used, "%s%s of %c", used ? ", " : "", what, "uvw"[a]);
    }
    const size_t used = strlen(lost);
    if (made->rest_weights)
        snprintf(lost + used, sizeof lost - used, "%sweights", used ? ", " : "");
    if (!lost[0])
        return;
    ffd_name_shown(job->desc.output, name, sizeof name);
    ffd_log_line(&job->log, FFD_LOG_WARNING,
                 "%s: %s holds positions alone, not the %s: it is read as clamped uniform, without weights, "
                 "of degree min(3, n - 1)",
                 name, format->what, lost);
}

static ffd_status write_other(const author_job *job, const lattice_format *format, const ffd_lattice *made,
                              ffd_error *error)
{
    file_output *output;
    ffd_status status;
    if (!made->rest)
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and %s needs positions ({meshes})",
                        format->what);
    TRY(ffd_author_output(job, &output, error));
    TRY_END(ffd_output_begin(output, job->desc.output, job->desc.force, error));
    TRY_END(ffd_format_writer(format)(made, output, error));
    TRY_END(ffd_output_commit(output, error));
    if (!(format->traits & (FORMAT_HOLDS_ALL | FORMAT_SHOWS)))
        warn_of_losses(job, format, made);
end:
    ffd_output_destroy(&output);
    return status;
}

/* Whether the lattice of a file is what is written, so that it need not be made once more: it has no moves or
   knots of its own. */
static bool is_as_read(const lattice_format *from, const ffd_lattice *lattice, ffd_lattice_part part)
{
    const bool is_plain = from->traits & FORMAT_TAKES_ORDER;
    return is_plain && (part == FFD_PART_BOTH || (part == FFD_PART_REST && ffd_lattice_is_still(lattice)));
}

/* Frees what a lattice has twice: of a file without moves its displacements are those that were built, and
   the deformed control points are wanted only where they are written as rest. */
static void forget_copies(const lattice_format *from, ffd_lattice_part part, ffd_lattice *lattice)
{
    if (from->kind == FORMAT_JSON)
        return;
    ffd_free(lattice->spec->deformed_offsets);
    lattice->spec->deformed_offsets = NULL;
    if (part != FFD_PART_DEFORMED) {
        ffd_free(lattice->deformed);
        lattice->deformed = NULL;
    }
}

static ffd_status convert(const author_job *job, const ffd_convert_desc *desc, ffd_error *error)
{
    const lattice_format *from;
    const lattice_format *const to = ffd_lattice_format(job->desc.output);
    format_notes notes = {.found_order = false};
    format_wish wish = {.finds_order = desc->order == FFD_ORDER_AUTO,
                        .finds_cage_order = desc->order == FFD_ORDER_DEFAULT,
                        .block = desc->block,
                        .notes = &notes};
    ffd_lattice_part part = desc->part;
    author_input input = {0};
    ffd_lattice *made = NULL;
    ffd_status status;
    memcpy(wish.size, desc->size, sizeof wish.size);
    memcpy(wish.degree, desc->degree, sizeof wish.degree);
    TRY_END(ffd_lattice_find_format(&job->desc.lattice, &from, error));
    TRY_END(ffd_lattice_format_check(from, job->desc.lattice.path, false, error));
    TRY_END(ffd_lattice_format_check(to, job->desc.output, true, error));
    TRY_END(from->kind == FORMAT_JSON ? read_json(job, &wish, &input, error)
                                      : read_other(job, from, &wish, &input, error));
    const ffd_lattice *const lattice = input.lattices[0];
    TRY_END(choose_part(to, lattice, job->desc.output, &part, error));
    if (!is_as_read(from, lattice, part)) {
        TRY_END(lattice->spec ? ffd_lattice_memory_take(&input.memory, lattice->spec, 0, error) : FFD_OK);
        forget_copies(from, part, input.lattices[0]);
        TRY_END(ffd_lattice_take_part(lattice, part, &made, error));
        ffd_lattice_destroy(&input.lattices[0]);
    }
    const ffd_lattice *const written = made ? made : input.lattices[0];
    TRY_END(to->kind == FORMAT_JSON ? ffd_author_write(job, written, error)
                                    : write_other(job, to, written, error));
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->lattices[0].path);
    ffd_lattice_destroy(&made);
    ffd_author_end(&input);
    return status;
}

static ffd_status check_desc(const ffd_convert_desc *desc, ffd_error *error)
{
    const bool has_size = desc->size[0] || desc->size[1] || desc->size[2];
    for (int a = 0; a < 3; a++) {
        if (has_size && desc->size[a] == 0)
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "{size} is 0 along %c: it is given along all directions, or along none",
                            "uvw"[a]);
        if (desc->degree[a] < 0 || desc->degree[a] > FFD_MAX_DEGREE)
            return ffd_fail(error, FFD_E_ARGUMENT, "{degree} %d along %c is not 1 to %d", desc->degree[a],
                            "uvw"[a], FFD_MAX_DEGREE);
    }
    if (desc->part < FFD_PART_DEFAULT || desc->part > FFD_PART_DEFORMED)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no part %d of a lattice", (int)desc->part);
    if (desc->order < FFD_ORDER_UVW || desc->order > FFD_ORDER_DEFAULT)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no order %d of points", (int)desc->order);
    return FFD_OK;
}

static ffd_status run(const author_job *job, const ffd_convert_desc *callers, ffd_error *error)
{
    ffd_convert_desc desc;
    ffd_convert_desc_init(&desc, sizeof desc);
    if (callers)
        TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_convert_desc", error));
    TRY(check_desc(&desc, error));
    if (!job->desc.lattice.path || !job->desc.output)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    return convert(job, &desc, error);
}

ffd_status ffd_lattice_convert_run(const ffd_author_desc *callers, const ffd_convert_desc *desc,
                                   ffd_error *error)
{
    author_job job;
    ffd_status status = ffd_author_take(callers, &job, error);
    job.writes_formats = true;
    if (!status)
        status = run(&job, desc, error);
    return ffd_author_leave(&job, status, error);
}
