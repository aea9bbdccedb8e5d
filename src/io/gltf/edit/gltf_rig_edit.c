/* gltf_rig_edit.c - edits the JSON of nodes, skins and animations that follow the deformation. */
#include "base/text/number.h"
#include "io/gltf/edit/gltf_edit.h"

/* Inserts a text after the last member of an object. */
static void insert_members(const json_tree *tree, uint32_t object, const byte_buffer *text, json_edits *edits)
{
    uint32_t last = JSON_NONE;
    for (uint32_t v = ffd_json_tree_first(tree, object); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        last = v;
    const uint32_t at = last == JSON_NONE ? tree->values[object].begin + 1 : tree->values[last].end;
    edits->failed = edits->failed || text->failed;
    if (text->size == 0 || text->failed)
        return;
    if (last != JSON_NONE)
        ffd_edits_replace(edits, at, at, ",", 1);
    ffd_edits_replace(edits, at, at, text->data, text->size);
}

static void replace_number(const json_tree *tree, uint32_t value, size_t index, json_edits *edits)
{
    ffd_edits_format(edits, tree->values[value].begin, tree->values[value].end, "%zu", index);
}

/* Replaces those numbers of an array that differ. */
static void edit_numbers(const json_tree *tree, uint32_t array, const double *values, size_t count,
                         json_edits *edits)
{
    size_t i = 0;
    for (uint32_t v = ffd_json_tree_first(tree, array); v != JSON_NONE && i < count;
         v = ffd_json_tree_after(tree, v), i++) {
        double old;
        char text[FFD_NUMBER_CAPACITY];
        if (ffd_json_tree_number(tree, v, &old) && old == values[i])
            continue;
        const size_t size = ffd_number_format(values[i], text);
        ffd_edits_replace(edits, tree->values[v].begin, tree->values[v].end, text, size);
    }
}

/* Sets a member of a node: edits the numbers of an existing array, or appends the array to `added`. */
static void set_array(const json_tree *tree, uint32_t node, const char *key, const double *values,
                      size_t count, byte_buffer *added, json_edits *edits)
{
    const uint32_t member = ffd_json_tree_member(tree, node, key);
    if (member != JSON_NONE) {
        edit_numbers(tree, member, values, count, edits);
        return;
    }
    ffd_buffer_format(added, "%s\"%s\":[", added->size > 0 ? "," : "", key);
    for (size_t i = 0; i < count; i++) {
        char text[FFD_NUMBER_CAPACITY];
        const size_t size = ffd_number_format(values[i], text);
        ffd_buffer_text(added, i > 0 ? "," : "");
        ffd_buffer_append(added, text, size);
    }
    ffd_buffer_text(added, "]");
}

void ffd_gltf_edit_nodes(const gltf_document *d, json_edits *edits)
{
    for (size_t i = 0; i < d->edit->rig.node_count; i++) {
        const gltf_moved_node *const made = &d->edit->rig.nodes[i];
        const uint32_t node = d->node_values.values[made->node];
        byte_buffer added = {0};
        if (d->model.nodes[made->node].has_matrix) {
            set_array(&d->tree, node, "matrix", made->matrix, 16, &added, edits);
        } else {
            if (made->translates)
                set_array(&d->tree, node, "translation", made->translation, 3, &added, edits);
            if (made->rotates)
                set_array(&d->tree, node, "rotation", made->rotation, 4, &added, edits);
        }
        insert_members(&d->tree, node, &added, edits);
        ffd_buffer_free(&added);
    }
}

void ffd_gltf_edit_skins(const gltf_document *d, const size_t *outputs, json_edits *edits)
{
    for (size_t s = 0; s < d->skin_values.count; s++) {
        const size_t content = d->edit->rig.skin_contents[s];
        const uint32_t skin = d->skin_values.values[s];
        const uint32_t member = ffd_json_tree_member(&d->tree, skin, "inverseBindMatrices");
        byte_buffer added = {0};
        if (content == GLTF_NONE || outputs[content] == d->edit->contents[content].accessor)
            continue;
        if (member != JSON_NONE) {
            replace_number(&d->tree, member, outputs[content], edits);
            continue;
        }
        ffd_buffer_format(&added, "\"inverseBindMatrices\":%zu", outputs[content]);
        insert_members(&d->tree, skin, &added, edits);
        ffd_buffer_free(&added);
    }
}

/* Returns the accessor of a sampler's output. */
static size_t output_of(const gltf_animation_sampler *sampler, size_t content, const size_t *outputs)
{
    return content == GLTF_NONE ? sampler->output : outputs[content];
}

/* Appends the JSON of a sampler with another output. */
static void add_sampler(const json_tree *tree, const gltf_animation_sampler *sampler, size_t output,
                        byte_buffer *text)
{
    const json_value *const whole = &tree->values[sampler->value];
    const json_value *const member = &tree->values[ffd_json_tree_member(tree, sampler->value, "output")];
    ffd_buffer_text(text, text->size > 0 ? "," : "");
    ffd_buffer_append(text, tree->text + whole->begin, member->begin - whole->begin);
    ffd_buffer_format(text, "%zu", output);
    ffd_buffer_append(text, tree->text + member->end, whole->end - member->end);
}

static void edit_animation(const json_tree *tree, const gltf_animation *animation,
                           const gltf_rig_animation *change, const size_t *outputs, json_edits *edits)
{
    byte_buffer text = {0};
    for (size_t s = 0; s < animation->sampler_count; s++) {
        const gltf_animation_sampler *const sampler = &animation->samplers[s];
        const size_t output = output_of(sampler, change->contents[s], outputs);
        if (output != sampler->output)
            replace_number(tree, ffd_json_tree_member(tree, sampler->value, "output"), output, edits);
    }
    for (size_t c = 0; c < animation->channel_count; c++)
        if (change->channels[c] != animation->channels[c].sampler)
            replace_number(tree, ffd_json_tree_member(tree, animation->channels[c].value, "sampler"),
                           change->channels[c], edits);
    for (size_t i = 0; i < change->copy_count; i++) {
        const gltf_animation_sampler *const sampler = &animation->samplers[change->copies[i].sampler];
        add_sampler(tree, sampler, output_of(sampler, change->copies[i].content, outputs), &text);
    }
    insert_members(tree, ffd_json_tree_member(tree, animation->value, "samplers"), &text, edits);
    ffd_buffer_free(&text);
}

void ffd_gltf_edit_animations(const gltf_document *d, const size_t *outputs, json_edits *edits)
{
    const gltf_rig *const rig = &d->edit->rig;
    for (size_t a = 0; a < rig->animations.count; a++)
        if (rig->changes[a].contents)
            edit_animation(&d->tree, &rig->animations.list[a], &rig->changes[a], outputs, edits);
}
