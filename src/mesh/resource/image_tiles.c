#include "mesh/resource/image_tiles.h"
#include "base/text/buffer.h"
#include <string.h>

/* Tiles in a row of UDIM. */
#define ROW 10
#define FIRST_TILE 1001

static const char udim[] = "<UDIM>", uvtile[] = "<UVTILE>";

static const char *find(const char *name, const char **mark)
{
    const char *const found = strstr(name, udim);
    *mark = found ? udim : uvtile;
    return found ? found : strstr(name, uvtile);
}

bool ffd_image_has_tiles(const char *name)
{
    const char *mark;
    return find(name, &mark) != NULL;
}

char *ffd_image_tile(const char *name, size_t i)
{
    const char *mark, *const at = find(name, &mark);
    byte_buffer text = {0};
    ffd_buffer_append(&text, name, (size_t)(at - name));
    if (mark == udim)
        ffd_buffer_format(&text, "%zu", FIRST_TILE + i);
    else
        ffd_buffer_format(&text, "u%zu_v%zu", i % ROW + 1, i / ROW + 1);
    ffd_buffer_text(&text, at + strlen(mark));
    return ffd_buffer_finish(&text);
}
