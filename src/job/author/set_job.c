/* set_job.c - the job of `ffd lattice set`. */
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include "base/vector/trig.h"
#include "job/author/author_job.h"
#include "job/chain/lattice_memory.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

void ffd_lattice_set_desc_init(ffd_lattice_set_desc *desc, size_t size)
{
    const ffd_lattice_set_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static bool has_other(const ffd_operation *of)
{
    return of->kind == FFD_OPERATION_BLEND || of->kind == FFD_OPERATION_ADD;
}

/* The linear part of a map, row by row. */
static void fill_linear(const ffd_operation *of, double linear[9])
{
    const double scale = of->kind == FFD_OPERATION_SCALE ? of->number : 1;
    for (int i = 0; i < 9; i++)
        linear[i] = i % 4 == 0 ? scale : 0;
    if (of->kind != FFD_OPERATION_ROTATE)
        return;
    const int a = (of->direction + 1) % 3, b = (of->direction + 2) % 3;
    double sine, cosine;
    ffd_sincos_degrees(of->number, &sine, &cosine);
    linear[4 * a] = linear[4 * b] = cosine;
    linear[3 * a + b] = -sine;
    linear[3 * b + a] = sine;
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

static ffd_status seal(const author_job *job, const ffd_operation *of, const ffd_lattice *from,
                       ffd_lattice **to, ffd_error *error)
{
    char name[100];
    TRY(ffd_lattice_seal(from, of->continuity, of->faces, to, error));
    ffd_name_shown(job->lattices[0].path, name, sizeof name);
    if (!ffd_lattice_is_still(from) && ffd_lattice_is_still(*to))
        ffd_log_line(&job->log, FFD_LOG_WARNING,
                     "%s: faces held at C%d leave nothing that moves of %zu x %zu x %zu control points", name,
                     of->continuity, (*to)->size[0], (*to)->size[1], (*to)->size[2]);
    return FFD_OK;
}

/* other: the next of the lattices that operations need. */
static ffd_status operate(const author_job *job, const ffd_operation *of, const ffd_lattice *from,
                          const ffd_lattice *other, int threads, ffd_lattice **to, ffd_error *error)
{
    switch (of->kind) {
    case FFD_OPERATION_STRENGTH:
        return ffd_lattice_strength(from, of->number, to, error);
    case FFD_OPERATION_BLEND:
        return ffd_lattice_blend(from, other, of->number, to, error);
    case FFD_OPERATION_ADD:
        return ffd_lattice_add(from, other, to, error);
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
        return ffd_lattice_invert(from, threads, to, error);
    case FFD_OPERATION_SEAL:
        return seal(job, of, from, to, error);
    }
    return ffd_fail(error, FFD_E_ARGUMENT, "there is no operation %d", (int)of->kind);
}

/* Replaces the first lattice of the input by what the operations make of it. */
static ffd_status operate_all(const author_job *job, const ffd_lattice_set_desc *desc, author_input *input,
                              ffd_error *error)
{
    size_t other = 0;
    TRY(input->lattices[0]->spec ? ffd_lattice_memory_take(&input->memory, input->lattices[0]->spec, 0, error)
                                 : FFD_OK);
    for (size_t i = 0; i < desc->operation_count; i++) {
        const ffd_operation *const of = &desc->operations[i];
        ffd_lattice *made;
        other += has_other(of);
        TRY(operate(job, of, input->lattices[0], input->lattices[other], desc->threads, &made, error));
        ffd_lattice_destroy(&input->lattices[0]);
        input->lattices[0] = made;
    }
    return FFD_OK;
}

static ffd_status set(const author_job *job, const ffd_lattice_set_desc *desc, ffd_error *error)
{
    author_input input = {0};
    ffd_status status;
    TRY_END(ffd_author_begin(job, &input, error));
    TRY_END(operate_all(job, desc, &input, error));
    TRY_END(ffd_author_write(job, input.lattices[0], error));
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->lattices[0].path);
    ffd_author_end(&input);
    return status;
}

/* Lists the lattice and those that operations need. *lattices: freed by the caller. */
static ffd_status list_lattices(const ffd_lattice_set_desc *desc, ffd_lattice_source **lattices,
                                size_t *count, ffd_error *error)
{
    *count = 1;
    *lattices = ffd_alloc(desc->operation_count + 1, sizeof **lattices);
    if (!*lattices)
        return ffd_fail_memory(error);
    (*lattices)[0] = desc->lattice;
    for (size_t i = 0; i < desc->operation_count; i++)
        if (has_other(&desc->operations[i]))
            (*lattices)[(*count)++] = desc->operations[i].other;
    for (size_t i = 0; i < *count; i++)
        TRY(ffd_in_memory_lattice(&(*lattices)[i], i ? "another lattice" : "the lattice",
                                  i ? "other" : "lattice", error));
    return FFD_OK;
}

static ffd_status run(const ffd_lattice_set_desc *desc, job_memory *memory, ffd_error *error)
{
    ffd_source *meshes = NULL;
    ffd_lattice_source *lattices = NULL;
    size_t count;
    ffd_status status;
    TRY_END(ffd_threads_check(desc->threads, error));
    TRY_END(desc->operations && desc->operation_count > 0
                ? FFD_OK
                : ffd_fail(error, FFD_E_ARGUMENT, "there is no operation"));
    TRY_END(list_lattices(desc, &lattices, &count, error));
    TRY_END(ffd_author_take_meshes(memory, desc->meshes, desc->mesh_count, &meshes, error));
    TRY_END(ffd_in_memory_output(desc->sink, desc->output, error));
    const author_job job = {.lattices = lattices,
                            .lattice_count = count,
                            .set = desc->set,
                            .set_count = desc->set_count,
                            .meshes = meshes,
                            .mesh_count = desc->mesh_count,
                            .only = desc->only,
                            .only_count = desc->only_count,
                            .reading = &desc->reading,
                            .output = desc->output,
                            .force = desc->force,
                            .output_set = desc->output_set,
                            .log = {desc->log, desc->log_user},
                            .sink = desc->sink,
                            .sink_user = desc->sink_user};
    TRY_END(set(&job, desc, error));
end:
    ffd_free(lattices);
    ffd_free(meshes);
    return status;
}

ffd_status ffd_lattice_set_run(const ffd_lattice_set_desc *callers, ffd_error *error)
{
    ffd_lattice_set_desc desc;
    ffd_lattice_set_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_lattice_set_desc", error));
    job_memory memory = {0};
    const ffd_status status = run(&desc, &memory, error);
    return ffd_in_memory_end(&memory, status, error);
}
