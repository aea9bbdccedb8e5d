/* copy.c - copies of lattices and of their specs. */
#include "lattice/copy.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <string.h>

/* Replaces *pointer, unless it is NULL, by a copy of its block. If memory runs out, sets it to NULL and
   returns false. */
static bool copy_block(void *pointer, size_t count, size_t size)
{
    void *from, *to = NULL;
    memcpy(&from, pointer, sizeof from);
    if (from)
        to = ffd_alloc(count, size);
    if (to)
        memcpy(to, from, count * size);
    memcpy(pointer, &to, sizeof to);
    return !from || to;
}

static bool copy_text(char **text)
{
    const char *const from = *text;
    *text = from ? ffd_text_copy(from) : NULL;
    return !from || *text;
}

static bool copy_names(const intern_table *from, intern_table *to)
{
    bool whole = true;
    *to = (intern_table){0};
    for (uint32_t i = 0; i < from->count && whole; i++) {
        uint32_t index;
        const char *const name = ffd_intern_key(from, i);
        whole = ffd_intern(to, name, strlen(name), &index);
    }
    return whole;
}

static bool copy_meshes(lattice_spec *copy)
{
    bool whole = copy_block(&copy->meshes, copy->mesh_count, sizeof *copy->meshes);
    for (size_t i = 0; copy->meshes && i < copy->mesh_count; i++)
        whole = copy_text(&copy->meshes[i]) && whole;
    copy->mesh_count = copy->meshes ? copy->mesh_count : 0;
    return whole;
}

static bool copy_variables(lattice_spec *copy)
{
    bool whole = copy_block(&copy->variables, copy->variable_count, sizeof *copy->variables);
    for (size_t i = 0; copy->variables && i < copy->variable_count; i++) {
        spec_variable *const variable = &copy->variables[i];
        whole = copy_text(&variable->name) && whole;
        whole = copy_block(&variable->numbers, variable->size, sizeof *variable->numbers) && whole;
    }
    copy->variable_count = copy->variables ? copy->variable_count : 0;
    return copy_block(&copy->seeds, copy->seed_count, sizeof *copy->seeds) && whole;
}

static bool copy_parameters(lattice_spec *copy)
{
    bool whole = copy_block(&copy->parameters, copy->parameter_count, sizeof *copy->parameters);
    for (size_t i = 0; copy->parameters && i < copy->parameter_count; i++) {
        spec_parameter *const parameter = &copy->parameters[i];
        char **const texts[] = {&parameter->name, &parameter->value, &parameter->unit, &parameter->comment};
        for (size_t t = 0; t < sizeof texts / sizeof *texts; t++)
            whole = copy_text(texts[t]) && whole;
    }
    copy->parameter_count = copy->parameters ? copy->parameter_count : 0;
    return whole;
}

static bool copy_texts(char ***texts, size_t count)
{
    bool whole = copy_block(texts, count, sizeof **texts);
    for (size_t i = 0; *texts && i < count; i++)
        whole = copy_text(&(*texts)[i]) && whole;
    return whole;
}

/* Lets the moves of a copied list point to the places of their drags in their copy. */
static void move_drags(lattice_move *moves, size_t count, const spec_drag *from, spec_drag *to)
{
    for (size_t i = 0; moves && to && i < count; i++)
        if (moves[i].drag_count > 0)
            moves[i].drags = to + (moves[i].drags - from);
}

static bool copy_key(const lattice_spec *copy, spec_key *key)
{
    const spec_drag *const drags = key->drags;
    bool whole = copy_block(&key->offsets, copy->count, 3 * sizeof(double));
    whole = copy_block(&key->moves, key->move_count, sizeof *key->moves) && whole;
    whole = copy_block(&key->drags, key->drag_count, sizeof *key->drags) && whole;
    move_drags(key->moves, key->move_count, drags, key->drags);
    return copy_texts(&key->values, copy->keys.name_count) && whole;
}

