/* setting_text.c - reads settings from texts as users write them (public: ffd/settings.h). */
#include "base/arithmetic.h"
#include "base/fail.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/size.h"
#include "base/text/words.h"
#include "io/format_names.h"
#include "job/input/rigid_parts.h"
#include "job/input/setting_lists.h"
#include "job/input/settings.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a text is read into. */
typedef struct reading {
    const ffd_member *member;
    char *at; /* the member in its struct */
    char *base;
    const char *text;
    ffd_error *error;
} reading;

/* Fails with what is wrong, and the member in front of it. between: ": " or " ". */
static ffd_status refuse(const reading *r, const char *between, const char *format, ...) FFD_PRINTF(3, 4);

static ffd_status refuse(const reading *r, const char *between, const char *format, ...)
{
    char name[64], what[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    snprintf(name, sizeof name, "%s", r->member->name);
    if (*name != '-')
        ffd_spelling()(r->member->name, NULL, name, sizeof name);
    return ffd_fail(r->error, FFD_E_ARGUMENT, "%s%s%s", name, between, what);
}

/* Numbers */

/* Excludes what strtod also accepts: spaces, hexadecimal numbers, infinities, a locale's comma. */
static bool parse_number(const char *text, double *value)
{
    if (!*text || strspn(text, "+-.0123456789eE") != strlen(text))
        return false;
    char *end;
    *value = strtod(text, &end);
    return *end == 0 && isfinite(*value);
}

static ffd_status read_positive(const reading *r)
{
    double number;
    if (!parse_number(r->text, &number) || !(number > 0))
        return refuse(r, ": ", "\"%s\" is not a number above 0", r->text);
    *(double *)(void *)r->at = number;
    return FFD_OK;
}

static ffd_status read_distance(const reading *r)
{
    char digits[512];
    double number;
    const size_t length = strlen(r->text);
    const bool is_relative = length > 0 && r->text[length - 1] == 'r';
    if (length < sizeof digits) {
        memcpy(digits, r->text, length);
        digits[length - is_relative] = 0;
        if (parse_number(digits, &number) && number >= 0) {
            *(double *)(void *)r->at = number;
            *(bool *)(r->base + r->member->second) = is_relative;
            return FFD_OK;
        }
    }
    return refuse(r, ": ", "\"%s\" is not a number of at least 0, alone or followed by r", r->text);
}

static ffd_status read_moment(const reading *r)
{
    double number;
    if (!parse_number(r->text, &number))
        return refuse(r, ": ", "\"%s\" is not a number of seconds", r->text);
    *(double *)(void *)r->at = number;
    *(bool *)(r->base + r->member->second) = true;
    return FFD_OK;
}

static ffd_status read_count(const reading *r)
{
    char *end;
    errno = 0;
    const long count = strtol(r->text, &end, 10);
    if (*r->text < '0' || *r->text > '9' || *end || errno || count < 1 || count > 1024)
        return refuse(r, ": ", "\"%s\" is not a whole number from 1 to 1024", r->text);
    *(int *)(void *)r->at = (int)count;
    return FFD_OK;
}

static ffd_status read_bytes(const reading *r)
{
    return ffd_size_parse(r->text, (uint64_t *)(void *)r->at)
               ? FFD_OK
               : refuse(r, ": ", "\"%s\" is not a size in bytes, as 700M or 4G", r->text);
}

/* Words */

static ffd_status read_choice(const reading *r)
{
    char known[200] = "";
    size_t count = 0;
    for (; r->member->words[count]; count++) {
        if (strcmp(r->member->words[count], r->text) == 0) {
            *(int *)(void *)r->at = (int)count;
            return FFD_OK;
        }
        const size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", count ? ", " : "", r->member->words[count]);
    }
    const char *const meant = ffd_word_meant(r->text, r->member->words, count);
    return refuse(r, ": ", "\"%s\" is not one of %s%s%s%s", r->text, known, meant ? " (nearest: " : "",
                  meant ? meant : "", meant ? ")" : "");
}

static ffd_status read_format(const reading *r)
{
    char name[32];
    snprintf(name, sizeof name, "x.%s", r->text[0] == '.' ? r->text + 1 : r->text);
    /* No ending of a file's name says it. */
    const bool is_foam = ffd_path_has_ending(name, ".foam");
    const ffd_format format = is_foam                ? FFD_FORMAT_FOAM
                              : strlen(r->text) < 16 ? ffd_format_from_name(name)
                                                     : FFD_FORMAT_AUTO;
    if (format == FFD_FORMAT_AUTO)
        return refuse(r, ": ", "\"%s\" is not one of " FFD_FORMAT_NAMES, r->text);
    *(ffd_format *)(void *)r->at = format;
    return FFD_OK;
}

/* Reads "u-,v+", "all" or "cut". Returns false if they are not faces. */
static bool parse_faces(const char *text, unsigned *faces)
{
    *faces = strcmp(text, "all") == 0 ? FFD_FACES_ALL : FFD_FACES_CUT;
    if (strcmp(text, "all") == 0 || strcmp(text, "cut") == 0)
        return true;
    for (;; text += 3) {
        const char *const direction = *text ? strchr("uvw", text[0]) : NULL;
        if (!direction || (text[1] != '-' && text[1] != '+') || (text[2] && text[2] != ','))
            return false;
        *faces |= 1u << (2 * (*direction - 'u') + (text[1] == '+'));
        if (!text[2])
            return true;
    }
}

/* Reads "C1" or "C1:u-,v+". */
static ffd_status read_seam(const reading *r)
{
    const size_t length = strcspn(r->text, ":");
    const char *const *const words = r->member->words;
    unsigned faces = FFD_FACES_CUT;
    int seam = 0;
    while (words[seam] && (strlen(words[seam]) != length || memcmp(words[seam], r->text, length) != 0))
        seam++;
    if (!words[seam] || (r->text[length] && !parse_faces(r->text + length + 1, &faces)))
        return refuse(
            r, ": ",
            "\"%.100s\" is not C0, C1, C2 or none, alone or with faces (u-,v+,.. or all or cut), like "
            "C1:u-,v+",
            r->text);
    *(int *)(void *)r->at = seam;
    *(unsigned *)(void *)(r->base + r->member->second) = faces;
    return FFD_OK;
}

static ffd_status read_text(const reading *r)
{
    const char **const text = (const char **)(void *)r->at;
    if (!*r->text)
        return refuse(r, ": ", "the value is empty");
    if (*text)
        return refuse(r, " ", "is given twice: \"%s\" and \"%s\"", *text, r->text);
    *text = r->text;
    return FFD_OK;
}

static ffd_status read_weight(const reading *r)
{
    TRY(*r->text ? ffd_weight_check(r->text, r->error) : FFD_OK);
    return read_text(r);
}

/* Gates */

/* A gate, in the order of the words. */
typedef struct gate_word {
    ffd_gate gate;
    const char *limit; /* what its limit is called; NULL: it has none */
    const char *sign;  /* what stands for it in messages */
} gate_word;

static const gate_word gates[] = {
    {FFD_GATE_FOLDS, NULL, NULL},
    {FFD_GATE_OUTSIDE, NULL, NULL},
    {FFD_GATE_MULTIPLE, NULL, NULL},
    {FFD_GATE_SINGULAR, NULL, NULL},
    {FFD_GATE_INVALID, NULL, NULL},
    {FFD_GATE_TEAR, "length", "LENGTH"},
    {FFD_GATE_TEAR, "length", "LENGTH"},
    {FFD_GATE_FLIPPED, "number", "N"},
    {FFD_GATE_FLIPPED, "number", "N"},
    {FFD_GATE_EDGES, "length", "LENGTH"},
    {FFD_GATE_INVERTED, "number", "N"},
    {FFD_GATE_INVERTED, "number", "N"},
    {FFD_GATE_QUALITY, "scaled Jacobian", "MIN"},
};

static bool is_limit(const gate_word *word, double value)
{
    if (word->gate == FFD_GATE_QUALITY)
        return value >= -1 && value <= 1;
    return value >= 0 && (*word->limit != 'n' || (value < 0x1p53 && value == floor_of(value)));
}

/* Sets the limit of a gate; of several the strictest counts. name: of the gate, before any '='. text: the
   limit, followed by the rest of the list; NULL: none. */
static ffd_status set_limit(const reading *r, ffd_deform_desc *desc, const gate_word *word, const char *name,
                            const char *text, size_t length)
{
    const bool is_first = !(desc->fail_on & (unsigned)word->gate);
    char copy[64] = "";
    double value = 0;
    bool valid = !text;
    if (text && length < sizeof copy) {
        memcpy(copy, text, length);
        valid = parse_number(copy, &value) && is_limit(word, value);
    }
    if (!valid)
        return refuse(r, ": ", "\"%.*s\" is not a %s of the gate %.*s", (int)(length < 60 ? length : 60),
                      text, word->limit, (int)strcspn(name, "="), name);
    if (word->gate == FFD_GATE_TEAR)
        value = text ? value : -1;
    if (word->gate == FFD_GATE_TEAR && (is_first || value < desc->tear_most))
        desc->tear_most = value;
    if (word->gate == FFD_GATE_EDGES && (is_first || value < desc->edges_most))
        desc->edges_most = value;
    if (word->gate == FFD_GATE_FLIPPED && (is_first || (uint64_t)value < desc->flipped_most))
        desc->flipped_most = (uint64_t)value;
    if (word->gate == FFD_GATE_INVERTED && (is_first || (uint64_t)value < desc->inverted_most))
        desc->inverted_most = (uint64_t)value;
    if (word->gate == FFD_GATE_QUALITY && (is_first || value > desc->quality_least))
        desc->quality_least = value;
    return FFD_OK;
}

/* Whether a word is this gate's name. A name that ends in '=' is followed by a limit. */
static bool is_gate(const char *name, const char *word, size_t length)
{
    const size_t size = strlen(name);
    const bool has_limit = name[size - 1] == '=';
    return (has_limit ? length >= size : length == size) && memcmp(name, word, size) == 0;
}

/* Lists the gates: "folds, tear, edges". Those with and without a limit follow each other. */
static void list_gates(const char *const *words, char *text, size_t capacity)
{
    size_t used = 0;
    for (size_t i = 0; words[i] && used < capacity; i++) {
        const size_t length = strcspn(words[i], "=");
        if (i == 0 || strncmp(words[i], words[i - 1], length) != 0)
            used += (size_t)snprintf(text + used, capacity - used, "%s%.*s", i ? ", " : "", (int)length,
                                     words[i]);
    }
}

static ffd_status add_gate(const reading *r, ffd_deform_desc *desc, const char *word, size_t length)
{
    nearest_word nearest = {.word = word, .length = strcspn(word, "=,")};
    for (size_t i = 0; r->member->words[i]; i++) {
        const char *const name = r->member->words[i];
        const size_t size = strlen(name);
        if (is_gate(name, word, length)) {
            const char *const limit = name[size - 1] == '=' ? word + size : NULL;
            const ffd_status status =
                gates[i].limit ? set_limit(r, desc, &gates[i], name, limit, limit ? length - size : 0)
                               : FFD_OK;
            desc->fail_on |= (unsigned)gates[i].gate;
            return status;
        }
        ffd_nearest_offer(&nearest, name);
    }
    for (size_t i = 0; r->member->words[i]; i++) {
        const size_t size = strcspn(r->member->words[i], "=");
        if (r->member->words[i][size] && length == size && memcmp(r->member->words[i], word, size) == 0)
            return refuse(r, ": ", "the gate %.*s needs a %s: %.*s=%s", (int)size, word, gates[i].limit,
                          (int)size, word, gates[i].sign);
        if (!r->member->words[i][size] && length > size && word[size] == '=' &&
            memcmp(r->member->words[i], word, size) == 0)
            return refuse(r, ": ", "the gate %.*s takes no value: \"%.*s\"", (int)size, word,
                          (int)(length < 60 ? length : 60), word);
    }
    char known[200];
    list_gates(r->member->words, known, sizeof known);
    const char *const meant = ffd_nearest_meant(&nearest);
    return refuse(r, ": ", "unknown gate \"%.*s\" (%s%s)", (int)(length < 60 ? length : 60), word,
                  meant ? "nearest: " : "known: ", meant ? meant : known);
}

/* Reads a list such as "folds,outside". */
static ffd_status read_gates(const reading *r)
{
    ffd_deform_desc *const desc = (ffd_deform_desc *)(void *)(r->at - offsetof(ffd_deform_desc, fail_on));
    const ffd_deform_desc before = *desc;
    const char *word = r->text;
    for (;;) {
        const size_t length = strcspn(word, ",");
        const ffd_status status = add_gate(r, desc, word, length);
        if (status)
            *desc = before;
        if (status || !word[length])
            return status;
        word += length + 1;
    }
}

/* Lists */

static ffd_status add_text(const reading *r)
{
    const char **const element = ffd_setting_list_add(r->member, r->base);
    if (!element)
        return ffd_fail_memory(r->error);
    *element = r->text;
    return FFD_OK;
}

static ffd_status read_name(const reading *r)
{
    return *r->text ? add_text(r) : refuse(r, ": ", "the name is empty");
}

static ffd_status read_selector(const reading *r)
{
    const ffd_member *const member = r->member; /* a front end has a name of its own for it */
    TRY(!member->option || strcmp(member->option, "only") == 0
            ? ffd_selector_check(r->text, r->error)
            : ffd_rigid_check(member->option, r->text, r->error));
    return add_text(r);
}

static ffd_status read_clip(const reading *r)
{
    TRY(ffd_clip_check(r->text, r->error));
    return read_name(r);
}

/* Reads NAME=VALUE. */
static ffd_status read_value(const reading *r)
{
    const char *const equals = strchr(r->text, '=');
    const size_t length = equals ? (size_t)(equals - r->text) : 0;
    bool is_new = false;
    if (length == 0)
        return refuse(r, ": ", "\"%s\" is not NAME=VALUE", r->text);
    ffd_setting *const element = ffd_setting_list_add(r->member, r->base);
    const char *const name =
        element ? ffd_setting_list_name(r->member, r->base, r->text, length, &is_new) : NULL;
    if (name && is_new) {
        *element = (ffd_setting){name, equals + 1};
        return FFD_OK;
    }
    if (element)
        ffd_setting_list_drop(r->member, r->base);
    return name ? refuse(r, ": ", "\"%.*s\" is set twice", (int)length, r->text) : ffd_fail_memory(r->error);
}

static ffd_status read_lattice(const reading *r)
{
    ffd_deform_desc *const desc = (ffd_deform_desc *)(void *)r->base;
    if (!*r->text)
        return refuse(r, ": ", "the value is empty");
    return ffd_setting_lattice_add(desc, r->text) ? FFD_OK : ffd_fail_memory(r->error);
}

/* Copies a quoted name, in which a doubled quote stands for one. Returns the position behind it; NULL: the
   closing quote is missing. */
static const char *copy_quoted(const char *text, char *name)
{
    for (const char *c = text + 1; *c; c++) {
        if (*c == '\'' && c[1] != '\'') {
            *name = 0;
            return c + 1;
        }
        c += *c == '\'';
        *name++ = *c;
    }
    return NULL;
}

/* Copies a name up to '='. */
static const char *copy_name(const char *text, char *name)
{
    const size_t length = strcspn(text, "=");
    memcpy(name, text, length);
    name[length] = 0;
    return strpbrk(name, " \t,") ? NULL : text + length;
}

/* Reads NAME=LATTICE. */
static ffd_status read_morph(const reading *r)
{
    ffd_deform_desc *const desc = (ffd_deform_desc *)(void *)r->base;
    char *const name = ffd_alloc(strlen(r->text) + 1, 1);
    if (!name)
        return ffd_fail_memory(r->error);
    const char *const rest = *r->text == '\'' ? copy_quoted(r->text, name) : copy_name(r->text, name);
    const char *why = !rest || *rest != '=' || !*name
                          ? "is not NAME=LATTICE (a name with blanks, '=' or ',' is in single quotes)"
                      : !rest[1] ? "names no lattice"
                                 : NULL;
    ffd_status status = FFD_OK;
    bool is_new = true;
    if (!why && !ffd_setting_morph_add(desc, name, rest + 1, &is_new))
        status = ffd_fail_memory(r->error);
    else if (!why && !is_new)
        why = "has the name of another morph target";
    if (why)
        status = refuse(r, ": ", "\"%s\" %s", r->text, why);
    ffd_free(name);
    return status;
}

ffd_status ffd_member_read(const ffd_member *member, void *desc, const char *text, ffd_error *error)
{
    static ffd_status (*const readers[])(const reading *) = {
        [FFD_MEMBER_CHOICE] = read_choice,
        [FFD_MEMBER_FORMAT] = read_format,
        [FFD_MEMBER_COUNT] = read_count,
        [FFD_MEMBER_LENGTH] = read_positive,
        [FFD_MEMBER_DISTANCE] = read_distance,
        [FFD_MEMBER_TIME] = read_positive,
        [FFD_MEMBER_MOMENT] = read_moment,
        [FFD_MEMBER_BYTES] = read_bytes,
        [FFD_MEMBER_GATES] = read_gates,
        [FFD_MEMBER_TEXT] = read_text,
        [FFD_MEMBER_TEXTS] = read_name,
        [FFD_MEMBER_SELECTORS] = read_selector,
        [FFD_MEMBER_CLIPS] = read_clip,
        [FFD_MEMBER_VALUES] = read_value,
        [FFD_MEMBER_LATTICES] = read_lattice,
        [FFD_MEMBER_MORPHS] = read_morph,
        [FFD_MEMBER_OBJECT] = NULL,
        [FFD_MEMBER_WEIGHT] = read_weight,
        [FFD_MEMBER_SEAM] = read_seam,
    };
    char *const base = desc;
    const reading r = {member, base + member->offset, base, text, error};
    const bool is_flag = member->kind == FFD_MEMBER_FLAG;
    if (is_flag && text)
        return refuse(&r, " ", "takes no value");
    if (!is_flag && !text)
        return refuse(&r, " ", "needs a value");
    if (!is_flag)
        return readers[member->kind] ? readers[member->kind](&r) : refuse(&r, " ", "cannot be a text");
    *(bool *)r.at = true;
    return FFD_OK;
}
