#include "mesh/morph/morph_clip.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "json/json_chars.h"
#include <ffd/job.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* The most bytes of a name or number that a message shows. */
#define SHOWN 64

typedef struct clip_parser {
    const char *at, *end;
    morph_clip *clip;
    char *word; /* buffer as long as the text: the name that was read last */
    size_t length;
    size_t *last_key; /* for each target: 1 + the last key that names it */
    size_t last_capacity;
    ffd_error *error;
} clip_parser;

/* Copies the text at the current position, up to a blank or a comma, for a message. */
static void show_place(const clip_parser *p, char shown[SHOWN])
{
    char word[SHOWN];
    const size_t length = strcspn(p->at, " \t,");
    const size_t kept = length < sizeof word - 1 ? length : sizeof word - 1;
    memcpy(word, p->at, kept);
    word[kept] = 0;
    ffd_name_shown(word, shown, SHOWN);
}

/* Fails with a message and the text at the current position. */
static ffd_status refuse(const clip_parser *p, const char *what)
{
    char name[SHOWN], place[SHOWN];
    show_place(p, place);
    if (!p->clip->name)
        return ffd_fail(p->error, FFD_E_ARGUMENT,
                        "{clips}: \"%s\" %s (\"NAME: TIME TARGET=WEIGHT ..., ...\")", place, what);
    ffd_name_shown(p->clip->name, name, sizeof name);
    return ffd_fail(p->error, FFD_E_ARGUMENT, "{clips}: clip \"%s\": \"%s\" %s", name, place, what);
}

static void skip_blanks(clip_parser *p)
{
    p->at += strspn(p->at, " \t");
}

/* Reads a name in quotes. */
static ffd_status read_quoted(clip_parser *p)
{
    for (const char *c = p->at + 1; *c; c++) {
        if (*c == '\'' && c[1] != '\'') {
            p->at = c + 1;
            return FFD_OK;
        }
        c += *c == '\'';
        p->word[p->length++] = *c;
    }
    return refuse(p, "begins a name in quotes that has no end");
}

/* Reads a name. Without quotes it ends before one of the characters `ends`. */
static ffd_status read_name(clip_parser *p, const char *ends)
{
    ffd_status status = FFD_OK;
    const char *const begin = p->at;
    p->length = 0;
    if (*p->at == '\'') {
        status = read_quoted(p);
    } else {
        p->length = strcspn(p->at, ends);
        memcpy(p->word, p->at, p->length);
        p->at += p->length;
    }
    p->word[p->length] = 0;
    TRY(status);
    if (p->length == 0) {
        p->at = begin;
        return refuse(p, "is where a name is missing");
    }
    if (ffd_utf8_is_valid(p->word, p->length))
        return FFD_OK;
    p->at = begin;
    return refuse(p, "is not a name in UTF-8");
}

/* Reads a number within the range of a float, which ends at a blank, a comma or the end. what: for the
   message. */
static ffd_status read_number(clip_parser *p, const char *what, double *value)
{
    const char *const end = ffd_number_parse(p->at, p->end, value);
    if (!end || (*end && !strchr(" \t,", *end)) || !(fabs(*value) <= (double)FLT_MAX))
        return refuse(p, what);
    p->at = end;
    return FFD_OK;
}

/* Reads TARGET=WEIGHT. */
static ffd_status read_weight(clip_parser *p)
{
    morph_clip *const clip = p->clip;
    const char *const begin = p->at;
    uint32_t target;
    double weight;
    TRY(read_name(p, " \t=,"));
    skip_blanks(p);
    if (*p->at != '=') {
        p->at = begin;
        return refuse(p, "is not TARGET=WEIGHT");
    }
    p->at++;
    skip_blanks(p);
    TRY(read_number(p, "is not a weight", &weight));
    const size_t known = clip->names.count;
    if (!ffd_intern(&clip->names, p->word, p->length, &target) ||
        !ffd_grow((void **)&p->last_key, &p->last_capacity, clip->names.count, sizeof *p->last_key) ||
        !ffd_grow((void **)&clip->weights, &clip->weight_capacity, clip->weight_count + 1,
                  sizeof *clip->weights))
        return ffd_fail_memory(p->error);
    if (known < clip->names.count)
        p->last_key[target] = 0;
    if (p->last_key[target] == clip->key_count) {
        p->at = begin;
        return refuse(p, "is a second weight of that target at one time");
    }
    p->last_key[target] = clip->key_count;
    clip->weights[clip->weight_count++] = (clip_weight){target, weight};
    return FFD_OK;
}