static bool copy_keys(lattice_spec *copy)
{
    spec_keys *const keys = &copy->keys;
    bool whole = copy_texts(&keys->names, keys->name_count);
    whole = copy_block(&keys->list, keys->count, sizeof *keys->list) && whole;
    for (size_t k = 0; keys->list && k < keys->count; k++)
        whole = copy_key(copy, &keys->list[k]) && whole;
    keys->count = keys->list ? keys->count : 0;
    whole = copy_block(&keys->others, keys->other_count, sizeof *keys->others) && whole;
    for (size_t i = 0; keys->others && i < keys->other_count; i++) {
        whole = copy_text(&keys->others[i].name) && whole;
        whole = copy_text(&keys->others[i].value) && whole;
    }
    keys->other_count = keys->others ? keys->other_count : 0;
    return copy_text(&keys->moves) && whole;
}

lattice_spec *ffd_spec_copy(const lattice_spec *spec)
{
    lattice_spec *copy = ffd_alloc(1, sizeof *copy);
    if (!copy)
        return NULL;
    *copy = *spec;
    bool whole = copy_text(&copy->name);
    for (int a = 0; a < 3; a++)
        whole = copy_block(&copy->list[a], copy->list_count[a], sizeof *copy->list[a]) && whole;
    double **const vectors[] = {&copy->points, &copy->deformed_points, &copy->deformed_offsets};
    double **const weights[] = {&copy->weights, &copy->deformed_weights};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        whole = copy_block(vectors[i], copy->count, 3 * sizeof(double)) && whole;
    for (size_t i = 0; i < sizeof weights / sizeof *weights; i++)
        whole = copy_block(weights[i], copy->count, sizeof(double)) && whole;
    whole = copy_block(&copy->moves, copy->move_count, sizeof *copy->moves) && whole;
    whole = copy_block(&copy->drags, copy->drag_count, sizeof *copy->drags) && whole;
    move_drags(copy->moves, copy->move_count, spec->drags, copy->drags);
    whole = copy_keys(copy) && whole;
    whole = copy_meshes(copy) && whole;
    whole = copy_parameters(copy) && whole;
    whole = copy_variables(copy) && whole;
    whole = copy_names(&spec->open, &copy->open) && whole;
    if (!whole)
        ffd_spec_free(copy);
    return whole ? copy : NULL;
}

static bool copy_knots(knot_vector *knots)
{
    const size_t order = (size_t)knots->degree + 1;
    bool whole = copy_block(&knots->t, knots->functions + order, sizeof *knots->t);
    whole = copy_block(&knots->spans, knots->span_count, sizeof *knots->spans) && whole;
    return copy_block(&knots->extractions, knots->span_count, order * order * sizeof *knots->extractions) &&
           whole;
}

ffd_status ffd_lattice_copy(const ffd_lattice *lattice, ffd_lattice **copy, ffd_error *error)
{
    ffd_lattice *made = ffd_alloc(1, sizeof *made);
    *copy = NULL;
    if (!made)
        return ffd_fail_memory(error);
    *made = *lattice;
    made->spec = lattice->spec ? ffd_spec_copy(lattice->spec) : NULL;
    bool whole = !lattice->spec || made->spec;
    for (int a = 0; a < 3; a++)
        whole = copy_knots(&made->knots[a]) && whole;
    double **const vectors[] = {&made->rest, &made->deformed, &made->difference};
    double **const weights[] = {&made->rest_weights, &made->deformed_weights};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        whole = copy_block(vectors[i], made->count, 3 * sizeof(double)) && whole;
    for (size_t i = 0; i < sizeof weights / sizeof *weights; i++)
        whole = copy_block(weights[i], made->count, sizeof(double)) && whole;
    whole = copy_block(&made->moved, made->count, sizeof *made->moved) && whole;
    if (!whole)
        ffd_lattice_destroy(&made);
    *copy = made;
    return whole ? FFD_OK : ffd_fail_memory(error);
}
