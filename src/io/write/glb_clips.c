#include "io/write/glb_clips.h"
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "mesh/morph/morph_clip.h"
#include <string.h>

enum { TYPE_FLOAT = 5126 };

static size_t target_count(const glb_plan *plan, uint32_t mesh)
{
    size_t count = 0;
    for (size_t k = 0; k < plan->model->morph_count; k++)
        count += plan->morphed[mesh * plan->model->morph_count + k];
    return count;
}

/* Appends a key's weights for the targets of a mesh. weights: per name of the clip. */
static void put_row(const glb_plan *plan, const morph_clip *clip, uint32_t mesh, const double *weights,
                    byte_buffer *out)
{
    const mesh_model *const model = plan->model;
    for (size_t k = 0; k < model->morph_count; k++) {
        const char *const name = model->morphs[k].name;
        uint32_t index;
        if (plan->morphed[mesh * model->morph_count + k])
            ffd_buffer_float(out,
                             ffd_intern_find(&clip->names, name, strlen(name), &index) ? weights[index] : 0);
    }
}

static void put_clip(const glb_plan *plan, const morph_clip *clip, double *weights, byte_buffer *out)
{
    for (size_t k = 0; k < clip->key_count; k++)
        ffd_buffer_float(out, (double)clip->times[k]);
    for (uint32_t m = 0; m < plan->meshes.count; m++)
        for (size_t k = 0; k < clip->key_count && target_count(plan, m) > 0; k++) {
            ffd_morph_clip_weights(clip, k, weights);
            put_row(plan, clip, m, weights, out);
        }
}

static ffd_status check_memory(const glb_plan *plan, const morph_clip *clip, ffd_error *error)
{
    uint64_t count = clip->key_count;
    for (uint32_t m = 0; m < plan->meshes.count; m++)
        count += (uint64_t)clip->key_count * target_count(plan, m);
    return plan->model->budget ? ffd_budget_take(plan->model->budget, count, sizeof(float), error) : FFD_OK;
}

static bool animates(const glb_plan *plan)
{
    for (uint32_t m = 0; m < plan->meshes.count; m++)
        if (plan->model->clip_count > 0 && target_count(plan, m) > 0)
            return true;
    return false;
}

ffd_status ffd_glb_make_clips(const glb_plan *plan, glb_clips *clips, ffd_error *error)
{
    *clips = (glb_clips){.plan = plan};
    for (size_t c = 0; c < plan->model->clip_count && animates(plan); c++) {
        const morph_clip *const clip = &plan->model->clips[c];
        TRY(check_memory(plan, clip, error));
        double *const weights = ffd_alloc(clip->names.count, sizeof *weights);
        if (!weights)
            return ffd_fail_memory(error);
        put_clip(plan, clip, weights, &clips->bytes);
        ffd_free(weights);
        if (clips->bytes.failed)
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

static void add_sampler(size_t input, size_t output, json_text *json)
{
    ffd_json_object(json, NULL, true);
    ffd_json_count(json, "input", input);
    ffd_json_string(json, "interpolation", "LINEAR");
    ffd_json_count(json, "output", output);
    ffd_json_end(json, '}');
}

static void add_channel(size_t sampler, size_t node, json_text *json)
{
    ffd_json_object(json, NULL, true);
    ffd_json_count(json, "sampler", sampler);
    ffd_json_object(json, "target", true);
    ffd_json_count(json, "node", node);
    ffd_json_string(json, "path", "weights");
    ffd_json_end(json, '}');
    ffd_json_end(json, '}');
}

/* Each mesh has one node, of the same number. */
static void add_clip(const glb_plan *plan, const morph_clip *clip, size_t *accessor, json_text *json)
{
    const size_t input = (*accessor)++;
    size_t sampler = 0;
    ffd_json_object(json, NULL, true);
    ffd_json_string(json, "name", clip->name);
    ffd_json_array(json, "channels", true);
    for (uint32_t m = 0; m < plan->meshes.count; m++)
        if (target_count(plan, m) > 0)
            add_channel(sampler++, m, json);
    ffd_json_end(json, ']');
    ffd_json_array(json, "samplers", true);
    for (size_t s = 0; s < sampler; s++)
        add_sampler(input, (*accessor)++, json);
    ffd_json_end(json, ']');
    ffd_json_end(json, '}');
}

void ffd_glb_add_clips(const glb_clips *clips, size_t first, json_text *json)
{
    if (clips->bytes.size == 0)
        return;
    ffd_json_array(json, "animations", false);
    for (size_t c = 0; c < clips->plan->model->clip_count; c++)
        add_clip(clips->plan, &clips->plan->model->clips[c], &first, json);
    ffd_json_end(json, ']');
}

static void add_accessor(size_t view, size_t *offset, size_t count, const float *bounds, json_text *json)
{
    ffd_json_object(json, NULL, true);
    ffd_json_count(json, "bufferView", view);
    ffd_json_count(json, "byteOffset", *offset);
    ffd_json_count(json, "componentType", TYPE_FLOAT);
    ffd_json_count(json, "count", count);
    ffd_json_string(json, "type", "SCALAR");
    if (bounds) {
        const double least = (double)bounds[0], most = (double)bounds[count - 1];
        ffd_json_vector(json, "min", &least, 1);
        ffd_json_vector(json, "max", &most, 1);
    }
    ffd_json_end(json, '}');
    *offset += count * sizeof(float);
}

void ffd_glb_add_clip_accessors(const glb_clips *clips, size_t view, json_text *json)
{
    const glb_plan *const plan = clips->plan;
    size_t offset = 0;
    for (size_t c = 0; clips->bytes.size > 0 && c < plan->model->clip_count; c++) {
        const morph_clip *const clip = &plan->model->clips[c];
        add_accessor(view, &offset, clip->key_count, clip->times, json);
        for (uint32_t m = 0; m < plan->meshes.count; m++)
            if (target_count(plan, m) > 0)
                add_accessor(view, &offset, clip->key_count * target_count(plan, m), NULL, json);
    }
}

void ffd_glb_free_clips(glb_clips *clips)
{
    ffd_buffer_free(&clips->bytes);
}
