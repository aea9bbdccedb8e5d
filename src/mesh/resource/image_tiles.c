#include "mesh/resource/image_tiles.h"
#include "base/text/buffer.h"
#include <string.h>

/* Tiles in a row of UDIM. */
#define ROW 10
#define FIRST_TILE 1001

/* No file has a longer name. A thousand tiles of a name as long as a file would take long. */
#define NAME_SIZE 4096

typedef enum tile_mark {
    MARK_UDIM,
    MARK_UVTILE,
    MARK_COLUMN,
    MARK_ROW,
    MARK_COLUMN_FROM_0,
    MARK_ROW_FROM_0
} tile_mark;

/* As programs write them. Letters that stand for numbers tell by their case where these begin. */
static const struct {
    const char *text;
    bool any_case;
    tile_mark mark;
} marks[] = {
    {"<UDIM>", true, MARK_UDIM},        {"%(UDIM)d", false, MARK_UDIM},  {"<UVTILE>", true, MARK_UVTILE},
    {"%(UVTILE)d", false, MARK_UVTILE}, {"<U>", false, MARK_COLUMN},     {"<V>", false, MARK_ROW},
    {"<u>", false, MARK_COLUMN_FROM_0}, {"<v>", false, MARK_ROW_FROM_0},
};

#define MARKS (sizeof marks / sizeof *marks)

static bool begins(const char *name, const char *mark, bool any_case)
{
    for (; *mark; name++, mark++) {
        const char letter = any_case && *name >= 'a' && *name <= 'z' ? (char)(*name - 'a' + 'A') : *name;
        if (letter != *mark)
            return false;
    }
    return true;
}

/* Returns the index of the mark that a text begins with; MARKS: none. */
static size_t mark_at(const char *text)
{
    size_t m = 0;
    while (m < MARKS && !begins(text, marks[m].text, marks[m].any_case))
        m++;
    return m;
}

bool ffd_image_has_tiles(const char *name)
{
    const char *at = name;
    while (*at && at < name + NAME_SIZE && mark_at(at) == MARKS)
        at++;
    return *at && strlen(at) < NAME_SIZE;
}

static void put_number(byte_buffer *text, tile_mark mark, size_t i)
{
    const size_t column = i % ROW, row = i / ROW;
    switch (mark) {
    case MARK_UDIM:
        ffd_buffer_format(text, "%zu", FIRST_TILE + i);
        break;
    case MARK_UVTILE:
        ffd_buffer_format(text, "u%zu_v%zu", column + 1, row + 1);
        break;
    case MARK_COLUMN:
    case MARK_COLUMN_FROM_0:
        ffd_buffer_format(text, "%zu", column + (mark == MARK_COLUMN));
        break;
    default:
        ffd_buffer_format(text, "%zu", row + (mark == MARK_ROW));
    }
}

char *ffd_image_tile(const char *name, size_t i)
{
    byte_buffer text = {0};
    while (*name) {
        const size_t m = mark_at(name);
        if (m < MARKS)
            put_number(&text, marks[m].mark, i);
        else
            ffd_buffer_append(&text, name, 1);
        name += m < MARKS ? strlen(marks[m].text) : 1;
    }
    return ffd_buffer_finish(&text);
}
