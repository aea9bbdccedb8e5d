/* check_image.c - decodes an image that may be anything: within its budget, to all its pixels or to an error.
 */
#include "check_image.h"
#include "base/memory/memory.h"
#include "mutate_text.h"
#include "picture/image/image.h"
#include "promise.h"
#include <string.h>

/* What decoding may take. */
#define MOST_BYTES ((uint64_t)16 << 20)

void check_image(const uint8_t *data, size_t size, const void *magic, size_t magic_size)
{
    memory_budget budget = ffd_budget_make(0);
    budget.most = budget.taken + MOST_BYTES;
    uint8_t *const bytes = malloc(size > 0 ? size : 1);
    PROMISE(bytes, "no memory");
    memcpy(bytes, data, size);
    memcpy(bytes, magic, magic_size < size ? magic_size : size);
    image found = {0, 0, NULL};
    ffd_error error = {0};
    uint32_t width = 0, height = 0;
    const bool is_measured = ffd_image_measure(bytes, size, &width, &height);
    const ffd_status status = ffd_image_decode(bytes, size, &budget, &found, &error);
    free(bytes);
    if (status) {
        PROMISE(status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED || status == FFD_E_LIMIT, "status %d",
                status);
        PROMISE(error.message[0] && !strpbrk(error.message, "\r\n"), "it says '%s'", error.message);
        PROMISE(!found.pixels, "a failure has pixels");
        return;
    }
    PROMISE(!is_measured || (width == found.width && height == found.height),
            "its head says %u x %u, it has %u x %u", width, height, found.width, found.height);
    PROMISE(found.pixels && found.width > 0 && found.height > 0, "an image without pixels");
    PROMISE((uint64_t)found.width * found.height * 4 <= MOST_BYTES, "%u x %u pixels", found.width,
            found.height);
    /* All of them are there. */
    uint64_t sum = 0;
    for (size_t i = 0; i < (size_t)found.width * found.height * 4; i++)
        sum += found.pixels[i];
    PROMISE(sum <= 255 * MOST_BYTES, "the pixels change");
    ffd_free(found.pixels);
}

size_t mutate_bytes(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .text = 0, .random = {seed}};
    if (size == 0)
        return 0;
    if (mutant_pick(&m, 3) == 0)
        mutant_change_piece(&m, "\xff\xd8\xda\xc4\xdb\x01\x7f\x80IPD");
    for (size_t i = mutant_pick(&m, 4); i > 0 && m.size > 0; i--)
        data[mutant_pick(&m, m.size)] = (uint8_t)draw_number(&m.random);
    return m.size;
}
