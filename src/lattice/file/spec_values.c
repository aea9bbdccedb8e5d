#include "lattice/file/spec_values.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/number.h"
#include "base/vector/direction.h"
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

static bool is_known(const char *key, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(known[i], key) == 0)
            return true;
    return false;
}

/* Keys of other programs, for which the most similar known key would be a wrong suggestion. */
static ffd_status refuse_foreign(json_cursor cursor, const char *const *known, size_t count)
{
    static const struct foreign {
        const char *word, *key;
    } words[] = {{"translate", "by"},
                 {"translation", "by"},
                 {"move", "by"},
                 {"offset", "by"},
                 {"delta", "by"},
                 {"displace", "by"},
                 {"position", "to"},
                 {"rotation", "rotate"},
                 {"turn", "rotate"},
                 {"angle", "degrees"},
                 {"deg", "degrees"},
                 {"shear", "matrix"},
                 {"skew", "matrix"},
                 {"transform", "matrix"},
                 {"center", "about"},
                 {"pivot", "about"},
                 {"grab", "pull"},
                 {"reflect", "mirror"},
                 {"symmetry", "mirror"},
                 {"symmetric", "mirror"},
                 {"fade", "falloff"},
                 {"decay", "falloff"},
                 {"attenuation", "falloff"},
                 {"center", "point"},
                 {"about", "point"},
                 {"place", "point"},
                 {"vector", "by"},
                 {"about", "center"},
                 {"point", "center"},
                 {"start", "from"},
                 {"end", "to"},
                 {"select", "at"},
                 {"selection", "at"},
                 {"points", "at"},
                 {"index", "at"},
                 {"indices", "at"},
                 {"region", "within"},
                 {"box", "within"},
                 {"keyframes", "keys"},
                 {"frames", "keys"},
                 {"animation", "keys"},
                 {"seconds", "time"},
                 {"values", "set"},
                 {"//", "comment"},
                 {"_comment", "comment"},
                 {"description", "comment"},
                 {"note", "comment"},
                 {"direction", "axis"},
                 {"distance", "radius"},
                 {"size", "radius"}};
    for (size_t i = 0; i < COUNT_OF(words); i++) {
        json_cursor member = cursor;
        member.value = ffd_json_tree_member(cursor.tree, cursor.value, words[i].word);
        if (ffd_cursor_exists(member) && is_known(words[i].key, known, count) &&
            !is_known(words[i].word, known, count))
            return ffd_cursor_fail(member, "unknown key \"%s\"; use \"%s\"", words[i].word, words[i].key);
    }
    return FFD_OK;
}

/* Keys of a move or a lattice that would select a part of the mesh, as {only} does. */
static ffd_status refuse_parts(json_cursor cursor, const char *const *known, size_t count)
{
    static const char *const kinds[] = {"node", "mesh", "material", "group", "object"};
    const bool moves = is_known("at", known, count) || is_known("moves", known, count);
    for (size_t i = 0; i < COUNT_OF(kinds) && moves; i++) {
        json_cursor member = cursor;
        member.value = ffd_json_tree_member(cursor.tree, cursor.value, kinds[i]);
        if (ffd_cursor_exists(member))
            return ffd_cursor_fail(member, "unknown key \"%s\"; a part of the mesh is selected by %s %s:NAME",
                                   kinds[i], SPELLED("{only}"), kinds[i]);
    }
    return FFD_OK;
}

ffd_status ffd_spec_check_notes(json_cursor object)
{
    static const char *const keys[] = {SPEC_NOTES};
    for (size_t i = 0; i < COUNT_OF(keys); i++) {
        /* Read without substitutes, because notes have no placeholders. */
        json_cursor note = object;
        note.value = ffd_json_tree_member(object.tree, object.value, keys[i]);
        if (ffd_cursor_exists(note) && !ffd_cursor_is(note, JSON_STRING))
            return ffd_cursor_fail(note, "must be a text, not %s", ffd_json_describe(note).text);
    }
    return FFD_OK;
}

ffd_status ffd_spec_read_object(json_cursor cursor, const char *const *known, size_t count)
{
    TRY(refuse_foreign(cursor, known, count));
    TRY(refuse_parts(cursor, known, count));
    TRY(ffd_json_read_object(cursor, known, count));
    return ffd_spec_check_notes(cursor);
}

ffd_status ffd_spec_read_points(json_cursor cursor, size_t count, double **points)
{
    TRY(ffd_json_read_array(cursor, count, "points"));
    *points = ffd_alloc(count, 3 * sizeof **points);
    if (!*points)
        return ffd_fail_memory(cursor.file->error);
    json_cursor point = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count; i++, point = ffd_cursor_next(point))
        TRY(ffd_json_read_doubles(point, 3, *points + 3 * i));
    return FFD_OK;
}

ffd_status ffd_spec_read_path(json_cursor cursor, char **path)
{
    *path = NULL;
    if (!ffd_cursor_is(cursor, JSON_STRING))
        return ffd_cursor_fail(cursor, "is %s, not the name of a file", ffd_json_describe(cursor).text);
    *path = ffd_json_tree_string(cursor.tree, cursor.value, NULL);
    if (!*path)
        return ffd_fail_memory(cursor.file->error);
    if (**path && strcmp(*path, "-") != 0)
        return FFD_OK;
    ffd_free(*path);
    *path = NULL;
    return ffd_cursor_fail(cursor, "is %s, not the name of a file", ffd_json_describe(cursor).text);
}

ffd_status ffd_spec_read_ends(json_cursor object, double min[3], double max[3])
{
    TRY(ffd_json_member_doubles(object, "min", 3, min));
    return ffd_json_member_doubles(object, "max", 3, max);
}

ffd_status ffd_spec_read_positive(json_cursor object, const char *key, double *value)
{
    TRY(ffd_json_member_double(object, key, value));
    if (*value > 0)
        return FFD_OK;
    return ffd_cursor_fail(ffd_cursor_member(object, key), "%s %s is not more than 0", key,
                           ffd_number_text(*value).text);
}

/* Refuses an axis with a sign, such as "-y" or "y-": the word without it turns the other way. */
static ffd_status refuse_sign(json_cursor cursor)
{
    static const char *const signs[] = {"-x", "-y", "-z", "-X", "-Y", "-Z",
                                        "x-", "y-", "z-", "X-", "Y-", "Z-"};
    for (size_t i = 0; i < COUNT_OF(signs); i++)
        if (ffd_json_tree_string_is(cursor.tree, cursor.value, signs[i]))
            return ffd_cursor_fail(cursor, "the axis \"%s\" has a sign; write [%s] for that direction",
                                   signs[i],
                                   i % 3 == 0   ? "-1, 0, 0"
                                   : i % 3 == 1 ? "0, -1, 0"
                                                : "0, 0, -1");
    return FFD_OK;
}

ffd_status ffd_spec_read_axis(json_cursor object, const char *key, double axis[3])
{
    static const char *const names[] = {"x", "y", "z"};
    json_cursor cursor;
    TRY(ffd_json_require(object, key, &cursor));
    if (ffd_cursor_is(cursor, JSON_STRING)) {
        size_t index;
        TRY(refuse_sign(cursor));
        TRY(ffd_json_read_word(cursor, names, COUNT_OF(names), &index));
        for (size_t c = 0; c < 3; c++)
            axis[c] = c == index;
        return FFD_OK;
    }
    TRY(ffd_json_read_doubles(cursor, 3, axis));
    return ffd_direction_unit(axis) ? FFD_OK
                                    : ffd_cursor_fail(cursor, "must not be 0 0 0: that is not a direction");
}
