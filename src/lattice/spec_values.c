#include "lattice/spec_values.h"
#include "base/memory/memory.h"
#include "lattice/direction.h"

ffd_status ffd_spec_read_points(json_cursor cursor, size_t count, double **points)
{
    ffd_status status = ffd_json_read_array(cursor, count, "points");
    if (status)
        return status;
    *points = ffd_alloc(count, 3 * sizeof **points);
    if (!*points)
        return ffd_fail_memory(cursor.file->error);
    json_cursor point = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count && !status; i++, point = ffd_cursor_next(point))
        status = ffd_json_read_doubles(point, 3, *points + 3 * i);
    return status;
}

ffd_status ffd_spec_read_axis(json_cursor object, const char *key, double axis[3])
{
    static const char *const names[] = {"x", "y", "z"};
    json_cursor cursor;
    ffd_status status = ffd_json_require(object, key, &cursor);
    if (status)
        return status;
    if (ffd_cursor_is(cursor, JSON_STRING)) {
        size_t index;
        status = ffd_json_read_word(cursor, names, sizeof names / sizeof *names, &index);
        for (size_t c = 0; c < 3; c++)
            axis[c] = c == index;
        return status;
    }
    status = ffd_json_read_doubles(cursor, 3, axis);
    if (status)
        return status;
    return ffd_direction_unit(axis) ? FFD_OK
                                    : ffd_cursor_fail(cursor, "must not be 0 0 0: that is not a direction");
}
