#include "lattice/spec_set.h"
#include <string.h>

/* The name in {"$": "NAME"}; NULL: it is no placeholder. */
static const char *placeholder_name(const json_t *value)
{
    if (!json_is_object(value) || json_object_size(value) != 1)
        return NULL;
    return json_string_value(json_object_get(value, "$"));
}

/* A value is what it says as JSON, or else a text. */
static json_t *parse_value(const char *text)
{
    json_t *const value =
        json_loads(text, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, NULL);
    return value ? value : json_string(text);
}

static ffd_status find_value(const json_place *place, const char *name, const spec_settings *settings,
                             json_t **value)
{
    for (size_t i = 0; i < settings->count; i++)
        if (strcmp(settings->values[i].name, name) == 0) {
            settings->used[i] = true;
            *value = parse_value(settings->values[i].value);
            return *value ? FFD_OK
                          : ffd_place_fail(
                                place, "the value of \"%.60s\" is neither JSON nor a text in UTF-8", name);
        }
    return ffd_place_fail(place, "the placeholder \"%.60s\" has no value (--set %.60s=VALUE)", name, name);
}

/* *found: what comes in the place of a member or element, NULL: it stays, with what is in it filled. */
static ffd_status fill(json_place *place, json_t *value, const spec_settings *settings, json_t **found)
{
    const char *const name = placeholder_name(value);
    *found = NULL;
    return name ? find_value(place, name, settings, found) : ffd_spec_set(place, value, settings);
}

static ffd_status fill_members(json_place *place, json_t *object, const spec_settings *settings)
{
    ffd_status status = FFD_OK;
    for (void *at = json_object_iter(object); at && !status; at = json_object_iter_next(object, at)) {
        const size_t before = ffd_place_enter(place, json_object_iter_key(at));
        json_t *found;
        status = fill(place, json_object_iter_value(at), settings, &found);
        if (found)
            json_object_iter_set_new(object, at, found);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status fill_elements(json_place *place, json_t *array, const spec_settings *settings)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < json_array_size(array) && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        json_t *found;
        status = fill(place, json_array_get(array, i), settings, &found);
        if (found)
            json_array_set_new(array, i, found);
        ffd_place_leave(place, before);
    }
    return status;
}

ffd_status ffd_spec_set(json_place *place, json_t *moves, const spec_settings *settings)
{
    if (json_is_object(moves))
        return fill_members(place, moves, settings);
    return json_is_array(moves) ? fill_elements(place, moves, settings) : FFD_OK;
}
