/* OBJ in blocks: however a file is divided, its blocks have the same statements as the whole; and arguments
   parsed directly from the text equal those parsed as words. */
#include "../support/draw.h"
#include "base/memory/memory.h"
#include "io/obj/obj_blocks.h"
#include "io/obj/obj_corner.h"
#include "io/obj/obj_number.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define RUNS 3000
#define MOST_PIECES 60
#define ROOM 20000

static const char *const pieces[] = {
    "v 1 2 3",
    "f 1/2/3 2//3 3",
    "vn 0 0 1",
    "vt .5 .5",
    "# a comment",
    "# C:\\dir\\",
    "g a#b \\c",
    "usemtl x",
    "f 1 2 3# behind",
    "\n",
    "\n",
    "\n",
    "\r\n",
    "\r",
    "\\\n",
    "\\\r\n",
    "\\\r",
    "\\",
    "\\ \n",
    "v 1 2 \\\t\r\n 3",
    " ",
    "\t",
    "#",
    "surf 0 1",
    "v 1e5 -2 +3",
    "o",
    "f -1 -2 \\\n -3",
    "vp 1 2 3\f\v",
    "v",
    "fo 1",
};

static ffd_status cut_text(const char *text, size_t size, size_t target, obj_blocks *blocks)
{
    const file_input input = {.data = (const unsigned char *)text, .size = size};
    return ffd_obj_blocks_cut(&input, text, target, blocks, NULL);
}

static size_t draw_text(draw *d, char *text)
{
    size_t size = 0;
    for (uint32_t count = draw_number(d) % MOST_PIECES; count > 0; count--) {
        const char *piece = pieces[draw_number(d) % (sizeof pieces / sizeof *pieces)];
        memcpy(text + size, piece, strlen(piece));
        size += strlen(piece);
    }
    return size;
}

/* Lists the statements of a scan: keyword, kind, line and words. Returns the next line number. */
static size_t list_statements(obj_scan scan, char *list)
{
    text_word word;
    size_t used = strlen(list);
    while (ffd_obj_scan_next(&scan)) {
        used +=
            (size_t)snprintf(list + used, ROOM - used, "%.*s %d@%zu", (int)(scan.name.last - scan.name.first),
                             scan.name.first, (int)scan.keyword, scan.keyword_line);
        while (ffd_obj_scan_word(&scan, &word))
            used += (size_t)snprintf(list + used, ROOM - used, " [%.*s]", (int)(word.last - word.first),
                                     word.first);
        used += (size_t)snprintf(list + used, ROOM - used, "\n");
    }
    return scan.line;
}

static void any_cut_gives_the_same_statements(void **state)
{
    (void)state;
    static char text[ROOM], whole[ROOM], cut[ROOM];
    draw d = {7};
    size_t most_blocks = 0;
    for (int run = 0; run < RUNS; run++) {
        const size_t size = draw_text(&d, text), target = 1 + draw_number(&d) % 60;
        obj_blocks blocks;
        obj_scan scan;
        size_t line = 1;
        whole[0] = cut[0] = 0;
        ffd_obj_scan_begin(&scan, text, size);
        list_statements(scan, whole);
        assert_int_equal(cut_text(text, size, target, &blocks), FFD_OK);
        for (size_t i = 0; i < blocks.count; i++) {
            const obj_block *block = &blocks.list[i];
            assert_ptr_equal(block->first, i ? blocks.list[i - 1].last : text);
            scan = (obj_scan){.at = block->first,
                              .last = block->last,
                              .line = line,
                              .plain = ffd_obj_is_plain(block->first, block->last)};
            line = list_statements(scan, cut);
        }
        assert_ptr_equal(blocks.list[blocks.count - 1].last, text + size);
        if (strcmp(whole, cut) != 0)
            fail_msg("seed 7, run %d, cut by %zu:\n%s\nnot\n%s", run, target, cut, whole);
        most_blocks = blocks.count > most_blocks ? blocks.count : most_blocks;
        ffd_obj_blocks_free(&blocks);
    }
    assert_in_range(most_blocks, 10, ROOM);
}

static void blocks_are_as_long_as_asked_for(void **state)
{
    (void)state;
    enum { LINES = 1000 };
    char text[8 * LINES + 1] = "";
    obj_blocks blocks;
    for (size_t i = 0; i < LINES; i++)
        memcpy(text + 8 * i, "v 1 2 3\n", 8);
    assert_int_equal(cut_text(text, 8 * LINES, 100, &blocks), FFD_OK);
    assert_int_equal(blocks.count, 8 * LINES / 104 + 1);
    for (size_t i = 0; i + 1 < blocks.count; i++)
        assert_int_equal(blocks.list[i].last - blocks.list[i].first, 104);
    ffd_obj_blocks_free(&blocks);
    assert_int_equal(cut_text(text, 0, 100, &blocks), FFD_OK);
    assert_int_equal(blocks.count, 1);
    ffd_obj_blocks_free(&blocks);
    ffd_alloc_fail_after(0);
    assert_int_equal(cut_text(text, 8, 100, &blocks), FFD_E_MEMORY);
    ffd_alloc_fail_after(-1);
    assert_null(blocks.list);
}

