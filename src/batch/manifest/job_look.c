#include "batch/manifest/job_look.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Limits of the side of a picture in pixels, and of pictures in a row. */
#define LEAST_SIDE 16
#define MOST_SIDE 32767
#define LEAST_FRAMES 2
#define MOST_FRAMES 64

#define COUNT(list) (sizeof(list) / sizeof *(list))

static const char *const sides[] = {"front", "back", "left", "right", "top", "bottom", "iso"};
/* In the order of ffd_up, of ffd_view_color, and of "no-cage". */
static const char *const ups[] = {"y", "z", "x"}, *const flags[] = {"false", "true"};
static const char *const colors[] = {"displacement", "status", "det", "plain"};

static ffd_status refuse(const char *option, const char *text, const char *wanted, ffd_error *error)
{
    return ffd_fail(error, FFD_E_ARGUMENT, "\"view\": %s: \"%.60s\" is not %s", option, text, wanted);
}

/* Finds a word; known ones are in a list of count. */
static ffd_status find_word(const char *option, const char *text, const char *const *known, size_t count,
                            int *index, ffd_error *error)
{
    char hint[200];
    for (size_t i = 0; i < count; i++)
        if (strcmp(known[i], text) == 0) {
            *index = (int)i;
            return FFD_OK;
        }
    ffd_words_hint(text, known, count, hint, sizeof hint);
    return ffd_fail(error, FFD_E_ARGUMENT, "\"view\": %s: unknown \"%.60s\" (%s)", option, text, hint);
}

/* Parses "x,y,z", not all of them 0. */
static bool parse_direction(const char *text, double direction[3])
{
    const char *const last = text + strlen(text);
    double length = 0;
    for (int a = 0; a < 3; a++) {
        const char *const end = ffd_number_parse(text, last, &direction[a]);
        if (!end || !isfinite(direction[a]) || *end != (a < 2 ? ',' : 0))
            return false;
        length += fabs(direction[a]);
        text = end + 1;
    }
    return length > 0;
}

/* Parses a whole number, behind which *text then points. */
static bool parse_whole(const char **text, uint32_t least, uint32_t most, uint32_t *number)
{
    const char *at = *text;
    uint32_t value = 0;
    for (; *at >= '0' && *at <= '9' && value <= most; at++)
        value = 10 * value + (uint32_t)(*at - '0');
    const bool is_right = at > *text && value >= least && value <= most;
    *number = value;
    *text = at;
    return is_right;
}

static ffd_status read_camera(job_look *look, const char *text, ffd_error *error)
{
    double direction[3];
    int side = 0;
    if (parse_direction(text, direction)) {
        memcpy(look->view.camera, direction, sizeof direction);
        look->side = NULL;
        return FFD_OK;
    }
    if (strchr(text, ','))
        return refuse("camera", text, "a direction like 1,0.5,2", error);
    TRY(find_word("camera", text, sides, COUNT(sides), &side, error));
    look->side = sides[side];
    return FFD_OK;
}

static ffd_status read_up(job_look *look, const char *text, ffd_error *error)
{
    int up = 0;
    TRY(find_word("up", text, ups, COUNT(ups), &up, error));
    look->view.up = (ffd_up)up;
    return FFD_OK;
}

static ffd_status read_color(job_look *look, const char *text, ffd_error *error)
{
    int color = 0;
    TRY(find_word("color", text, colors, COUNT(colors), &color, error));
    look->view.color = (ffd_view_color)color;
    return FFD_OK;
}

static ffd_status read_no_cage(job_look *look, const char *text, ffd_error *error)
{
    int flag = 0;
    TRY(find_word("no-cage", text, flags, COUNT(flags), &flag, error));
    look->view.no_cage = flag;
    return FFD_OK;
}

static ffd_status read_size(job_look *look, const char *text, ffd_error *error)
{
    const char *at = text;
    uint32_t width, height = 0;
    if (!parse_whole(&at, LEAST_SIDE, MOST_SIDE, &width) || *at++ != 'x' ||
        !parse_whole(&at, LEAST_SIDE, MOST_SIDE, &height) || *at)
        return refuse("size", text, "a width and a height of 16 to 32767 pixels, like 1600x900", error);
    look->view.width = width;
    look->view.height = height;
    return FFD_OK;
}

static ffd_status read_frames(job_look *look, const char *text, ffd_error *error)
{
    const char *at = text;
    uint32_t frames;
    if (!parse_whole(&at, LEAST_FRAMES, MOST_FRAMES, &frames) || *at)
        return refuse("frames", text, "a number from 2 to 64", error);
    look->view.frames = frames;
    return FFD_OK;
}

static ffd_status read_animation(job_look *look, const char *text, ffd_error *error)
{
    (void)error;
    look->view.animation = text;
    return FFD_OK;
}

/* The options of `ffd batch --view`. */
static const struct {
    const char *name;
    ffd_status (*read)(job_look *look, const char *text, ffd_error *error);
} options[] = {{"size", read_size},      {"frames", read_frames}, {"animation", read_animation},
               {"color", read_color},    {"camera", read_camera}, {"up", read_up},
               {"no-cage", read_no_cage}};

/* Makes -0 to 0, so that equal looks have equal bytes. */
static void clean(double direction[3])
{
    for (int a = 0; a < 3; a++)
        direction[a] += 0.0;
}

/* The named side of a direction; NULL: none. */
static const char *side_of(const double direction[3], ffd_up up)
{
    for (size_t i = 0; i < COUNT(sides); i++) {
        double other[3];
        const bool is_known = !ffd_view_camera(sides[i], up, other);
        if (is_known)
            clean(other);
        if (is_known && memcmp(other, direction, sizeof other) == 0)
            return sides[i];
    }
    return NULL;
}

void ffd_job_look_begin(job_look *look, const ffd_view_desc *batch)
{
    ffd_view_desc_init(&look->view, sizeof look->view);
    if (batch)
        look->view = *batch;
    clean(look->view.camera);
    look->side = side_of(look->view.camera, look->view.up);
}

ffd_status ffd_job_look_read(job_look *look, const char *option, const char *text, ffd_error *error)
{
    const char *names[COUNT(options)];
    char hint[200];
    for (size_t i = 0; i < COUNT(options); i++) {
        names[i] = options[i].name;
        if (strcmp(option, options[i].name) == 0)
            return options[i].read(look, text, error);
    }
    ffd_words_hint(option, names, COUNT(options), hint, sizeof hint);
    return ffd_fail(error, FFD_E_ARGUMENT, "\"view\": unknown key \"%.60s\" (%s)", option, hint);
}

bool ffd_job_look_has(const char *option)
{
    size_t i = 0;
    while (i < COUNT(options) && strcmp(options[i].name, option) != 0)
        i++;
    return i < COUNT(options);
}

void ffd_job_look_end(job_look *look)
{
    if (look->side)
        ffd_view_camera(look->side, look->view.up, look->view.camera);
    clean(look->view.camera);
}
