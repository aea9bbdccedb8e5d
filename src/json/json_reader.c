#include "json/json_reader.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void put(json_place *place, char c)
{
    if (place->length + 1 < sizeof place->pointer)
        place->pointer[place->length++] = c;
    place->pointer[place->length] = 0;
}

size_t ffd_place_enter(json_place *place, const char *key)
{
    const size_t before = place->length;
    put(place, '/');
    for (; *key; key++) {
        /* RFC 6901, 3: '~' and '/' are written "~0" and "~1". */
        if (*key == '~' || *key == '/') {
            put(place, '~');
            put(place, *key == '~' ? '0' : '1');
        } else {
            put(place, *key);
        }
    }
    return before;
}

size_t ffd_place_enter_index(json_place *place, size_t index)
{
    char text[24];
    snprintf(text, sizeof text, "%zu", index);
    return ffd_place_enter(place, text);
}

void ffd_place_leave(json_place *place, size_t before)
{
    place->length = before;
    place->pointer[before] = 0;
}

ffd_status ffd_place_fail(const json_place *place, const char *format, ...)
{
    char message[sizeof place->error->message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ffd_fail_at(place->error, FFD_E_INVALID, place->file, place->pointer, "%s", message);
}

json_words ffd_json_describe(const json_t *value)
{
    json_words words = {""};
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        snprintf(words.text, sizeof words.text, "an object");
        break;
    case JSON_ARRAY:
        snprintf(words.text, sizeof words.text, "an array of %zu", json_array_size(value));
        break;
    case JSON_STRING:
        snprintf(words.text, sizeof words.text, "the text \"%.60s\"", json_string_value(value));
        break;
    case JSON_INTEGER:
    case JSON_REAL:
        snprintf(words.text, sizeof words.text, "the number %s",
                 ffd_number_text(json_number_value(value)).text);
        break;
    case JSON_TRUE:
        snprintf(words.text, sizeof words.text, "true");
        break;
    case JSON_FALSE:
        snprintf(words.text, sizeof words.text, "false");
        break;
    case JSON_NULL:
        snprintf(words.text, sizeof words.text, "null");
        break;
    }
    return words;
}

static bool is_known(const char *key, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(key, known[i]) == 0)
            return true;
    return false;
}

ffd_status ffd_json_read_object(json_place *place, const json_t *value, const char *const *known,
                                size_t count)
{
    if (!json_is_object(value))
        return ffd_place_fail(place, "must be an object, not %s", ffd_json_describe(value).text);
    const char *key;
    json_t *member;
    /* The iterators only read, but their type is not const. */
    json_object_foreach((json_t *)value, key, member)
    {
        if (is_known(key, known, count))
            continue;
        ffd_place_enter(place, key);
        return ffd_place_fail(place, "unknown key \"%.80s\"; the nearest known one is \"%s\"", key,
                              ffd_nearest_word(key, known, count));
    }
    return FFD_OK;
}

ffd_status ffd_json_read_array(json_place *place, const json_t *value, size_t count, const char *what)
{
    if (!json_is_array(value))
        return ffd_place_fail(place, "must be an array of %zu %s, not %s", count, what,
                              ffd_json_describe(value).text);
    if (json_array_size(value) != count)
        return ffd_place_fail(place, "has %zu %s where %zu are needed", json_array_size(value), what, count);
    return FFD_OK;
}

ffd_status ffd_json_read_double(json_place *place, const json_t *value, double *number)
{
    if (!json_is_number(value))
        return ffd_place_fail(place, "must be a number, not %s", ffd_json_describe(value).text);
    *number = json_number_value(value);
    return FFD_OK;
}

ffd_status ffd_json_read_integer(json_place *place, const json_t *value, double *number)
{
    if (json_is_number(value)) {
        *number = json_number_value(value);
        if (*number == floor(*number) && fabs(*number) <= 0x1p53)
            return FFD_OK;
    }
    return ffd_place_fail(place, "must be a whole number, not %s", ffd_json_describe(value).text);
}

ffd_status ffd_json_read_doubles(json_place *place, const json_t *value, size_t count, double *numbers)
{
    ffd_status status = ffd_json_read_array(place, value, count, "numbers");
    for (size_t i = 0; i < count && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        status = ffd_json_read_double(place, json_array_get(value, i), &numbers[i]);
        ffd_place_leave(place, before);
    }
    return status;
}

ffd_status ffd_json_read_word(json_place *place, const json_t *value, const char *const *words, size_t count,
                              size_t *index)
{
    const char *const text = json_string_value(value);
    for (*index = 0; text && *index < count; ++*index)
        if (strcmp(text, words[*index]) == 0)
            return FFD_OK;
    if (text)
        return ffd_place_fail(place, "unknown word \"%.80s\"; the nearest known one is \"%s\"", text,
                              ffd_nearest_word(text, words, count));
    return ffd_place_fail(place, "must be a word like \"%s\", not %s", words[0],
                          ffd_json_describe(value).text);
}

ffd_status ffd_json_require(json_place *place, const json_t *object, const char *key, const json_t **member)
{
    *member = json_object_get(object, key);
    return *member ? FFD_OK : ffd_place_fail(place, "\"%s\" is missing", key);
}

ffd_status ffd_json_member_double(json_place *place, const json_t *object, const char *key, double *number)
{
    const json_t *member;
    ffd_status status = ffd_json_require(place, object, key, &member);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, key);
    status = ffd_json_read_double(place, member, number);
    ffd_place_leave(place, before);
    return status;
}

ffd_status ffd_json_member_doubles(json_place *place, const json_t *object, const char *key, size_t count,
                                   double *numbers)
{
    const json_t *member;
    ffd_status status = ffd_json_require(place, object, key, &member);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, key);
    status = ffd_json_read_doubles(place, member, count, numbers);
    ffd_place_leave(place, before);
    return status;
}
