/* test_base.c - sizes, lower bounds, slots, buffers, words, paths, JSON text, messages, tiles, sorting. */
#define _GNU_SOURCE /* pthread_setattr_default_np */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/fail.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include "base/system/deadline.h"
#include "base/system/processors.h"
#include "base/system/sort.h"
#include "base/system/thread.h"
#include "base/text/buffer.h"
#include "base/text/words.h"
#include "json/json_text.h"
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void sizes_that_overflow_are_refused(void **state)
{
    size_t result = 1;
    assert_true(ffd_multiply_size(3, 4, &result));
    assert_int_equal(result, 12);
    assert_false(ffd_multiply_size(SIZE_MAX / 2, 3, &result));
    assert_false(ffd_add_size(SIZE_MAX, 1, &result));
    assert_true(ffd_add_size(SIZE_MAX - 1, 1, &result));
    assert_null(ffd_alloc(SIZE_MAX / 2, 4));
    assert_null(ffd_alloc_zero(SIZE_MAX, SIZE_MAX));
    void *block = ffd_alloc(0, 8);
    assert_non_null(block);
    ffd_free(block);
    (void)state;
}

/* Around the size from which on blocks use large pages. */
static const size_t block_sizes[] = {0, 1, ((size_t)4 << 20) - 1, (size_t)4 << 20, ((size_t)6 << 20) + 1};
#define BLOCK_SIZES (sizeof block_sizes / sizeof *block_sizes)

static void check_bytes(const unsigned char *block, size_t size, int value)
{
    for (size_t at = 0; at < size; at++)
        if (block[at] != value)
            fail_msg("byte %zu of %zu", at, size);
}

/* Each block is fully usable, and can be grown like any other. */
static void blocks_of_any_size_hold_their_bytes_and_grow(void **state)
{
    for (size_t i = 0; i < BLOCK_SIZES; i++) {
        const size_t size = block_sizes[i];
        unsigned char *block = ffd_alloc_whole(size, 1);
        assert_non_null(block);
        memset(block, (int)i + 1, size);
        block = ffd_realloc(block, size + 4096, 1);
        assert_non_null(block);
        check_bytes(block, size, (int)i + 1);
        ffd_free(block);
        ffd_alloc_fail_after(0);
        assert_null(ffd_alloc_whole(size, 1));
        ffd_alloc_fail_after(-1);
    }
    assert_null(ffd_alloc_whole(SIZE_MAX / 2, 4));
    (void)state;
}

/* Even if the memory held something else before. */
static void sparse_blocks_of_any_size_are_zeros(void **state)
{
    for (size_t i = 0; i < 2 * BLOCK_SIZES; i++) {
        const size_t size = block_sizes[i % BLOCK_SIZES];
        unsigned char *const block = ffd_alloc_sparse(size, 1);
        assert_non_null(block);
        check_bytes(block, size, 0);
        memset(block, 7, size);
        check_bytes(block, size, 7);
        ffd_free(block);
        ffd_alloc_fail_after(0);
        assert_null(ffd_alloc_sparse(size, 1));
        ffd_alloc_fail_after(-1);
    }
    assert_null(ffd_alloc_sparse(SIZE_MAX / 2, 4));
    (void)state;
}

static void slots_start_empty_and_at_most_half_full(void **state)
{
    static const size_t masks[][2] = {{0, 15}, {8, 15}, {9, 31}, {16, 31}, {1000, 2047}};
    for (size_t i = 0; i < sizeof masks / sizeof *masks; i++) {
        size_t mask;
        uint32_t *slots = ffd_slots_make(masks[i][0], sizeof *slots, &mask);
        assert_non_null(slots);
        assert_int_equal(mask, masks[i][1]);
        for (size_t s = 0; s <= mask; s++)
            assert_int_equal(slots[s], UINT32_MAX);
        ffd_free(slots);
    }
    (void)state;
}

