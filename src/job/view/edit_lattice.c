/* edit_lattice.c - the lattice that a page edits. */
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "job/input/embedding_file.h"
#include "job/view/edit.h"
#include "lattice/file/lattice_source.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "json/json_parse.h"
#include <stdio.h>
#include <string.h>

/* Copies numbers; NULL stays NULL. Returns false if memory runs out. */
static bool copy(const double *numbers, size_t count, double **to)
{
    *to = numbers ? ffd_alloc(count, sizeof **to) : NULL;
    if (*to)
        memcpy(*to, numbers, count * sizeof **to);
    return *to || !numbers;
}

/* Takes a member of a lattice file that a lattice does not keep, as JSON; NULL: there is none. */
static bool take_member(const json_tree *tree, const char *key, char **to)
{
    const uint32_t member = ffd_json_tree_member(tree, 0, key);
    *to = member == JSON_NONE ? NULL : ffd_json_tree_text(tree, member);
    return member == JSON_NONE || *to;
}

/* Takes the name and the comment of a lattice file. A file that is no JSON has none, and what was standard
   input is gone. */
static ffd_status take_words(const ffd_lattice_source *source, view_edit *edit, ffd_error *error)
{
    json_tree tree;
    file_input file;
    if (source->object || ffd_lattice_is_stream(source) ||
        ffd_file_take(source->path, source->text, &file, NULL))
        return FFD_OK;
    const json_input input = {.text = (const char *)file.data, .size = file.size, .rules = JSON_ALLOW_MARK};
    ffd_status status = FFD_OK;
    if (!ffd_json_parse(&input, &tree, NULL)) {
        if (!take_member(&tree, "name", &edit->name) || !take_member(&tree, "comment", &edit->comment))
            status = ffd_fail_memory(error);
        ffd_json_tree_free(&tree);
    }
    ffd_file_unload(&file);
    return status;
}

/* Names mesh and rest lattice by their hashes. */
static ffd_status make_key(const deform_job *job, const ffd_lattice *lattice, view_edit *edit,
                           ffd_error *error)
{
    hash128 hashes[2];
    TRY(ffd_embedding_hash_positions(job->document, job->threads, &hashes[0], error));
    hashes[1] = ffd_embedding_hash_rest(lattice, 0);
    for (int h = 0; h < 2; h++)
        for (size_t i = 0; i < sizeof hashes->bytes; i++)
            snprintf(edit->key + 2 * (sizeof hashes->bytes * (size_t)h + i), 3, "%02x", hashes[h].bytes[i]);
    return FFD_OK;
}

ffd_status ffd_edit_take_lattice(const deform_job *job, const view_scene *scene, view_edit *edit,
                                 ffd_error *error)
{
    const chain_link *const link = &job->chain.links[job->chain.count - 1];
    const ffd_lattice *const lattice = link->lattice;
    const lattice_spec *const spec = lattice->spec;
    size_t size;
    bool made = true;
    edit->cage = scene->cage_count - 1;
    edit->extends = job->chain.outside.extend;
    edit->has_moves = spec->move_count > 0 || spec->keys.kind != KEYS_NONE;
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        edit->degree[a] = knots->degree;
        edit->knot_count[a] = knots->functions + (size_t)knots->degree + 1;
        made = made && copy(knots->t, edit->knot_count[a], &edit->knots[a]);
    }
    made = made && copy(lattice->difference, 3 * lattice->count, &edit->offsets) &&
           copy(lattice->rest_weights, lattice->count, &edit->weights) &&
           copy(lattice->deformed_weights, lattice->count, &edit->deformed_weights);
    if (!made)
        return ffd_fail_memory(error);
    TRY(ffd_lattice_text(lattice, &edit->file, &size, error));
    TRY(take_words(&job->desc->lattices[job->chain.count - 1], edit, error));
    return make_key(job, lattice, edit, error);
}
