/* set_job.c - the job of `ffd lattice set`. */
#include "author/deformed.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/trig.h"
#include "job/author/cut_seal.h"
#include "job/author/lattice_file.h"
#include "job/chain/lattice_memory.h"
#include "job/chain/seals.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

static bool takes_tables(const ffd_operation *of)
{
    return of->kind == FFD_OPERATION_DEFORMED || of->kind == FFD_OPERATION_DEFORMED_OFFSETS;
}

static bool has_other(const ffd_operation *of)
{
    return of->kind == FFD_OPERATION_BLEND || of->kind == FFD_OPERATION_ADD || takes_tables(of);
}

/* Whether an operation's other lattice is a table or an array. */
static bool has_table(const ffd_operation *of)
{
    const lattice_format *const format = of->other.path ? ffd_lattice_source_format(&of->other) : NULL;
    return takes_tables(of) && format && format->kind != FORMAT_JSON && format->traits & FORMAT_IS_READ;
}

/* The linear part of a map, row by row. */
static void fill_linear(const ffd_operation *of, double linear[9])
{
    const double scale = of->kind == FFD_OPERATION_SCALE ? of->number : 1;
    if (of->kind == FFD_OPERATION_ROTATE)
        ffd_axis_rotation(of->direction, of->number, linear);
    for (int i = 0; i < 9 && of->kind != FFD_OPERATION_ROTATE; i++)
        linear[i] = i % 4 == 0 ? scale : 0;
}

static ffd_status place(const ffd_operation *of, const ffd_lattice *from, ffd_lattice **to, ffd_error *error)
{
    double linear[9], matrix[16] = {0};
    if (!isfinite(of->number)) /* a matrix is checked by itself */
        return ffd_fail(error, FFD_E_ARGUMENT, "the angle or factor %g is not finite", of->number);
    if (of->direction < 0 || of->direction > 2)
        return ffd_fail(error, FFD_E_ARGUMENT, "the axis %d is not 0 to 2", of->direction);
    fill_linear(of, linear);
    for (int r = 0; r < 3; r++) {
        const double moved = linear[3 * r] * of->place[0] + linear[3 * r + 1] * of->place[1] +
                             linear[3 * r + 2] * of->place[2];
        memcpy(matrix + 4 * r, linear + 3 * r, 3 * sizeof *linear);
        matrix[4 * r + 3] = of->kind == FFD_OPERATION_MOVE ? of->place[r] : of->place[r] - moved;
    }
    matrix[15] = 1;
    return ffd_lattice_transform(from, matrix, to, error);
}

/* Where the meshes cut no face it is the same lattice, with its moves as offsets. */
static ffd_status seal(const author_job *job, const ffd_operation *of, ffd_lattice *from, ffd_lattice **to,
                       ffd_error *error)
{
    const char *const name = job->lattices[0].path;
    cut_faces cut = {.faces = of->faces};
    if (of->faces == FFD_FACES_CUT)
        TRY(ffd_author_find_cut(job, from, &cut, error));
    TRY(cut.faces ? ffd_lattice_seal(from, of->continuity, cut.faces, to, error)
                  : ffd_lattice_strength(from, 1, to, error));
    if (of->faces == FFD_FACES_CUT)
        ffd_seal_tell(name, of->continuity, job->desc.mesh_count, cut.faces, cut.vertices, &job->log);
    ffd_seal_warn(from, *to, of->continuity, name, &job->log);
    return FFD_OK;
}

static ffd_status invert(const author_job *job, const ffd_lattice *from, ffd_lattice **to, ffd_error *error)
{
    char name[100];
    TRY(ffd_lattice_invert(from, job->desc.threads, to, error));
    ffd_name_shown(job->lattices[0].path, name, sizeof name);
    if (!ffd_lattice_is_still(from))
        ffd_log_line(
            &job->log, FFD_LOG_WARNING,
            "%s: the inverse covers the deformed volume only: other places of the volume at rest are "
            "outside of it",
            name);
    return FFD_OK;
}

/* Reads the table of an operation, which has the size of the lattice at hand. */
static ffd_status read_table(const ffd_operation *of, const ffd_lattice *from, author_input *input,
                             ffd_lattice **table, ffd_error *error)
{
    format_wish wish = {.size_is_known = true, .block = of->block};
    memcpy(wish.size, from->size, sizeof wish.size);
    return ffd_lattice_read(ffd_lattice_source_format(&of->other), &of->other, &wish, &input->memory, table,
                            error);
}

/* other: a lattice, or a table, with the deformed control points or displacements. */
static ffd_status take(const ffd_operation *of, const ffd_lattice *from, const ffd_lattice *other,
                       ffd_lattice **to, ffd_error *error)
{
    const size_t *const a = from->size, *const b = other->size;
    if (a[0] != b[0] || a[1] != b[1] || a[2] != b[2])
        return ffd_fail_file(error, FFD_E_INVALID, of->other.path ? of->other.path : "other",
                             "has %zu x %zu x %zu control points, but the lattice has %zu x %zu x %zu", b[0],
                             b[1], b[2], a[0], a[1], a[2]);
    return of->kind == FFD_OPERATION_DEFORMED ? ffd_lattice_take_deformed(from, other, to, error)
                                              : ffd_lattice_take_offsets(from, other, to, error);
}

/* Blends or adds. What is wrong is said of the other lattice: there may be several. */
static ffd_status join(const ffd_operation *of, const ffd_lattice *from, const ffd_lattice *other,
                       ffd_lattice **to, ffd_error *error)
{
    const ffd_status status = of->kind == FFD_OPERATION_BLEND
                                  ? ffd_lattice_blend(from, other, of->number, to, error)
                                  : ffd_lattice_add(from, other, to, error);
    if (status == FFD_E_INVALID && of->other.path)
        ffd_fail_name_file(error, of->other.path);
    return status;
}