static void an_array_that_cannot_grow_stays_as_it_is(void **state)
{
    int *numbers = NULL;
    size_t capacity = 0;
    for (size_t i = 0; i < 1000; i++) {
        assert_true(ffd_grow((void **)&numbers, &capacity, i + 1, sizeof *numbers));
        numbers[i] = (int)i;
    }
    assert_int_equal(numbers[999], 999);
    ffd_alloc_fail_after(0);
    const int *before = numbers;
    const size_t held = capacity;
    assert_false(ffd_grow((void **)&numbers, &capacity, capacity + 1, sizeof *numbers));
    ffd_alloc_fail_after(-1);
    assert_ptr_equal(numbers, before);
    assert_int_equal(capacity, held);
    ffd_free(numbers);
    (void)state;
}

static void a_buffer_gives_all_its_text_or_none(void **state)
{
    byte_buffer buffer = {0};
    for (int i = 0; i < 100; i++)
        ffd_buffer_format(&buffer, "%d,", i);
    ffd_buffer_number(&buffer, 0.5);
    char *text = ffd_buffer_finish(&buffer);
    assert_non_null(text);
    assert_memory_equal(text, "0,1,2,", 6);
    assert_string_equal(text + strlen(text) - 6, "99,0.5");
    ffd_free(text);

    ffd_alloc_fail_after(0);
    ffd_buffer_text(&buffer, "lost");
    ffd_alloc_fail_after(-1);
    ffd_buffer_text(&buffer, "too late");
    assert_true(buffer.failed);
    assert_null(ffd_buffer_finish(&buffer));
    (void)state;
}

static void a_misspelled_word_finds_its_nearest(void **state)
{
    static const char *const known[] = {"rest",    "size",     "degree", "knots",
                                        "weights", "deformed", "units",  "moves"};
    assert_string_equal(ffd_nearest_word("knot", known, 8), "knots");
    assert_string_equal(ffd_nearest_word("degrees", known, 8), "degree");
    assert_string_equal(ffd_nearest_word("mvoes", known, 8), "moves");
    assert_string_equal(ffd_nearest_word("Size", known, 8), "size");
    assert_null(ffd_nearest_word("x", known, 0));
    char longest[500];
    memset(longest, 'k', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    assert_non_null(ffd_nearest_word(longest, known, 8));
    (void)state;
}

static void check_text(char *text, const char *expected)
{
    assert_non_null(text);
    assert_string_equal(text, expected);
    ffd_free(text);
}

static void paths_are_split_and_joined(void **state)
{
    assert_string_equal(ffd_path_name("a/b.obj"), "b.obj");
    assert_string_equal(ffd_file_display_name("-"), "standard input");
    assert_string_equal(ffd_file_display_name("./-"), "./-");
    assert_string_equal(ffd_path_ending("a.d/b"), "");
    assert_string_equal(ffd_path_ending("a/.obj"), "");
    assert_string_equal(ffd_path_ending("x.gltf.glb"), ".glb");
    assert_true(ffd_path_has_ending("X.OBJ", ".obj"));
    assert_false(ffd_path_has_ending("x.objx", ".obj"));
    assert_false(ffd_path_has_ending("x.ob", ".obj"));
    check_text(ffd_path_folder("b.obj"), ".");
    check_text(ffd_path_folder("/b.obj"), "/");
    check_text(ffd_path_folder("a//b.obj"), "a");
    check_text(ffd_path_stem("a/b.x.obj"), "b.x");
    check_text(ffd_path_join("a", "b"), "a/b");
    check_text(ffd_path_join("a/", "b"), "a/b");
    check_text(ffd_path_join("", "b"), "b");
    (void)state;
}

static void json_is_indented_escaped_and_has_no_nan(void **state)
{
    byte_buffer out = {0};
    json_text json;
    const double numbers[] = {1, 0.1, -2e-300};
    ffd_json_begin(&json, &out);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "name", "a\"b\\c\n\x01");
    ffd_json_vector(&json, "numbers", numbers, 3);
    ffd_json_array(&json, "empty", false);
    ffd_json_end(&json, ']');
    ffd_json_object(&json, "inner", false);
    ffd_json_number(&json, "nan", 0.0 / (numbers[0] - 1));
    ffd_json_number(&json, "infinite", numbers[2] / (numbers[0] - 1));
    ffd_json_bool(&json, "yes", true);
    ffd_json_count(&json, "count", UINT64_MAX);
    ffd_json_end(&json, '}');
    ffd_json_end(&json, '}');
    char *text = ffd_buffer_finish(&out);
    assert_string_equal(text,
                        "{\n  \"name\": \"a\\\"b\\\\c\\n\\u0001\",\n  \"numbers\": [1, 0.1, -2e-300],\n"
                        "  \"empty\": [],\n  \"inner\": {\n    \"nan\": null,\n    \"infinite\": null,\n"
                        "    \"yes\": true,\n"
                        "    \"count\": 18446744073709551615\n  }\n}\n");
    ffd_free(text);
    (void)state;
}

