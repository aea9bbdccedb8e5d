/* fuzz_clip.c - the text of an animation of weights: it is refused with one line, or is keys whose times
   ascend and whose weights are floats; written again, with every name in quotes, it is the same. */
#include "base/text/buffer.h"
#include "fuzz_target.h"
#include "mesh/morph/morph_clip.h"
#include "mutate_text.h"
#include "promise.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_name(const char *name, byte_buffer *text)
{
    ffd_buffer_text(text, "'");
    for (; *name; name++) {
        ffd_buffer_append(text, name, 1);
        if (*name == '\'')
            ffd_buffer_append(text, name, 1);
    }
    ffd_buffer_text(text, "'");
}

static void put_clip(const morph_clip *clip, byte_buffer *text)
{
    put_name(clip->name, text);
    for (size_t k = 0; k < clip->key_count; k++) {
        ffd_buffer_text(text, k ? "," : ":");
        ffd_buffer_number(text, (double)clip->times[k]);
        for (size_t i = clip->starts[k]; i < clip->starts[k + 1]; i++) {
            ffd_buffer_text(text, " ");
            put_name(ffd_intern_key(&clip->names, clip->weights[i].target), text);
            ffd_buffer_text(text, "=");
            ffd_buffer_number(text, clip->weights[i].weight);
        }
    }
    ffd_buffer_append(text, "", 1);
}

static void check_clip(const morph_clip *clip)
{
    PROMISE(clip->key_count > 0 && *clip->name, "there are no keys");
    PROMISE(clip->starts[0] == 0 && clip->starts[clip->key_count] == clip->weight_count,
            "weights are of no key");
    for (size_t k = 0; k < clip->key_count; k++) {
        PROMISE(clip->times[k] >= 0 && clip->times[k] <= FLT_MAX, "a time is %g", (double)clip->times[k]);
        PROMISE(k == 0 || clip->times[k] > clip->times[k - 1], "times do not ascend");
        PROMISE(clip->starts[k] <= clip->starts[k + 1], "weights of keys overlap");
        for (size_t i = clip->starts[k]; i < clip->starts[k + 1]; i++) {
            PROMISE(fabs(clip->weights[i].weight) <= (double)FLT_MAX, "a weight is none");
            for (size_t j = clip->starts[k]; j < i; j++)
                PROMISE(clip->weights[j].target != clip->weights[i].target, "a target has two weights");
        }
    }
}

static void check_again(const morph_clip *clip)
{
    byte_buffer text = {0};
    morph_clip again;
    put_clip(clip, &text);
    PROMISE(!text.failed && ffd_morph_clip_parse(text.data, &again, NULL) == FFD_OK,
            "its own text is refused: %s", text.data);
    PROMISE(strcmp(again.name, clip->name) == 0 && again.key_count == clip->key_count &&
                memcmp(again.times, clip->times, clip->key_count * sizeof *clip->times) == 0 &&
                memcmp(again.starts, clip->starts, (clip->key_count + 1) * sizeof *clip->starts) == 0 &&
                again.names.pool_size == clip->names.pool_size,
            "its own text is another clip: %s", text.data);
    ffd_morph_clip_free(&again);
    ffd_buffer_free(&text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    morph_clip clip;
    ffd_error error = {0};
    char *const text = malloc(size + 1);
    if (!text)
        return 0;
    if (size > 0)
        memcpy(text, data, size);
    text[size] = 0;
    const ffd_status status = ffd_morph_clip_parse(text, &clip, &error);
    if (status) {
        PROMISE(status == FFD_E_ARGUMENT, "status %d", status);
        PROMISE(error.message[0] && !strpbrk(error.message, "\r\n"), "it says '%s'", error.message);
    } else {
        check_clip(&clip);
        check_again(&clip);
    }
    ffd_morph_clip_free(&clip);
    free(text);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_text(data, size, capacity, seed, "':=, 01-e.n\t\xff");
}
