/* Clips: the text of an animation of weights is parsed to times and weights, or refused with a quotation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "mesh/morph/morph_clip.h"
#include <ffd/job.h>
#include <string.h>

static const char *name_of(const morph_clip *clip, size_t weight)
{
    return ffd_intern_key(&clip->names, clip->weights[weight].target);
}

static void a_text_becomes_keys(void **state)
{
    morph_clip clip;
    (void)state;
    assert_int_equal(
        ffd_morph_clip_parse(" hop :0 squash=1,\t.25 stretch = 1e0  squash=-0.5, 2", &clip, NULL), FFD_OK);
    assert_string_equal(clip.name, "hop");
    assert_int_equal(clip.key_count, 3);
    assert_int_equal(clip.weight_count, 3);
    assert_true(clip.times[0] >= 0 && clip.times[0] <= 0);
    assert_true(clip.times[1] >= 0.25F && clip.times[1] <= 0.25F);
    assert_true(clip.times[2] >= 2 && clip.times[2] <= 2);
    const size_t starts[] = {0, 1, 3, 3};
    assert_memory_equal(clip.starts, starts, sizeof starts);
    assert_string_equal(name_of(&clip, 0), "squash");
    assert_string_equal(name_of(&clip, 1), "stretch");
    assert_int_equal(clip.weights[2].target, clip.weights[0].target);
    assert_int_equal(clip.names.count, 2);
    double weights[2];
    ffd_morph_clip_weights(&clip, 1, weights);
    const double expected[] = {-0.5, 1}, none[] = {0, 0};
    assert_memory_equal(weights, expected, sizeof expected);
    ffd_morph_clip_weights(&clip, 2, weights);
    assert_memory_equal(weights, none, sizeof none);
    ffd_morph_clip_free(&clip);
}

static void quotes_hold_any_name(void **state)
{
    morph_clip clip;
    (void)state;
    assert_int_equal(ffd_morph_clip_parse("'a: b''c': 0 '='=1 'x,y'=2 it's=3 a:b=4 ''''=5", &clip, NULL),
                     FFD_OK);
    assert_string_equal(clip.name, "a: b'c");
    static const char *const names[] = {"=", "x,y", "it's", "a:b", "'"};
    assert_int_equal(clip.weight_count, 5);
    for (size_t i = 0; i < 5; i++)
        assert_string_equal(name_of(&clip, i), names[i]);
    ffd_morph_clip_free(&clip);
}

/* Each prefix of a clip's text is parsed or refused, without leaks. */
static void a_text_may_end_anywhere(void **state)
{
    static const char text[] = "'a b': 0 'c d'=1 e=2, 1.5 e=-1e-3, 2e2 'c d'=0";
    size_t taken = 0;
    (void)state;
    for (size_t length = 0; length < sizeof text; length++) {
        char cut[sizeof text];
        morph_clip clip;
        ffd_error error = {0};
        memcpy(cut, text, length);
        cut[length] = 0;
        const ffd_status status = ffd_morph_clip_parse(cut, &clip, &error);
        assert_true(status == FFD_OK || (status == FFD_E_ARGUMENT && *error.message));
        taken += status == FFD_OK;
        ffd_morph_clip_free(&clip);
    }
    assert_true(taken > 10);
}

static void clips_name_what_there_is(void **state)
{
    morph_clip clips[2];
    intern_table known = {0};
    uint32_t number;
    ffd_error error;
    (void)state;
    assert_true(ffd_intern(&known, "squash", 6, &number) && ffd_intern(&known, "stretch", 7, &number));
    assert_int_equal(ffd_morph_clip_parse("a: 0 squash=1", &clips[0], NULL), FFD_OK);
    assert_int_equal(ffd_morph_clip_parse("b: 0 stretc=1", &clips[1], NULL), FFD_OK);
    assert_int_equal(ffd_morph_clips_check(clips, 1, &known, &error), FFD_OK);
    assert_int_equal(ffd_morph_clips_check(clips, 2, &known, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "(nearest: \"stretch\")"));
    ffd_morph_clip_free(&clips[1]);
    assert_int_equal(ffd_morph_clip_parse("'a': 1", &clips[1], NULL), FFD_OK);
    assert_int_equal(ffd_morph_clips_check(clips, 2, &known, &error), FFD_E_ARGUMENT);
    assert_non_null(strstr(error.message, "two clips are called \"a\""));
    ffd_morph_clip_free(&clips[0]);
    ffd_morph_clip_free(&clips[1]);
    ffd_intern_free(&known);
}

static void the_library_checks_texts(void **state)
{
    ffd_error error;
    (void)state;
    assert_int_equal(ffd_clip_check("a: 0, 1 b=1", NULL), FFD_OK);
    assert_int_equal(ffd_clip_check("a: 1, 0", &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_clip_check("a: 0 b=1 b=1", &error), FFD_E_ARGUMENT);
    assert_int_equal(ffd_clip_check("a: 0 b=1, 1 b=1", &error), FFD_OK);
}

static void memory_may_run_out_anywhere(void **state)
{
    ffd_status status = FFD_E_MEMORY;
    long successes = 0;
    (void)state;
    for (; status == FFD_E_MEMORY && successes < 100; successes++) {
        ffd_error error;
        ffd_alloc_fail_after(successes);
        status = ffd_clip_check("a: 0 b=1 c=2, 1 d=1", &error);
        ffd_alloc_fail_after(-1);
    }
    assert_int_equal(status, FFD_OK);
    assert_true(successes > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_becomes_keys),      cmocka_unit_test(quotes_hold_any_name),
        cmocka_unit_test(a_text_may_end_anywhere),  cmocka_unit_test(clips_name_what_there_is),
        cmocka_unit_test(the_library_checks_texts), cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