static void broken_utf8_is_replaced_in_json(void **state)
{
    byte_buffer out = {0};
    json_text json;
    ffd_json_begin(&json, &out);
    ffd_json_string(&json, NULL, "\xc3\xa4 \xf0\x9f\x90\x84 \xff \xc3 \xed\xa0\x80 \xe2\x82");
    char *text = ffd_buffer_finish(&out);
    assert_string_equal(text, "\"\xc3\xa4 \xf0\x9f\x90\x84 \xef\xbf\xbd \xef\xbf\xbd "
                              "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xef\xbf\xbd\xef\xbf\xbd\"");
    ffd_free(text);
    (void)state;
}

static void messages_name_their_place_in_one_line(void **state)
{
    ffd_error error = {0};
    char line[200];
    assert_int_equal(ffd_fail_line(&error, FFD_E_INVALID, "a\nb.obj", 7, "bad \"%s\"", "x\ty"),
                     FFD_E_INVALID);
    ffd_error_format(&error, line, sizeof line);
    assert_string_equal(line, "a?b.obj:7: bad \"x?y\"");
    ffd_fail_at(&error, FFD_E_INVALID, "l.json", 0, "/moves/0", "needs an action");
    ffd_error_format(&error, line, sizeof line);
    assert_string_equal(line, "l.json:/moves/0: needs an action");
    ffd_fail(&error, FFD_E_ARGUMENT, "no lattice");
    assert_int_equal(ffd_error_format(&error, line, 5), 10);
    assert_string_equal(line, "no l");
    ffd_fail_name_file(&error, "f");
    ffd_fail_name_file(&error, "g");
    assert_string_equal(error.file, "f");
    assert_int_equal(ffd_fail(NULL, FFD_E_LIMIT, "nobody listens"), FFD_E_LIMIT);
    /* A text longer than the record is truncated. A message may be made from the record itself. */
    char longest[3000];
    memset(longest, 'y', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    ffd_fail_file(&error, FFD_E_IO, longest, "%s", longest);
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    ffd_fail(&error, FFD_E_IO, "short");
    ffd_fail_file(&error, FFD_E_IO, "x", "wrapped: %s", error.message);
    assert_string_equal(error.message, "wrapped: short");
    (void)state;
}

static void each_status_has_its_exit_code(void **state)
{
    assert_int_equal(ffd_status_exit_code(FFD_OK), 0);
    assert_int_equal(ffd_status_exit_code(FFD_E_GATE), 1);
    assert_int_equal(ffd_status_exit_code(FFD_E_ARGUMENT), 2);
    assert_int_equal(ffd_status_exit_code(FFD_E_IO), 3);
    assert_int_equal(ffd_status_exit_code(FFD_E_EXISTS), 3);
    assert_int_equal(ffd_status_exit_code(FFD_E_INVALID), 4);
    assert_int_equal(ffd_status_exit_code(FFD_E_EMBEDDING), 5);
    assert_int_equal(ffd_status_exit_code(FFD_E_UNSUPPORTED), 6);
    assert_int_equal(ffd_status_exit_code(FFD_E_MEMORY), 7);
    assert_int_equal(ffd_status_exit_code(FFD_E_LIMIT), 7);
    (void)state;
}

static bool is_less(const void *element, const void *key)
{
    return *(const int *)element < *(const int *)key;
}

static void a_lower_bound_is_the_first_of_its_key(void **state)
{
    static const int sorted[] = {1, 3, 3, 3, 7};
    (void)state;
    for (size_t count = 0; count <= 5; count++)
        for (int key = 0; key <= 8; key++) {
            size_t expected = 0;
            while (expected < count && sorted[expected] < key)
                expected++;
            assert_int_equal(lower_bound(&key, count ? sorted : NULL, count, sizeof *sorted, is_less),
                             expected);
        }
}

static bool is_at_most(const void *element, const void *key)
{
    return *(const int *)element <= *(const int *)key;
}

static void the_last_up_to_a_key_is_the_first_where_all_are_beyond(void **state)
{
    static const int sorted[] = {1, 3, 3, 3, 7};
    (void)state;
    for (size_t count = 0; count <= 5; count++)
        for (int key = 0; key <= 8; key++) {
            size_t expected = 0;
            for (size_t i = 0; i < count; i++)
                if (sorted[i] <= key)
                    expected = i;
            assert_int_equal(last_up_to(&key, count ? sorted : NULL, count, sizeof *sorted, is_at_most),
                             expected);
        }
}

typedef struct tile_log {
    unsigned char seen[10007];
    size_t tiles[200];
} tile_log;

static void mark_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    tile_log *log = context;
    assert_true(worker >= 0 && worker < 8);
    log->tiles[tile] = end - begin;
    for (size_t i = begin; i < end; i++)
        log->seen[i]++;
}

