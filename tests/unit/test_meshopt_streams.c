/* test_meshopt_streams.c - streams that meshoptimizer 1.3 has made, of both versions, and what its decoder
   makes of them (tests/golden/meshopt_streams.mjs): test_meshopt_streams FILE */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "base/little_endian.h"
#include "mesh/meshopt/meshopt_stream.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define HEAD 20 /* bytes before a stream */
#define MUTATIONS 60

typedef struct sample {
    meshopt_view view;
    const unsigned char *decoded; /* borrowed */
} sample;

static const char *path;
static unsigned char *content;
static size_t size;

static int load(void **state)
{
    (void)state;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    size = (size_t)ftell(file);
    rewind(file);
    content = malloc(size);
    assert_int_equal(fread(content, 1, size, file), size);
    return fclose(file);
}

static int unload(void **state)
{
    (void)state;
    free(content);
    return 0;
}

/* Takes the next sample of the file. */
static bool next(size_t *at, sample *s)
{
    if (*at == size)
        return false;
    assert_true(*at + HEAD <= size);
    const unsigned char *const head = content + *at;
    s->view = (meshopt_view){.mode = (meshopt_mode)load_u32(head),
                             .filter = (meshopt_filter)load_u32(head + 4),
                             .count = load_u32(head + 8),
                             .stride = load_u32(head + 12),
                             .bytes = head + HEAD,
                             .size = load_u32(head + 16)};
    s->decoded = head + HEAD + s->view.size;
    *at += HEAD + s->view.size + s->view.count * s->view.stride;
    assert_true(*at <= size);
    return true;
}

static unsigned char *make_room(const meshopt_view *view)
{
    unsigned char *bytes = malloc((size_t)(view->count * view->stride));
    assert_non_null(bytes);
    return bytes;
}

/* The components of the filters that round: of 2 or, where elements have 4 bytes, of 1 byte. */
static int component(const sample *s, const unsigned char *bytes, size_t i)
{
    const bool is_short = s->view.stride == 8, is_signed = s->view.filter != MESHOPT_COLOR;
    const int value = is_short ? bytes[2 * i] | bytes[2 * i + 1] << 8 : bytes[i],
              half = is_short ? 32768 : 128;
    return is_signed && value >= half ? value - 2 * half : value;
}

/* The extension leaves the last step of these filters to the decoder; what it fixes is the same to the bit.
 */
static void compare(const sample *s, const unsigned char *bytes, size_t place)
{
    const size_t count = (size_t)(s->view.count * s->view.stride);
    const bool rounds = s->view.filter != MESHOPT_NONE && s->view.filter != MESHOPT_EXPONENTIAL;
    if (!rounds && memcmp(bytes, s->decoded, count) != 0)
        fail_msg("the stream before byte %zu is decoded to other bytes", place);
    for (size_t i = 0; rounds && i < 4 * s->view.count; i++)
        if (abs(component(s, bytes, i) - component(s, s->decoded, i)) > 1)
            fail_msg("the stream before byte %zu: component %zu is %d instead of %d", place, i,
                     component(s, bytes, i), component(s, s->decoded, i));
}

static void streams_are_decoded_as_their_maker_decodes_them(void **state)
{
    (void)state;
    sample s;
    for (size_t at = 0; next(&at, &s);) {
        unsigned char *bytes = make_room(&s.view);
        ffd_error error = {0};
        if (ffd_meshopt_check(&s.view, &error) || ffd_meshopt_ready(&s.view, &error) ||
            ffd_meshopt_decode(&s.view, bytes, &error))
            fail_msg("the stream before byte %zu: %s", at, error.message);
        compare(&s, bytes, at);
        free(bytes);
    }
}

/* Our decoder reads version 0 too, where the library is missing. */
static void our_decoder_alone_gives_the_same(void **state)
{
    (void)state;
    sample s;
    for (size_t at = 0; next(&at, &s);) {
        unsigned char *bytes = make_room(&s.view);
        ffd_error error = {0};
        if (ffd_meshopt_read(&s.view, bytes, &error))
            fail_msg("the stream before byte %zu: %s", at, error.message);
        if (s.view.filter == MESHOPT_NONE)
            compare(&s, bytes, at);
        free(bytes);
    }
}

