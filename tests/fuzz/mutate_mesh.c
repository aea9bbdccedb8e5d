/* mutate_mesh.c - changes of mesh files: numbers and lines of the text, bytes of what follows it. A GLB's
   lengths are mostly set right again, so that what its JSON says is looked at. */
#include "base/little_endian.h"
#include "fuzz_target.h"
#include "io/gltf/file/glb.h"
#include "mutate_text.h"
#include <stdbool.h>
#include <string.h>

#define GLB_HEADERS (GLB_HEADER_SIZE + GLB_CHUNK_HEADER_SIZE)
/* Longest range that is copied or removed. */
#define MOST_MOVED 256

/* A range of the bytes [first, end). */
static void pick_range(mutant *m, size_t first, size_t end, size_t *at, size_t *length)
{
    *at = first + mutant_pick(m, end - first);
    const size_t most = end - *at < MOST_MOVED ? end - *at : MOST_MOVED;
    *length = 1 + mutant_pick(m, most);
}

/* From the start of a line, or of a member of a JSON object, to that of another. */
static void pick_lines(mutant *m, size_t first, size_t end, size_t *at, size_t *length)
{
    pick_range(m, first, end, at, length);
    size_t last = *at + *length;
    while (*at > first && m->data[*at - 1] != '\n' && m->data[*at - 1] != ',')
        --*at;
    while (last < end && m->data[last - 1] != '\n' && m->data[last - 1] != ',')
        last++;
    *length = last - *at;
}

static void copy_range(mutant *m, size_t at, size_t length, size_t to, size_t instead)
{
    uint8_t kept[MOST_MOVED];
    if (length > sizeof kept)
        length = sizeof kept;
    memcpy(kept, m->data + at, length);
    mutant_replace(m, to, instead, kept, length);
}

static void change_text(mutant *m)
{
    size_t at, length, other, other_length;
    switch (mutant_pick(m, 8)) {
    case 0:
        pick_lines(m, 0, m->text, &at, &length);
        mutant_replace(m, at, length, NULL, 0);
        break;
    case 1:
        pick_lines(m, 0, m->text, &at, &length);
        pick_lines(m, 0, m->text, &other, &other_length);
        copy_range(m, at, length, other, 0);
        break;
    case 2:
        pick_lines(m, 0, m->text, &at, &length);
        pick_lines(m, 0, m->text, &other, &other_length);
        copy_range(m, at, length, other, other_length);
        break;
    case 3:
        m->data[mutant_pick(m, m->text)] = (uint8_t)draw_bits(&m->random);
        break;
    case 4:
        mutant_copy_number(m);
        break;
    default:
        mutant_change_number(m);
        break;
    }
}

static void change_bytes(mutant *m, size_t first)
{
    static const uint8_t others[][4] = {
        {0}, {255, 255, 255, 255}, {0, 0, 128, 127}, {0, 0, 192, 255}, {0, 0, 128, 63}};
    size_t at, length;
    pick_range(m, first, m->size, &at, &length);
    switch (mutant_pick(m, 4)) {
    case 0:
        mutant_replace(m, at, length, NULL, 0);
        break;
    case 1:
        copy_range(m, at, length, first + mutant_pick(m, m->size - first), 0);
        break;
    case 2:
        m->data[at] = (uint8_t)draw_bits(&m->random);
        break;
    default:
        at = first + (at - first) / 4 * 4;
        if (m->size - at >= 4)
            memcpy(m->data + at, others[mutant_pick(m, sizeof others / sizeof *others)], 4);
        break;
    }
}

static bool is_whole_glb(const uint8_t *data, size_t size, size_t *json)
{
    if (size < GLB_HEADERS || !ffd_glb_is(data, size))
        return false;
    *json = load_u32(data + GLB_HEADER_SIZE);
    return *json > 0 && *json <= size - GLB_HEADERS;
}

static size_t change_glb(mutant m, size_t json)
{
    uint8_t *const file = m.data;
    mutant body = {.data = file + GLB_HEADERS,
                   .size = m.size - GLB_HEADERS,
                   .capacity = m.capacity - GLB_HEADERS,
                   .text = json,
                   .random = m.random};
    const bool repairs = mutant_pick(&body, 8) > 0;
    if (body.size > json + GLB_CHUNK_HEADER_SIZE && mutant_pick(&body, 3) == 0) {
        change_bytes(&body, json + GLB_CHUNK_HEADER_SIZE * (size_t)repairs);
    } else {
        const size_t before = body.size;
        change_text(&body);
        json = json + body.size - before;
        if (repairs && json % 4 > 0 && body.capacity - body.size >= 4) {
            mutant_replace(&body, json, 0, "   ", 4 - json % 4);
            json += 4 - json % 4;
        }
    }
    const size_t size = GLB_HEADERS + body.size;
    if (!repairs)
        return size;
    store_u32(file + 8, (uint32_t)size);
    store_u32(file + GLB_HEADER_SIZE, (uint32_t)json);
    if (body.size >= json + GLB_CHUNK_HEADER_SIZE)
        store_u32(body.data + json, (uint32_t)(body.size - json - GLB_CHUNK_HEADER_SIZE));
    return size;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .random = {seed}};
    size_t json;
    if (size == 0)
        return 0;
    if (is_whole_glb(data, size, &json))
        return change_glb(m, json);
    while (m.text < size && m.data[m.text] > 0 && m.data[m.text] < 0x80)
        m.text++;
    if (m.text < size && (m.text == 0 || mutant_pick(&m, 3) == 0))
        change_bytes(&m, m.text);
    else
        change_text(&m);
    return m.size;
}
