/* look.h - the options that say how a mesh is drawn. */
#ifndef FFD_CLI_LOOK_H
#define FFD_CLI_LOOK_H

#include "cli/options.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stdint.h>

/* A member of a command's settings. All zeros: nothing is given. */
typedef struct cli_look {
    const char *side; /* a named side, or NULL */
    double direction[3];
    bool has_direction;
    int up, color;
    bool has_up, has_color, no_cage;
    uint32_t size[2], frames;
    const char *animation;
} cli_look;

/* Setters of the options below, whose offset is that of the cli_look. */
bool cli_set_side(void *settings, const cli_option *option, const char *value);
/* Likewise. */
bool cli_set_up(void *settings, const cli_option *option, const char *value);
/* Likewise. */
bool cli_set_size(void *settings, const cli_option *option, const char *value);
/* Likewise. */
bool cli_set_frames(void *settings, const cli_option *option, const char *value);
/* Likewise. */
bool cli_set_color(void *settings, const cli_option *option, const char *value);

extern const char *const cli_side_names[], *const cli_up_names[], *const cli_color_names[];

/* Entries of a command's table: from where one looks, and what else is drawn. at: the offset of the cli_look
   in its settings. */
#define CLI_SIDE_OPTIONS(at)                                                                                 \
    {"camera",                                                                                               \
     0,                                                                                                      \
     "front|back|left|right|top|bottom|iso|x,y,z",                                                           \
     "the side to look from; default iso: right, above, front",                                              \
     cli_set_side,                                                                                           \
     at,                                                                                                     \
     cli_side_names},                                                                                        \
        {"up",       0,  "y|z|x",     "the axis that points upwards in the view; default y",                 \
         cli_set_up, at, cli_up_names},                                                                      \
    {                                                                                                        \
        "no-cage", 0, NULL, "draw no control points", cli_set_flag, (at) + offsetof(cli_look, no_cage), NULL \
    }

/* Likewise for pictures. */
#define CLI_PICTURE_OPTIONS(at)                                                                              \
    {"size",       0,                                                                                        \
     "WxH",        "pixels of the picture, or of each in a row, 16 to 32767 a side; default 1600x900",       \
     cli_set_size, at,                                                                                       \
     NULL},                                                                                                  \
        {"frames",                                                                                           \
         0,                                                                                                  \
         "N",                                                                                                \
         "N pictures in a row, 2 to 64, from rest to deformed; default: before and after side by side",      \
         cli_set_frames,                                                                                     \
         at,                                                                                                 \
         NULL},                                                                                              \
        {"animation",                                                                                        \
         0,                                                                                                  \
         "NAME",                                                                                             \
         "poses of this animation, 5 or --frames of them, and deformed below; a page opens with it",         \
         cli_set_text,                                                                                       \
         (at) + offsetof(cli_look, animation),                                                               \
         NULL},                                                                                              \
    {                                                                                                        \
        "color", 0, "displacement|status|det|plain",                                                         \
            "by displacement, status, det F, or its own; default displacement, of a page its own",           \
            cli_set_color, at, cli_color_names                                                               \
    }

/* Fills the members of a description. */
void cli_look_describe(const cli_look *look, ffd_view_desc *view);
/* Returns the name of an option that is given, or NULL. */
const char *cli_look_given(const cli_look *look);

#endif