static const char *const arguments[] = {
    "1",
    "12/3/4",
    "1//2",
    "7/",
    "7/8/",
    "1/2/3/4",
    "-1",
    "-1/-2/-3",
    "+1",
    "/1",
    "x",
    "1x",
    "1.5",
    "1e3",
    "-.5",
    ".",
    "inf",
    "nan",
    "0x10",
    "3.1+e2",
    "1e",
    "1e+",
    "--1",
    "1#2",
    "1/#",
    "1\\\n2",
    "1\\2",
    "00012",
    "99999999999",
    "1e400",
    "1e-400",
    "+-1",
    "1/2 3",
    "1/2\t3",
    "1\n",
    "1\r\n",
    "",
    "123456789012345678",
    "1234567890123456789",
    "123456789012345678901/2/3",
    "1_000",
    "5,5",
    "1234567/7654321/1234567",
    "12345678/12345678/87654321",
    "123456789/1/1",
    "1/123456789",
    "1/1/123456789",
    "00000001/2",
    "12:4567890",
    "1/23?4567890",
    "/1/2",
    "//",
    "1/123456789/2",
    "1234567\2001",
    "1/2\377/34567890",
    "1/2/3                  ",
};

static bool same_index(obj_index a, obj_index b)
{
    return a.value == b.value && a.text.last - a.text.first == b.text.last - b.text.first &&
           (a.text.last == a.text.first || a.text.first == b.text.first);
}

static const char far[] = " 4/5/6 7/8/9 10/11/12 13/14/15 16/17/18 19/20/21\nf 1 2 3\n";

/* The number of vectors is estimated from the first line with one, if that is long enough for three
   numbers. */
static void vectors_are_estimated_by_the_first(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t vertices, normals;
    } cases[] = {
        {"v 1 2 3\nf 1 1 1\nf 1 1 1\nf 1 1 1\n", 4, 0},
        {"# a\no b\nvn 1 2 3\nf 1 1 1\nf 1 1 1\n", 0, 3},
        {"v 1 2\nf 1 1 1\nf 1 1 1\nf 1 1 1\n", 0, 0},
        {"vn\nf 1 1 1\nf 1 1 1\nf 1 1 1\n", 0, 0},
        {"v 1 2 3", 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        obj_blocks blocks;
        assert_int_equal(cut_text(cases[i].text, strlen(cases[i].text), 1000, &blocks), FFD_OK);
        assert_int_equal(blocks.vertices, cases[i].vertices);
        assert_int_equal(blocks.normals, cases[i].normals);
        ffd_obj_blocks_free(&blocks);
    }
}

/* The direct parser must take a whole word with the same meaning; else it takes nothing. */
static void arguments_are_read_as_words_are(void **state)
{
    (void)state;
    size_t numbers = 0, corners = 0;
    const size_t count = sizeof arguments / sizeof *arguments;
    for (size_t n = 0; n < 2 * count; n++) {
        char text[160];
        const size_t i = n % count; /* near the end of the file, and far from it */
        snprintf(text, sizeof text, "f  %s%s", arguments[i], n < count ? "" : far);
        obj_scan scan;
        text_word word;
        ffd_obj_scan_begin(&scan, text, strlen(text));
        assert_true(ffd_obj_scan_next(&scan));
        obj_scan by_word = scan, by_number = scan, by_corner = scan;
        double value = 0, expected = 0;
        obj_corner corner, expected_corner;
        const bool is_word = ffd_obj_scan_word(&by_word, &word);
        const bool is_number = is_word && ffd_obj_number(word, &expected);
        if (ffd_obj_scan_number(&by_number, &value)) {
            assert_true(is_number && memcmp(&value, &expected, sizeof value) == 0);
            assert_ptr_equal(by_number.at, by_word.at);
            numbers++;
        }
        const bool is_corner = is_word && ffd_obj_corner(word, &expected_corner);
        if (ffd_obj_scan_corner(&by_corner, &corner)) {
            assert_true(is_corner && same_index(corner.vertex, expected_corner.vertex) &&
                        same_index(corner.texcoord, expected_corner.texcoord) &&
                        same_index(corner.normal, expected_corner.normal));
            assert_ptr_equal(by_corner.at, by_word.at);
            corners++;
        } else {
            text_word again;
            assert_true(ffd_obj_scan_word(&by_corner, &again) == is_word);
            assert_ptr_equal(again.first, word.first);
            assert_ptr_equal(again.last, word.last);
        }
    }
    assert_in_range(numbers, 16, 100);
    assert_in_range(corners, 24, 100);
}