/* Reads a time. Files store times as floats, which must ascend after rounding. */
static ffd_status read_time(clip_parser *p)
{
    morph_clip *const clip = p->clip;
    const char *const begin = p->at;
    double time;
    TRY(read_number(p, "is not a time in seconds", &time));
    const float rounded = (float)time + 0.0f; /* -0 becomes 0 */
    p->at = begin;
    if (time < 0)
        return refuse(p, "is a time before 0");
    if (clip->key_count > 0 && !(rounded > clip->times[clip->key_count - 1]))
        return refuse(p, "is a time that is not later than the one before it (as float32)");
    p->at = begin + strcspn(begin, " \t,");
    if (!ffd_grow((void **)&clip->times, &clip->key_capacity, clip->key_count + 1, sizeof *clip->times) ||
        !ffd_grow((void **)&clip->starts, &clip->start_capacity, clip->key_count + 2, sizeof *clip->starts))
        return ffd_fail_memory(p->error);
    clip->times[clip->key_count] = rounded;
    clip->starts[clip->key_count++] = clip->weight_count;
    return FFD_OK;
}

/* Reads TIME TARGET=WEIGHT ... */
static ffd_status read_key(clip_parser *p)
{
    skip_blanks(p);
    TRY(read_time(p));
    for (skip_blanks(p); *p->at && *p->at != ','; skip_blanks(p))
        TRY(read_weight(p));
    p->clip->starts[p->clip->key_count] = p->clip->weight_count;
    return FFD_OK;
}

static ffd_status parse(clip_parser *p)
{
    skip_blanks(p);
    TRY(read_name(p, " \t=,:"));
    skip_blanks(p);
    if (*p->at != ':')
        return refuse(p, "is where \":\" after the clip's name is missing");
    p->clip->name = ffd_alloc(p->length + 1, 1);
    if (!p->clip->name)
        return ffd_fail_memory(p->error);
    memcpy(p->clip->name, p->word, p->length + 1);
    do {
        p->at++;
        TRY(read_key(p));
    } while (*p->at == ',');
    return FFD_OK;
}

ffd_status ffd_morph_clip_parse(const char *text, morph_clip *clip, ffd_error *error)
{
    const size_t length = strlen(text);
    clip_parser p = {
        .at = text, .end = text + length, .clip = clip, .word = ffd_alloc(length + 1, 1), .error = error};
    *clip = (morph_clip){0};
    const ffd_status status = p.word ? parse(&p) : ffd_fail_memory(error);
    ffd_free(p.word);
    ffd_free(p.last_key);
    return status;
}

static ffd_status refuse_target(const morph_clip *clip, const char *name, const intern_table *known,
                                ffd_error *error)
{
    char shown[SHOWN], clip_shown[SHOWN], best_shown[SHOWN];
    nearest_word nearest = {.word = name, .length = strlen(name)};
    for (uint32_t i = 0; i < known->count; i++)
        ffd_nearest_offer(&nearest, ffd_intern_key(known, i));
    ffd_name_shown(name, shown, sizeof shown);
    ffd_name_shown(clip->name, clip_shown, sizeof clip_shown);
    ffd_name_shown(nearest.best ? nearest.best : "", best_shown, sizeof best_shown);
    return ffd_fail(
        error, FFD_E_ARGUMENT,
        "{clips}: clip \"%s\": there is no morph target \"%s\", neither in the file nor new (nearest: "
        "\"%s\")",
        clip_shown, shown, best_shown);
}

/* names: of the clips before, `number` of them. */
static ffd_status check_name(const morph_clip *clip, size_t index, intern_table *names, ffd_error *error)
{
    uint32_t known;
    char shown[SHOWN];
    if (!ffd_intern(names, clip->name, strlen(clip->name), &known))
        return ffd_fail_memory(error);
    if (known == index)
        return FFD_OK;
    ffd_name_shown(clip->name, shown, sizeof shown);
    return ffd_fail(error, FFD_E_ARGUMENT, "{clips}: two clips are called \"%s\"", shown);
}

ffd_status ffd_morph_clips_check(const morph_clip *clips, size_t count, const intern_table *known,
                                 ffd_error *error)
{
    intern_table names = {0};
    ffd_status status = FFD_OK;
    for (size_t c = 0; c < count; c++) {
        TRY_END(check_name(&clips[c], c, &names, error));
        for (uint32_t n = 0; n < clips[c].names.count; n++) {
            const char *const name = ffd_intern_key(&clips[c].names, n);
            uint32_t index;
            if (!ffd_intern_find(known, name, strlen(name), &index))
                TRY_END(refuse_target(&clips[c], name, known, error));
        }
    }
end:
    ffd_intern_free(&names);
    return status;
}

void ffd_morph_clip_weights(const morph_clip *clip, size_t key, double *weights)
{
    for (uint32_t n = 0; n < clip->names.count; n++)
        weights[n] = 0;
    for (size_t i = clip->starts[key]; i < clip->starts[key + 1]; i++)
        weights[clip->weights[i].target] = clip->weights[i].weight;
}

void ffd_morph_clip_free(morph_clip *clip)
{
    ffd_free(clip->name);
    ffd_free(clip->times);
    ffd_free(clip->starts);
    ffd_free(clip->weights);
    ffd_intern_free(&clip->names);
    *clip = (morph_clip){0};
}

ffd_status ffd_clip_check(const char *text, ffd_error *error)
{
    morph_clip clip;
    const ffd_status status = ffd_morph_clip_parse(text, &clip, error);
    ffd_morph_clip_free(&clip);
    return status;
}
