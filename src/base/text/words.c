#include "base/text/words.h"
#include <ffd/program.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Longer words are compared by their first LONGEST letters. */
#define LONGEST 40

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

bool ffd_word_is_known(const char *word, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(word, known[i]) == 0)
            return true;
    return false;
}

/* Any locale's letters but ASCII's are compared as they are. */
static char small(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* The optimal string alignment distance. */
size_t ffd_word_distance(const char *a, size_t a_length, const char *b)
{
    const size_t m = least(a_length, LONGEST), n = least(strlen(b), LONGEST);
    size_t d[LONGEST + 1][LONGEST + 1];
    for (size_t i = 0; i <= m; i++)
        d[i][0] = i;
    for (size_t j = 0; j <= n; j++)
        d[0][j] = j;
    for (size_t i = 1; i <= m; i++)
        for (size_t j = 1; j <= n; j++) {
            const size_t replace = d[i - 1][j - 1] + (small(a[i - 1]) != small(b[j - 1]));
            d[i][j] = least(replace, least(d[i - 1][j], d[i][j - 1]) + 1);
            if (i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]))
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[m][n];
}

void ffd_nearest_offer(nearest_word *nearest, const char *known)
{
    const size_t distance = ffd_word_distance(nearest->word, nearest->length, known);
    nearest->is_tied =
        nearest->best && (nearest->is_tied ? distance >= nearest->distance : distance == nearest->distance);
    if (nearest->best && distance >= nearest->distance)
        return;
    nearest->best = known;
    nearest->distance = distance;
}

/* Whether the word is the best one with a minus: "-y" and "y-" are the other direction. */
static bool is_opposite(const nearest_word *nearest)
{
    const char *const word = nearest->word;
    const size_t length = nearest->length;
    return length > 1 && nearest->distance == 1 && length == strlen(nearest->best) + 1 &&
           (word[0] == '-' || word[length - 1] == '-');
}

const char *ffd_nearest_meant(const nearest_word *nearest)
{
    if (is_opposite(nearest))
        return NULL;
    const size_t known = strlen(nearest->best), longest = nearest->length > known ? nearest->length : known;
    const size_t twice = 2 * nearest->distance;
    return twice < longest || (twice == longest && !nearest->is_tied) ? nearest->best : NULL;
}

const char *ffd_nearest_word(const char *word, const char *const *known, size_t count)
{
    nearest_word nearest = {.word = word, .length = strlen(word)};
    for (size_t i = 0; i < count; i++)
        ffd_nearest_offer(&nearest, known[i]);
    return nearest.best;
}

const char *ffd_word_meant(const char *word, const char *const *known, size_t count)
{
    nearest_word nearest = {.word = word, .length = strlen(word)};
    for (size_t i = 0; i < count; i++)
        ffd_nearest_offer(&nearest, known[i]);
    return ffd_nearest_meant(&nearest);
}

void ffd_words_hint(const char *word, const char *const *known, size_t count, char *text, size_t capacity)
{
    const char *const meant = ffd_word_meant(word, known, count);
    if (meant) {
        snprintf(text, capacity, "the nearest known one is \"%s\"", meant);
        return;
    }
    size_t length = (size_t)snprintf(text, capacity, count == 1 ? "the only known one is" : "known ones are");
    for (size_t i = 0; i < count && length < capacity; i++)
        length += (size_t)snprintf(text + length, capacity - length, "%s \"%s\"", i ? "," : "", known[i]);
}

const char *ffd_plural(uint64_t count, const char *one, const char *many)
{
    return count == 1 ? one : many;
}

only_text ffd_only(uint64_t count, const char *note)
{
    only_text only;
    if (count > 0)
        snprintf(only.text, sizeof only.text, ", only %" PRIu64 "%s", count, note);
    else
        snprintf(only.text, sizeof only.text, ": the file has none");
    return only;
}

void ffd_name_shown(const char *name, char *shown, size_t capacity)
{
    size_t length = strlen(name);
    if (length >= capacity) {
        length = capacity - 1;
        while (length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80)
            length--;
    }
    memcpy(shown, name, length);
    shown[length] = 0;
    ffd_make_one_line(shown, length);
}

void ffd_bytes_shown(const char *bytes, size_t size, char *shown, size_t capacity)
{
    static const char symbol[] = "\xe2\x90\x80";
    size_t length = 0;
    for (size_t i = 0; i < size && length + sizeof symbol <= capacity; i++) {
        const char *const put = bytes[i] ? bytes + i : symbol;
        const size_t count = bytes[i] ? 1 : sizeof symbol - 1;
        memcpy(shown + length, put, count);
        length += count;
    }
    shown[length] = 0;
}