static void tiles_visit_each_item_once(void **state)
{
    static const int threads[] = {1, 2, 8, 1000};
    static tile_log log;
    for (size_t t = 0; t < 4; t++) {
        memset(&log, 0, sizeof log);
        /* 1000 threads for 8 tiles: at most 8 workers run. */
        ffd_parallel_tiles(sizeof log.seen, t == 3 ? 1300 : 100, threads[t], mark_tile, &log);
        for (size_t i = 0; i < sizeof log.seen; i++)
            assert_int_equal(log.seen[i], 1);
        assert_int_equal(log.tiles[t == 3 ? 7 : 100], t == 3 ? 907 : 7);
    }
    ffd_parallel_tiles(0, 100, 4, mark_tile, NULL);
    assert_true(ffd_processor_count() >= 1);
    (void)state;
}

#ifdef __GLIBC__
/* Writes to all of 400 KB of the stack, as a search in a curved lattice does. */
static void use_stack(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    volatile char block[400 << 10];
    (void)context, (void)begin, (void)end, (void)worker;
    for (size_t i = 0; i < sizeof block; i += 1024)
        block[i] = (char)tile;
}

/* Other C libraries give a thread 128 KB. */
static void threads_have_the_stack_that_searches_need(void **state)
{
    (void)state;
    pthread_attr_t before, small;
    assert_int_equal(pthread_getattr_default_np(&before), 0);
    assert_int_equal(pthread_attr_init(&small), 0);
    assert_int_equal(pthread_attr_setstacksize(&small, (size_t)128 << 10), 0);
    assert_int_equal(pthread_setattr_default_np(&small), 0);
    ffd_parallel_tiles(64, 1, 4, use_stack, NULL);
    assert_int_equal(pthread_setattr_default_np(&before), 0);
    pthread_attr_destroy(&small);
    pthread_attr_destroy(&before);
}
#endif

typedef struct ordered_log {
    unsigned char made[1000]; /* by thread, for each tile */
    size_t in_slot[32];       /* tile + 1, until it is finished */
    size_t finished;          /* only one thread at a time writes it */
    size_t out_of_order;
} ordered_log;

static void make_slowly(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    ordered_log *log = context;
    volatile size_t work = 0;
    log->in_slot[worker] = tile + 1;
    for (size_t i = 0; i < (tile * 7919 % 13) * 1000; i++)
        work += i;
    (void)work;
    log->made[tile] = (unsigned char)(end - begin);
}

