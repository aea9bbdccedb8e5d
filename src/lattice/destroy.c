/* destroy.c - destroys lattices and their specs. */
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"

static void free_parameter(spec_parameter *parameter)
{
    ffd_free(parameter->name);
    ffd_free(parameter->value);
    ffd_free(parameter->unit);
    ffd_free(parameter->comment);
}

static void free_texts(char **texts, size_t count)
{
    for (size_t i = 0; texts && i < count; i++)
        ffd_free(texts[i]);
    ffd_free(texts);
}

void ffd_keys_free(spec_keys *keys)
{
    for (size_t k = 0; k < keys->count; k++) {
        spec_key *const key = &keys->list[k];
        ffd_free(key->offsets);
        ffd_free(key->moves);
        ffd_free(key->drags);
        free_texts(key->values, keys->name_count);
    }
    ffd_free(keys->list);
    free_texts(keys->names, keys->name_count);
    for (size_t i = 0; i < keys->other_count; i++) {
        ffd_free(keys->others[i].name);
        ffd_free(keys->others[i].value);
    }
    ffd_free(keys->others);
    ffd_free(keys->moves);
    *keys = (spec_keys){0};
}

void ffd_spec_free(lattice_spec *spec)
{
    if (!spec)
        return;
    ffd_free(spec->name);
    for (int a = 0; a < 3; a++)
        ffd_free(spec->list[a]);
    for (size_t i = 0; i < spec->mesh_count; i++)
        ffd_free(spec->meshes[i]);
    ffd_free(spec->meshes);
    ffd_free(spec->points);
    ffd_free(spec->weights);
    ffd_free(spec->deformed_points);
    ffd_free(spec->deformed_offsets);
    ffd_free(spec->deformed_weights);
    ffd_free(spec->moves);
    ffd_free(spec->drags);
    ffd_keys_free(&spec->keys);
    ffd_intern_free(&spec->open);
    for (size_t i = 0; i < spec->parameter_count; i++)
        free_parameter(&spec->parameters[i]);
    ffd_free(spec->parameters);
    for (size_t i = 0; i < spec->variable_count; i++) {
        ffd_free(spec->variables[i].name);
        ffd_free(spec->variables[i].numbers);
    }
    ffd_free(spec->variables);
    ffd_free(spec->seeds);
    ffd_free(spec);
}

void ffd_lattice_destroy(ffd_lattice **lattice)
{
    if (!lattice || !*lattice)
        return;
    ffd_lattice *const l = *lattice;
    ffd_spec_free(l->spec);
    for (int a = 0; a < 3; a++)
        ffd_knots_free(&l->knots[a]);
    ffd_free(l->rest);
    ffd_free(l->deformed);
    ffd_free(l->rest_weights);
    ffd_free(l->deformed_weights);
    ffd_free(l->difference);
    ffd_free(l->moved);
    ffd_free(l);
    *lattice = NULL;
}