/* other: the lattice that the operation needs. */
static ffd_status operate(const author_job *job, const ffd_operation *of, ffd_lattice *from,
                          const ffd_lattice *other, ffd_lattice **to, ffd_error *error)
{
    switch (of->kind) {
    case FFD_OPERATION_STRENGTH:
        return ffd_lattice_strength(from, of->number, to, error);
    case FFD_OPERATION_BLEND:
    case FFD_OPERATION_ADD:
        return join(of, from, other, to, error);
    case FFD_OPERATION_MIRROR:
        return ffd_lattice_mirror(from, of->direction, to, error);
    case FFD_OPERATION_SYMMETRIZE:
        return ffd_lattice_symmetrize(from, of->direction, of->keep_last, to, error);
    case FFD_OPERATION_TRANSFORM:
        return ffd_lattice_transform(from, of->matrix, to, error);
    case FFD_OPERATION_MOVE:
    case FFD_OPERATION_ROTATE:
    case FFD_OPERATION_SCALE:
        return place(of, from, to, error);
    case FFD_OPERATION_INVERT:
        return invert(job, from, to, error);
    case FFD_OPERATION_SEAL:
        return seal(job, of, from, to, error);
    case FFD_OPERATION_DEFORMED:
    case FFD_OPERATION_DEFORMED_OFFSETS:
        return take(of, from, other, to, error);
    }
    return ffd_fail(error, FFD_E_ARGUMENT, "there is no operation %d", (int)of->kind);
}

/* Replaces the first lattice of the input by what the operations make of it. */
static ffd_status operate_all(const author_job *job, const ffd_operation *operations, size_t count,
                              author_input *input, ffd_error *error)
{
    size_t other = 0;
    TRY(input->lattices[0]->spec ? ffd_lattice_memory_take(&input->memory, input->lattices[0]->spec, 0, error)
                                 : FFD_OK);
    for (size_t i = 0; i < count; i++) {
        const ffd_operation *const of = &operations[i];
        ffd_lattice *const from = input->lattices[0];
        ffd_lattice *table = NULL, *made = NULL;
        other += has_other(of) && !has_table(of);
        ffd_status status = has_table(of) ? read_table(of, from, input, &table, error) : FFD_OK;
        if (!status)
            status = operate(job, of, from, table ? table : input->lattices[other], &made, error);
        ffd_lattice_destroy(&table);
        TRY(status);
        ffd_lattice_destroy(&input->lattices[0]);
        input->lattices[0] = made;
    }
    return FFD_OK;
}

/* Lists the lattice and those that operations need, and behind them the tables. *lattices: freed by the
   caller. */
static ffd_status list_lattices(author_job *job, const ffd_operation *operations, size_t count,
                                ffd_lattice_source **lattices, ffd_error *error)
{
    size_t listed = 1;
    *lattices = ffd_alloc(count + 1, sizeof **lattices);
    if (!*lattices)
        return ffd_fail_memory(error);
    (*lattices)[0] = job->desc.lattice;
    for (int tables = 0; tables < 2; tables++) {
        for (size_t i = 0; i < count; i++)
            if (has_other(&operations[i]) && has_table(&operations[i]) == tables)
                (*lattices)[listed++] = operations[i].other;
        job->lattice_count = tables ? job->lattice_count : listed;
    }
    for (size_t i = 1; i < listed; i++)
        TRY(ffd_in_memory_lattice(&(*lattices)[i], "another lattice", "other", error));
    job->lattices = *lattices;
    job->tables = *lattices + job->lattice_count;
    job->table_count = listed - job->lattice_count;
    return FFD_OK;
}

/* Whether faces are held that the meshes cut. */
static bool takes_cut(const ffd_operation *operations, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (operations[i].kind == FFD_OPERATION_SEAL && operations[i].faces == FFD_FACES_CUT)
            return true;
    return false;
}

static ffd_status check_operations(author_job *job, const ffd_operation *operations, size_t count,
                                   ffd_error *error)
{
    if (!operations || count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "there is no operation");
    job->meshes_cut = takes_cut(operations, count);
    if (job->meshes_cut && job->desc.mesh_count == 0)
        return ffd_fail(
            error, FFD_E_ARGUMENT,
            "{seam} without faces holds those that a mesh cuts: name them, as in C1:u-,v+, or the "
            "mesh ({meshes})");
    return FFD_OK;
}

static ffd_status run(author_job *job, const ffd_operation *operations, size_t count, ffd_error *error)
{
    ffd_lattice_source *lattices = NULL;
    author_input input = {0};
    ffd_status status;
    TRY_END(check_operations(job, operations, count, error));
    TRY_END(list_lattices(job, operations, count, &lattices, error));
    TRY_END(ffd_author_begin(job, &input, error));
    TRY_END(operate_all(job, operations, count, &input, error));
    TRY_END(ffd_author_write(job, input.lattices[0], error));
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->desc.lattice.path);
    ffd_author_end(&input);
    ffd_free(lattices);
    return status;
}

ffd_status ffd_lattice_set_run(const ffd_author_desc *callers, const ffd_operation *operations, size_t count,
                               ffd_error *error)
{
    author_job job;
    ffd_status status = ffd_author_take(callers, &job, error);
    if (!status)
        status = run(&job, operations, count, error);
    return ffd_author_leave(&job, status, error);
}