static void finish_in_order(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    ordered_log *log = context;
    log->out_of_order += log->in_slot[worker] != tile + 1;
    log->out_of_order += tile != log->finished || log->made[tile] != end - begin || begin != 3 * tile;
    log->finished++;
}

static void tiles_are_finished_in_their_order(void **state)
{
    static const int threads[] = {1, 2, 3, 16};
    for (size_t t = 0; t < 4; t++) {
        static ordered_log log;
        memset(&log, 0, sizeof log);
        assert_true(ffd_ordered_slots(threads[t]) <= 32);
        assert_true(ffd_parallel_in_order(2999, 3, threads[t], make_slowly, finish_in_order, &log));
        assert_int_equal(log.finished, 1000);
        assert_int_equal(log.out_of_order, 0);
    }
    assert_true(ffd_parallel_in_order(0, 1, 4, make_slowly, finish_in_order, NULL));
    ffd_alloc_fail_after(0);
    assert_false(ffd_parallel_in_order(10, 1, 4, make_slowly, finish_in_order, NULL));
    ffd_alloc_fail_after(-1);
    (void)state;
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Returns count numbers of which none is there twice, in no order; 7919 is prime. */
static uint32_t *shuffled(size_t count)
{
    uint32_t *const numbers = malloc((count + 1) * sizeof *numbers);
    assert_non_null(numbers);
    for (size_t i = 0; i < count; i++)
        numbers[i] = (uint32_t)(i * 7919 % count);
    return numbers;
}

static void many_items_are_sorted(void **state)
{
    static const size_t counts[] = {0, 1, 2, 32767, 32768, 32769, 65536, 65537, 100003, 200000};
    (void)state;
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        uint32_t *const numbers = shuffled(counts[c]);
        assert_int_equal(ffd_sort(numbers, counts[c], sizeof *numbers, compare_numbers, NULL), FFD_OK);
        for (size_t i = 0; i < counts[c]; i++)
            assert_int_equal(numbers[i], i);
        free(numbers);
    }
}

static void a_sort_hears_a_cancel_and_lacks_memory(void **state)
{
    const int cancel = 1;
    work_watch watch = {.cancel = &cancel};
    deadline own;
    uint32_t *const numbers = shuffled(100003);
    (void)state;
    const deadline *const before = ffd_deadline_begin(&own, 0, &watch);
    assert_int_equal(ffd_sort(numbers, 100003, sizeof *numbers, compare_numbers, NULL), FFD_E_CANCELLED);
    ffd_deadline_end(before);
    ffd_alloc_fail_after(0);
    assert_int_equal(ffd_sort(numbers, 100003, sizeof *numbers, compare_numbers, NULL), FFD_E_MEMORY);
    ffd_alloc_fail_after(-1);
    free(numbers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_that_overflow_are_refused),
        cmocka_unit_test(blocks_of_any_size_hold_their_bytes_and_grow),
        cmocka_unit_test(sparse_blocks_of_any_size_are_zeros),
        cmocka_unit_test(slots_start_empty_and_at_most_half_full),
        cmocka_unit_test(an_array_that_cannot_grow_stays_as_it_is),
        cmocka_unit_test(a_buffer_gives_all_its_text_or_none),
        cmocka_unit_test(a_misspelled_word_finds_its_nearest),
        cmocka_unit_test(paths_are_split_and_joined),
        cmocka_unit_test(json_is_indented_escaped_and_has_no_nan),
        cmocka_unit_test(messages_name_their_place_in_one_line),
        cmocka_unit_test(broken_utf8_is_replaced_in_json),
        cmocka_unit_test(each_status_has_its_exit_code),
        cmocka_unit_test(a_lower_bound_is_the_first_of_its_key),
        cmocka_unit_test(the_last_up_to_a_key_is_the_first_where_all_are_beyond),
        cmocka_unit_test(tiles_visit_each_item_once),
        cmocka_unit_test(tiles_are_finished_in_their_order),
#ifdef __GLIBC__
        cmocka_unit_test(threads_have_the_stack_that_searches_need),
#endif
        cmocka_unit_test(many_items_are_sorted),
        cmocka_unit_test(a_sort_hears_a_cancel_and_lacks_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
