#include "io/stl/stl_text.h"
#include "base/text/number.h"
#include <math.h>
#include <string.h>

typedef struct text_reader {
    text_scan *scan;
    const char *name;
    ffd_error *error;
} text_reader;

void ffd_stl_text_begin(stl_text *text, const void *data, size_t size, mesh_flaws *flaws)
{
    *text = (stl_text){.flaws = flaws};
    ffd_text_begin(&text->scan, data, ffd_text_size(data, size), false);
}

bool ffd_stl_text_normal(text_word word, double *value)
{
    const char *end = ffd_number_parse(word.first, word.last, value);
    if (end && end != word.last)
        *value = NAN;
    return end;
}

static ffd_status refuse_word(text_reader *r, const char *expected, text_word word)
{
    return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan->line, "expected %s, found \"%s\"",
                         expected, ffd_text_shown(word).text);
}

static ffd_status take_word(text_reader *r, const char *expected, text_word *word)
{
    if (!ffd_text_find(r->scan))
        return ffd_fail_line(r->error, FFD_E_INVALID, r->name, r->scan->line,
                             "the file ends where %s is expected", expected);
    ffd_text_word(r->scan, word);
    return FFD_OK;
}

static ffd_status take_keyword(text_reader *r, const char *keyword)
{
    text_word word;
    TRY(take_word(r, keyword, &word));
    if (ffd_text_is_any_case(word, keyword))
        return FFD_OK;
    return refuse_word(r, keyword, word);
}

static ffd_status take_normal(text_reader *r, text_word normal[3])
{
    double value;
    for (int a = 0; a < 3; a++) {
        TRY(take_word(r, "a number of the normal", &normal[a]));
        if (!ffd_stl_text_normal(normal[a], &value))
            TRY(refuse_word(r, "a number of the normal", normal[a]));
    }
    return FFD_OK;
}

static ffd_status take_corner(text_reader *r, text_word corner[3])
{
    TRY(take_keyword(r, "vertex"));
    for (int a = 0; a < 3; a++) {
        double value;
        TRY(take_word(r, "a coordinate", &corner[a]));
        if (!ffd_text_number(corner[a], &value))
            TRY(refuse_word(r, "a coordinate", corner[a]));
    }
    return FFD_OK;
}

#define NOTE(reader, text, ...)                                                                              \
    ((text)->flaws                                                                                           \
         ? ffd_flaw_line((text)->flaws, (reader)->name, (text)->scan.line, (reader)->error, __VA_ARGS__)     \
         : FFD_OK)

/* Takes a second word after "end", such as "solid". Returns whether it is there. */
static bool takes_second_word(text_scan *scan, const char *second)
{
    text_scan ahead = *scan;
    text_word word;
    if (!ffd_text_word(&ahead, &word) || !ffd_text_is_any_case(word, second))
        return false;
    *scan = ahead;
    return true;
}

/* Takes a keyword "end..." that may be written as two words. */
static ffd_status take_end(text_reader *r, stl_text *text, const char *keyword)
{
    text_scan ahead = *r->scan;
    text_word word;
    if (ffd_text_find(&ahead) && ffd_text_word(&ahead, &word) && ffd_text_is_any_case(word, "end") &&
        takes_second_word(&ahead, keyword + strlen("end"))) {
        *r->scan = ahead;
        return NOTE(r, text, "\"endloop\" or \"endfacet\" is written as two words");
    }
    return take_keyword(r, keyword);
}

/* Reads the words after "facet". */
static ffd_status take_facet(text_reader *r, stl_text *text, stl_facet *facet)
{
    static const char *const before[] = {"outer", "loop"}, *const after[] = {"endloop", "endfacet"};
    TRY(take_keyword(r, "normal"));
    TRY(take_normal(r, facet->normal));
    for (size_t i = 0; i < 2; i++)
        TRY(take_keyword(r, before[i]));
    for (size_t i = 0; i < 3; i++)
        TRY(take_corner(r, facet->corners + 3 * i));
    for (size_t i = 0; i < 2; i++)
        TRY(take_end(r, text, after[i]));
    return FFD_OK;
}

