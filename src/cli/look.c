#include "cli/look.h"
#include <stddef.h>
#include <string.h>

/* Limits of the side of a picture in pixels, and of pictures in a row. */
#define LEAST_SIDE 16
#define MOST_SIDE 32767
#define MOST_FRAMES 64

const char *const cli_side_names[] = {"front", "back", "left", "right", "top", "bottom", "iso", NULL};
/* In the order of ffd_up. */
const char *const cli_up_names[] = {"y", "z", "x", NULL};
/* In the order of ffd_view_color. */
const char *const cli_color_names[] = {"displacement", "status", "det", "plain", NULL};

static cli_look *look_of(void *settings, const cli_option *option)
{
    return (cli_look *)(void *)((char *)settings + option->offset);
}

/* Returns the index of a word; negative: it is none of them. */
static int index_of(const char *value, const char *const *words)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], value) == 0)
            return i;
    return -1;
}

static bool parse_direction(const char *value, double direction[3])
{
    for (int a = 0; a < 3; a++) {
        char part[64];
        const size_t length = strcspn(value, ",");
        if (length >= sizeof part || value[length] != (a < 2 ? ',' : 0))
            return false;
        memcpy(part, value, length);
        part[length] = 0;
        if (!cli_parse_number(part, &direction[a]))
            return false;
        value += length + 1;
    }
    return direction[0] < 0 || direction[0] > 0 || direction[1] < 0 || direction[1] > 0 || direction[2] < 0 ||
           direction[2] > 0;
}

bool cli_set_side(void *settings, const cli_option *option, const char *value)
{
    cli_look *const look = look_of(settings, option);
    const int side = index_of(value, cli_side_names);
    char hint[CLI_HINT];
    look->side = side >= 0 ? cli_side_names[side] : NULL;
    look->has_direction = side < 0 && parse_direction(value, look->direction);
    if (look->side || look->has_direction)
        return true;
    cli_hint_choice(option, value, hint);
    cli_complain(
        "--%s: \"%.100s\" is not front, back, left, right, top, bottom, iso or a direction like 1,0.5,2%s",
        option->name, value, hint);
    return false;
}

/* Sets a choice, and that it is given. */
static bool set_choice(void *settings, const cli_option *option, const char *value, size_t choice,
                       bool *is_given)
{
    cli_option of = *option;
    of.offset += choice;
    *is_given = true;
    return cli_set_choice(settings, &of, value);
}

bool cli_set_up(void *settings, const cli_option *option, const char *value)
{
    return set_choice(settings, option, value, offsetof(cli_look, up), &look_of(settings, option)->has_up);
}

bool cli_set_color(void *settings, const cli_option *option, const char *value)
{
    return set_choice(settings, option, value, offsetof(cli_look, color),
                      &look_of(settings, option)->has_color);
}

/* Parses a whole number between least and most; *text then points behind it. */
static bool parse_whole(const char **text, unsigned least, unsigned most, uint32_t *number)
{
    unsigned value = 0;
    const char *at = *text;
    for (; *at >= '0' && *at <= '9' && value <= most; at++)
        value = 10 * value + (unsigned)(*at - '0');
    const bool is_right = at > *text && value >= least && value <= most;
    *number = value;
    *text = at;
    return is_right;
}

bool cli_set_size(void *settings, const cli_option *option, const char *value)
{
    cli_look *const look = look_of(settings, option);
    const char *at = value;
    if (parse_whole(&at, LEAST_SIDE, MOST_SIDE, &look->size[0]) && *at++ == 'x' &&
        parse_whole(&at, LEAST_SIDE, MOST_SIDE, &look->size[1]) && !*at)
        return true;
    cli_complain("--%s: \"%.100s\" is not a width and a height of %d to %d pixels, like 1600x900",
                 option->name, value, LEAST_SIDE, MOST_SIDE);
    return false;
}

bool cli_set_frames(void *settings, const cli_option *option, const char *value)
{
    const char *at = value;
    if (parse_whole(&at, 2, MOST_FRAMES, &look_of(settings, option)->frames) && !*at)
        return true;
    cli_complain("--%s: \"%.100s\" is not a number from 2 to %d", option->name, value, MOST_FRAMES);
    return false;
}

void cli_look_describe(const cli_look *look, ffd_view_desc *view)
{
    view->up = (ffd_up)look->up;
    view->no_cage = look->no_cage;
    if (look->has_color)
        view->color = (ffd_view_color)look->color;
    view->width = look->size[0];
    view->height = look->size[1];
    view->frames = look->frames;
    view->animation = look->animation;
    if (look->has_direction)
        memcpy(view->camera, look->direction, sizeof view->camera);
    else
        ffd_view_camera(look->side ? look->side : "iso", view->up, view->camera);
}

const char *cli_look_given(const cli_look *look)
{
    return look->side || look->has_direction ? "camera"
           : look->has_up                    ? "up"
           : look->no_cage                   ? "no-cage"
           : look->size[0]                   ? "size"
           : look->frames                    ? "frames"
           : look->animation                 ? "animation"
           : look->has_color                 ? "color"
                                             : NULL;
}
