/* meshopt_attributes.c - streams of mode ATTRIBUTES: blocks of elements, and in each block the bytes at one
   place of all its elements, as differences from one element to the next. */
#include "base/little_endian.h"
#include "mesh/meshopt/meshopt_stream.h"
#include <stdbool.h>

#define CHANNEL 4 /* bytes of an element whose differences are taken alike */

/* Widths of differences, in bits, by the two bits that a group has in the header: of version 0, and of the
   two controls that have headers. */
static const unsigned char older_widths[4] = {0, 2, 4, 8};
static const unsigned char widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};

typedef enum control { CONTROL_NARROW, CONTROL_WIDE, CONTROL_ZERO, CONTROL_LITERAL } control;
typedef enum channel_mode { CHANNEL_BYTES, CHANNEL_SHORTS, CHANNEL_XOR } channel_mode;

typedef struct attributes {
    meshopt_stream *stream;
    unsigned version;
    size_t stride;
    const unsigned char *channels;                 /* version 1: a byte for each channel */
    unsigned char last[MESHOPT_COLUMNS * CHANNEL]; /* the element before */
} attributes;

/* Reads the differences of a group. Those that do not fit into their bits follow as bytes. */
static bool read_group(meshopt_stream *from, unsigned width, unsigned char *deltas)
{
    const unsigned char *packed = meshopt_take(from, MESHOPT_GROUP * width / 8);
    const unsigned largest = (1u << width) - 1;
    if (!packed)
        return false;
    if (width == 0 || width == 8) {
        if (width)
            memcpy(deltas, packed, MESHOPT_GROUP);
        else
            memset(deltas, 0, MESHOPT_GROUP);
        return true;
    }
    for (unsigned i = 0; i < MESHOPT_GROUP; i++) {
        const unsigned place = i * width % 8, shift = width == 1 ? place : 8 - width - place;
        unsigned value = packed[i * width / 8] >> shift & largest;
        if (value == largest) {
            const unsigned char *whole = meshopt_take(from, 1);
            if (!whole)
                return false;
            value = *whole;
        }
        deltas[i] = (unsigned char)value;
    }
    return true;
}

/* Reads the differences at one place of the elements of a block. */
static bool read_groups(meshopt_stream *from, const unsigned char by_bits[4], size_t groups,
                        unsigned char *deltas)
{
    const unsigned char *header = meshopt_take(from, (groups + 3) / 4);
    for (size_t g = 0; header && g < groups; g++)
        if (!read_group(from, by_bits[header[g / 4] >> g % 4 * 2 & 3], deltas + MESHOPT_GROUP * g))
            return false;
    return header != NULL;
}

static bool read_column(attributes *a, control how, size_t count, unsigned char *deltas)
{
    const size_t groups = (count + MESHOPT_GROUP - 1) / MESHOPT_GROUP;
    const unsigned char *literal;
    switch (how) {
    case CONTROL_ZERO:
        memset(deltas, 0, count);
        return true;
    case CONTROL_LITERAL:
        literal = meshopt_take(a->stream, count);
        if (literal)
            memcpy(deltas, literal, count);
        return literal != NULL;
    default:
        return read_groups(a->stream, a->version == 0 ? older_widths : widths[how], groups, deltas);
    }
}

/* A difference has its sign in the lowest bit. */
static unsigned unfold_sign(unsigned value)
{
    return value >> 1 ^ (0u - (value & 1));
}

/* Adds up the differences at the four places of a channel. */
static void add_up(attributes *a, size_t channel, const unsigned char deltas[CHANNEL][MESHOPT_BLOCK],
                   size_t count, unsigned char *bytes)
{
    unsigned char *const last = a->last + CHANNEL * channel;
    const unsigned mode = a->version == 0 ? CHANNEL_BYTES : a->channels[channel] & 0xfu;
    const unsigned turn = a->version == 0 ? 0 : a->channels[channel] >> 4;
    for (size_t i = 0; i < count; i++, bytes += a->stride) {
        if (mode == CHANNEL_BYTES) {
            for (size_t b = 0; b < CHANNEL; b++)
                last[b] = (unsigned char)(last[b] + unfold_sign(deltas[b][i]));
        } else if (mode == CHANNEL_SHORTS) {
            for (size_t b = 0; b < CHANNEL; b += 2) {
                const unsigned delta = unfold_sign(deltas[b][i] | (unsigned)deltas[b + 1][i] << 8);
                store_u16(last + b, (uint16_t)((last[b] | (unsigned)last[b + 1] << 8) + delta));
            }
        } else {
            const unsigned char parts[CHANNEL] = {deltas[0][i], deltas[1][i], deltas[2][i], deltas[3][i]};
            const uint32_t delta = load_u32(parts);
            store_u32(last, load_u32(last) ^ (delta >> turn | delta << (32 - turn) % 32));
        }
        memcpy(bytes, last, CHANNEL);
    }
}

static bool read_block(attributes *a, size_t count, unsigned char *bytes)
{
    unsigned char deltas[CHANNEL][MESHOPT_BLOCK];
    const size_t channels = a->stride / CHANNEL;
    const unsigned char *controls = a->version ? meshopt_take(a->stream, channels) : NULL;
    if (a->version && !controls)
        return false;
    for (size_t c = 0; c < channels; c++) {
        for (size_t b = 0; b < CHANNEL; b++) {
            const control how = controls ? (control)(controls[c] >> 2 * b & 3) : CONTROL_NARROW;
            if (!read_column(a, how, count, deltas[b]))
                return false;
        }
        add_up(a, c, (const unsigned char(*)[MESHOPT_BLOCK])deltas, count, bytes + CHANNEL * c);
    }
    return true;
}

/* Returns whether the extension knows how the differences of a channel are taken. */
static bool is_channel(unsigned char channel)
{
    return channel <= CHANNEL_XOR || (channel & 0xf) == CHANNEL_XOR;
}

/* Reads the tail: the first element, and how the differences of each channel are taken. */
static ffd_status begin(attributes *a, const meshopt_view *view, ffd_error *error)
{
    const size_t channels = a->version ? a->stride / CHANNEL : 0;
    a->channels = view->bytes + view->size - channels;
    memcpy(a->last, a->channels - a->stride, a->stride);
    for (size_t c = 0; c < channels; c++)
        if (!is_channel(a->channels[c]))
            return ffd_fail(error, FFD_E_INVALID,
                            "channel %zu of the compressed data has the unknown mode 0x%02x", c,
                            a->channels[c]);
    return FFD_OK;
}

ffd_status ffd_meshopt_read_attributes(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                       ffd_error *error)
{
    attributes a = {.stream = from, .version = ffd_meshopt_version(view), .stride = (size_t)view->stride};
    const size_t most = ffd_meshopt_block(a.stride);
    TRY(begin(&a, view, error));
    for (size_t left = (size_t)view->count; left > 0;) {
        const size_t count = left < most ? left : most;
        if (!read_block(&a, count, bytes))
            return ffd_fail(error, FFD_E_INVALID, "the compressed data of mode ATTRIBUTES ends too early");
        bytes += count * a.stride;
        left -= count;
    }
    return FFD_OK;
}
