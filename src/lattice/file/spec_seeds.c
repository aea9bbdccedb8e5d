#include "lattice/file/spec_seeds.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <stdint.h>
#include <string.h>

/* Returns whether a value is a number or an array of numbers. */
static bool is_numbers(const json_tree *tree)
{
    double number;
    if (ffd_json_tree_number(tree, 0, &number))
        return true;
    bool all = tree->values[0].kind == JSON_ARRAY;
    for (uint32_t v = 1; v < tree->count && all; v++)
        all = ffd_json_tree_number(tree, v, &number);
    return all;
}

static ffd_status fill_variable(const json_file *file, const char *name, const json_tree *tree,
                                spec_variable *variable)
{
    *variable = (spec_variable){.name = ffd_text_copy(name), .is_array = tree->values[0].kind == JSON_ARRAY};
    const size_t first = variable->is_array, size = is_numbers(tree) ? tree->count - first : 0;
    variable->numbers = ffd_alloc(size, sizeof *variable->numbers);
    if (!variable->name || !variable->numbers)
        return ffd_fail_memory(file->error);
    variable->size = size;
    for (size_t i = 0; i < size; i++)
        ffd_json_tree_number(tree, (uint32_t)(first + i), &variable->numbers[i]);
    return FFD_OK;
}

ffd_status ffd_spec_add_origin(const json_file *file, spec_origin origin, const char *name,
                               const json_tree *tree, lattice_spec *spec, spec_origins *origins)
{
    for (origin.variable = 0; origin.variable < spec->variable_count; origin.variable++)
        if (strcmp(spec->variables[origin.variable].name, name) == 0)
            break;
    if (!ffd_grow((void **)&origins->origins, &origins->capacity, origins->count + 1,
                  sizeof *origins->origins))
        return ffd_fail_memory(file->error);
    origins->origins[origins->count++] = origin;
    if (origin.variable < spec->variable_count)
        return FFD_OK;
    spec_variable *const more =
        ffd_realloc(spec->variables, spec->variable_count + 1, sizeof *spec->variables);
    if (!more)
        return ffd_fail_memory(file->error);
    spec->variables = more;
    return fill_variable(file, name, tree, &more[spec->variable_count++]);
}

static json_cursor cursor_at(const json_file *file, uint32_t value)
{
    return (json_cursor){file, file->tree, value, JSON_NONE};
}

/* Returns what the number of a seed is, where it has no derivative; NULL where it has one. */
static const char *what_selects(const lattice_spec *spec, const spec_seed *seed)
{
    static const struct range {
        size_t first, size;
        const char *what;
    } ranges[] = {{offsetof(lattice_move, within_min), 6 * sizeof(double), "not a number that moves points"},
                  {offsetof(lattice_move, mirror), sizeof(move_mirror), "the plane of a mirror"},
                  {offsetof(lattice_move, seed), sizeof(double), "the seed of a jitter"}};
    if (seed->is_dragged)
        return seed->offset < offsetof(spec_drag, by) ? "the place of a drag" : NULL;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (seed->offset >= ranges[i].first && seed->offset < ranges[i].first + ranges[i].size)
            return ranges[i].what;
    return spec->moves[seed->move].action == MOVE_DRAG ? "the radius of a drag" : NULL;
}

static ffd_status refuse(const json_file *file, const spec_origin *origin, const char *what,
                         const lattice_spec *spec)
{
    return ffd_cursor_fail(cursor_at(file, origin->value),
                           "there is no derivative by \"%.60s\": here it is %s",
                           spec->variables[origin->variable].name, what);
}

static ffd_status add_seed(const json_file *file, const spec_origin *origin, const json_trace_entry *entry,
                           lattice_spec *spec)
{
    const uintptr_t number = (uintptr_t)entry->number, moves = (uintptr_t)spec->moves;
    const bool is_dragged = number < moves || number - moves >= spec->move_count * sizeof *spec->moves;
    const size_t at = number - (is_dragged ? (uintptr_t)spec->drags : moves);
    const size_t each = is_dragged ? sizeof *spec->drags : sizeof *spec->moves;
    const spec_variable *const variable = &spec->variables[origin->variable];
    const spec_seed seed = {
        is_dragged,    at / each, at % each, origin->variable, entry->value - variable->is_array,
        origin->factor};
    const char *const what =
        variable->size == 0 ? "not a number that moves points" : what_selects(spec, &seed);
    if (what)
        return refuse(file, origin, what, spec);
    spec->seeds[spec->seed_count++] = seed;
    return FFD_OK;
}

ffd_status ffd_spec_make_seeds(const json_file *file, const spec_origins *origins, lattice_spec *spec)
{
    const json_trace *const trace = file->trace;
    spec->seeds = ffd_alloc(trace->count, sizeof *spec->seeds);
    if (!spec->seeds)
        return ffd_fail_memory(file->error);
    for (size_t i = 0; i < origins->count; i++) {
        const spec_origin *const origin = &origins->origins[i];
        const size_t before = spec->seed_count;
        for (size_t t = 0; t < trace->count; t++)
            if (trace->entries[t].replaced == origin->value)
                TRY(add_seed(file, origin, &trace->entries[t], spec));
        if (spec->seed_count == before)
            TRY(refuse(file, origin, "not a number that moves points", spec));
    }
    return FFD_OK;
}