/* Returns a name, which may have any number of words, and moves past it. */
static text_word pass_name(text_scan *scan)
{
    text_word name = {scan->at, scan->at}, word;
    for (bool first = true;; first = false) {
        text_scan ahead = *scan;
        if (!ffd_text_word(&ahead, &word))
            return name;
        if (ffd_text_is_any_case(word, "facet")) {
            text_word next;
            text_scan beyond = ahead;
            if (ffd_text_word(&beyond, &next) && ffd_text_is_any_case(next, "normal"))
                return name;
        }
        name = (text_word){first ? word.first : name.first, word.last};
        *scan = ahead;
    }
}

/* Takes the name of a solid where it begins or ends. */
static ffd_status take_name(text_reader *r, stl_text *text, text_word *name)
{
    *name = pass_name(r->scan);
    if (!memchr(name->first, 0, (size_t)(name->last - name->first)))
        return FFD_OK;
    return NOTE(r, text, "the name of a solid, \"%s\", holds a NUL character", ffd_text_shown(*name).text);
}

static ffd_status begin_solid(text_reader *r, stl_text *text)
{
    TRY(take_keyword(r, "solid"));
    text->solids++;
    text->inside = true;
    return take_name(r, text, &text->name);
}

/* Skips "color" and its numbers, if they come next. *passed: whether they did. */
static ffd_status pass_colour(text_reader *r, stl_text *text, bool *passed)
{
    text_word word;
    double value;
    text_scan ahead = text->scan;
    *passed = ffd_text_find(&ahead) && ffd_text_word(&ahead, &word) && ffd_text_is_any_case(word, "color");
    if (!*passed)
        return FFD_OK;
    do
        text->scan = ahead;
    while (ffd_text_word(&ahead, &word) && ffd_text_number(word, &value));
    return NOTE(r, text, "a line \"color\", which STL does not have, is kept as it is");
}

/* Handles a word other than "facet": it must end the solid. */
static ffd_status end_solid(text_reader *r, stl_text *text, text_word word)
{
    text_word name;
    ffd_status status = FFD_OK;
    if (ffd_text_is_any_case(word, "end") && takes_second_word(&text->scan, "solid"))
        status = NOTE(r, text, "\"endsolid\" is written as two words");
    else if (!ffd_text_is_any_case(word, "endsolid"))
        return refuse_word(r, "facet or endsolid", word);
    text->inside = false;
    return status ? status : take_name(r, text, &name);
}

/* Takes the next step inside a solid: a facet, or its end. */
static ffd_status step_inside(text_reader *r, stl_text *text, stl_facet *facet, stl_event *event)
{
    text_word word;
    bool passed = true;
    while (passed)
        TRY(pass_colour(r, text, &passed));
    TRY(take_word(r, "facet or endsolid", &word));
    facet->line = text->scan.line;
    if (ffd_text_is_any_case(word, "facet")) {
        *event = STL_AT_FACET;
        return take_facet(r, text, facet);
    }
    return end_solid(r, text, word);
}

ffd_status ffd_stl_text_step(stl_text *text, const char *name, stl_facet *facet, stl_event *event,
                             ffd_error *error)
{
    text_reader r = {&text->scan, name, error};
    *event = STL_AT_END;
    if (text->inside) {
        TRY(step_inside(&r, text, facet, event));
        if (*event == STL_AT_FACET)
            return FFD_OK;
    }
    if (!ffd_text_find(&text->scan))
        return FFD_OK;
    *event = STL_AT_SOLID;
    return begin_solid(&r, text);
}

ffd_status ffd_stl_text_next(stl_text *text, const char *name, stl_facet *facet, bool *found,
                             ffd_error *error)
{
    stl_event event;
    *found = false;
    do
        TRY(ffd_stl_text_step(text, name, facet, &event, error));
    while (event == STL_AT_SOLID);
    *found = event == STL_AT_FACET;
    return FFD_OK;
}