/* Three words at a time are the same as one by one, and so is what follows. */
static void words_are_read_as_one_by_one(void **state)
{
    (void)state;
    static const char drawn[] = "          aaaabbbb1111....\n\t\f\x01\x1f\x7f\xff";
    draw d = {draw_seed()};
    size_t complete = 0;
    for (int round = 0; round < 20000; round++) {
        char text[120] = "v ";
        const int size = draw_int(&d, 3, 119);
        const bool even = draw_int(&d, 0, 1);
        for (int i = 1; i < size; i++)
            text[i] = even ? (i % 9 == 1 ? ' ' : '5') : drawn[draw_int(&d, 0, sizeof drawn - 2)];
        if (even && size > 40)
            text[draw_int(&d, 20, 40)] = '\n';
        text[1] = ' ';
        obj_scan scan;
        ffd_obj_scan_begin(&scan, text, (size_t)size);
        scan.plain = ffd_obj_is_plain(text, text + size);
        assert_true(scan.plain && ffd_obj_scan_next(&scan));
        obj_scan one_by_one = scan;
        text_word words[3], word;
        const size_t count = ffd_obj_scan_words(&scan, words);
        for (size_t i = 0; i < count; i++) {
            assert_true(ffd_obj_scan_word(&one_by_one, &word));
            assert_ptr_equal(words[i].first, word.first);
            assert_ptr_equal(words[i].last, word.last);
        }
        assert_true(count == 3 || !ffd_obj_scan_word(&one_by_one, &word));
        assert_ptr_equal(scan.at, one_by_one.at);
        complete += count == 3;
    }
    assert_in_range(complete, 5000, 20000);
}

/* Appends a number, or almost one. */
static size_t put_number(draw *d, char *text)
{
    static const char odd[] = "0123456789..--+eE#\\/x\t\x01\xff";
    size_t size = 0;
    if (draw_int(d, 0, 2) == 0)
        text[size++] = '-';
    for (int before = draw_int(d, 0, draw_int(d, 0, 9) ? 3 : 18); before > 0; before--)
        text[size++] = (char)draw_int(d, '0', '9');
    if (draw_int(d, 0, 4))
        text[size++] = '.';
    for (int behind = draw_int(d, 0, draw_int(d, 0, 5) ? 7 : 18); behind > 0; behind--)
        text[size++] = (char)draw_int(d, '0', '9');
    if (size && draw_int(d, 0, 30) == 0)
        text[draw_int(d, 0, (int)size - 1)] = odd[draw_int(d, 0, sizeof odd - 2)];
    return size;
}

/* Draws a line of three numbers and possibly more, at the end of its block: reading past it is detected. */
static char *draw_line(draw *d, size_t *size)
{
    static const char *const ends[] = {"\n", "\r\n", "\r", " 1\n", "#\n", "\\\n", "\t\n", " \n"};
    char text[400] = "v";
    size_t at = 1;
    for (int i = 0; i < 3; i++) {
        text[at++] = draw_int(d, 0, 60) ? ' ' : '\t';
        if (draw_int(d, 0, 60) == 0)
            text[at++] = ' ';
        at += put_number(d, text + at);
    }
    at += (size_t)snprintf(text + at, 8, "%s", ends[draw_int(d, 0, 20) ? 0 : draw_int(d, 0, 7)]);
    for (int more = draw_int(d, 0, 120); more > 0; more--)
        text[at++] = (char)('0' + more % 10);
    char *const line = malloc(at);
    assert_non_null(line);
    memcpy(line, text, at);
    *size = at;
    return line;
}

/* Three numbers at a time are exactly those parsed one by one; what is refused is left in place. */
static void numbers_are_read_as_one_by_one(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t complete = 0;
    for (int round = 0; round < 40000; round++) {
        size_t size;
        char *const line = draw_line(&d, &size);
        obj_scan scan;
        double at_once[3], value;
        ffd_obj_scan_begin(&scan, line, size);
        assert_true(ffd_obj_scan_next(&scan));
        obj_scan one_by_one = scan;
        const char *const before = scan.at;
        if (ffd_obj_scan_numbers(&scan, at_once)) {
            for (int i = 0; i < 3; i++) {
                text_word word;
                assert_true(ffd_obj_scan_word(&one_by_one, &word) && ffd_obj_number(word, &value));
                assert_memory_equal(&at_once[i], &value, sizeof value);
            }
            assert_ptr_equal(scan.at, one_by_one.at);
            complete++;
        } else {
            assert_ptr_equal(scan.at, before);
        }
        free(line);
    }
    assert_in_range(complete, 10000, 40000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_cut_gives_the_same_statements),
        cmocka_unit_test(blocks_are_as_long_as_asked_for),
        cmocka_unit_test(vectors_are_estimated_by_the_first),
        cmocka_unit_test(arguments_are_read_as_words_are),
        cmocka_unit_test(words_are_read_as_one_by_one),
        cmocka_unit_test(numbers_are_read_as_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