/* A byte before the tail that no element needs. */
static void bytes_that_nothing_needs_are_refused(void **state)
{
    (void)state;
    sample s;
    for (size_t at = 0; next(&at, &s);) {
        const size_t tail = (size_t)ffd_meshopt_tail(&s.view), place = s.view.size - tail;
        unsigned char *const longer = malloc(s.view.size + 1), *const bytes = make_room(&s.view);
        ffd_error error = {0};
        memcpy(longer, s.view.bytes, place);
        longer[place] = 0;
        memcpy(longer + place + 1, s.view.bytes + place, tail);
        s.view.bytes = longer;
        s.view.size++;
        assert_int_equal(ffd_meshopt_check(&s.view, &error), FFD_OK);
        assert_int_equal(ffd_meshopt_read(&s.view, bytes, &error), FFD_E_INVALID);
        assert_non_null(strstr(error.message, " has 1 byte too many"));
        free(bytes);
        free(longer);
    }
}

/* The samples hold all that can be in a stream, else the tests above would prove less than they say. */
static void the_samples_hold_everything(void **state)
{
    (void)state;
    unsigned modes = 0, filters = 0, versions = 0, channels = 0, controls = 0;
    bool is_turned = false, has_blocks = false;
    sample s;
    for (size_t at = 0; next(&at, &s);) {
        const meshopt_view *const v = &s.view;
        const size_t columns = (size_t)v->stride / 4;
        modes |= 1u << v->mode;
        filters |= 1u << v->filter;
        if (v->mode != MESHOPT_ATTRIBUTES)
            continue;
        versions |= 1u << ffd_meshopt_version(v);
        has_blocks = has_blocks || v->count > ffd_meshopt_block((size_t)v->stride);
        for (size_t c = 0; ffd_meshopt_version(v) && c < columns; c++) {
            const unsigned channel = v->bytes[v->size - columns + c], control = v->bytes[1 + c];
            channels |= 1u << (channel & 0xf);
            is_turned = is_turned || channel >> 4;
            for (int b = 0; b < 8; b += 2)
                controls |= 1u << (control >> b & 3);
        }
    }
    assert_int_equal(modes, 7);
    assert_int_equal(filters, 31);
    assert_int_equal(versions, 3);
    assert_int_equal(channels, 7);
    assert_int_equal(controls, 15);
    assert_true(is_turned);
    assert_true(has_blocks);
}

/* Sanitizers and valgrind see what is read outside of a stream, or written outside of its elements. */
static void broken_streams_do_no_harm(void **state)
{
    (void)state;
    draw d = {11};
    size_t refused = 0, tried = 0;
    sample s;
    for (size_t at = 0; next(&at, &s) && tried < 100 * MUTATIONS;)
        for (int run = 0; run < MUTATIONS; run++, tried++) {
            meshopt_view changed = s.view;
            changed.size -= run % 3 == 0 ? draw_number(&d) % changed.size : 0;
            changed.count += run % 7 == 0 ? draw_number(&d) % 40 : 0;
            unsigned char *const stream = malloc(changed.size);
            memcpy(stream, s.view.bytes, changed.size);
            changed.bytes = stream;
            for (uint32_t flips = draw_number(&d) % 4; flips > 0; flips--) {
                const size_t place = draw_number(&d) % changed.size;
                stream[flips % 2 ? place : changed.size - 1 - place % (1 + changed.size / 8)] ^=
                    (unsigned char)(1 << draw_number(&d) % 8);
            }
            unsigned char *const bytes = make_room(&changed);
            ffd_status status = ffd_meshopt_check(&changed, NULL);
            if (status == FFD_OK && ffd_meshopt_ready(&changed, NULL) == FFD_OK)
                status = ffd_meshopt_decode(&changed, bytes, NULL);
            assert_true(status == FFD_OK || status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED);
            refused += status != FFD_OK;
            free(bytes);
            free(stream);
        }
    assert_in_range(refused, tried / 4, tried);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streams_are_decoded_as_their_maker_decodes_them),
        cmocka_unit_test(our_decoder_alone_gives_the_same),
        cmocka_unit_test(bytes_that_nothing_needs_are_refused),
        cmocka_unit_test(the_samples_hold_everything),
        cmocka_unit_test(broken_streams_do_no_harm),
    };
    if (count != 2)
        return 2;
    path = arguments[1];
    return cmocka_run_group_tests(tests, load, unload);
}
