/* lattice_set.c - ffd lattice set: operations on what a lattice does, in the order given. */
#include "cli/author.h"
#include "cli/three.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    cli_author author;
    ffd_operation *operations; /* count entries */
    char **names;              /* of files, which operations name together with a number; name_count */
    size_t count, name_count;
    const char *block; /* of the files of --deformed and --deformed-offsets */
} settings;

/* Appends an operation. Returns NULL after a complaint. */
static ffd_operation *add(settings *s, ffd_operation_kind kind)
{
    ffd_operation *const more = realloc(s->operations, (s->count + 1) * sizeof *more);
    if (!more) {
        cli_complain("out of memory");
        return NULL;
    }
    s->operations = more;
    more[s->count] = (ffd_operation){.kind = kind};
    return &more[s->count++];
}

/* Parses count numbers with commas between them. */
static bool parse_numbers(const char *text, size_t count, double *numbers)
{
    for (size_t i = 0; i < count; i++) {
        char part[64];
        const size_t length = strcspn(text, ",");
        if (length >= sizeof part || (i + 1 < count) != (text[length] == ','))
            return false;
        memcpy(part, text, length);
        part[length] = 0;
        if (!cli_parse_number(part, &numbers[i]))
            return false;
        text += length + 1;
    }
    return true;
}

static bool wrong(const cli_option *option, const char *value, const char *expected)
{
    cli_complain("--%s: \"%.100s\" is not %s", option->name, value, expected);
    return false;
}

static bool add_strength(void *context, const cli_option *option, const char *value)
{
    double number;
    if (!cli_parse_number(value, &number))
        return wrong(option, value, "a number, like 0.5");
    ffd_operation *const of = add(context, FFD_OPERATION_STRENGTH);
    if (of)
        of->number = number;
    return of;
}

/* "OTHER,T"; the last comma counts. */
static bool add_blend(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    const char *const comma = strrchr(value, ',');
    double share;
    if (!comma || comma == value || !cli_parse_number(comma + 1, &share))
        return wrong(option, value, "a lattice and a number, like other.json,0.5");
    char **const names = realloc(s->names, (s->name_count + 1) * sizeof *names);
    s->names = names ? names : s->names;
    char *const name = names ? malloc((size_t)(comma - value) + 1) : NULL;
    ffd_operation *const of = name ? add(s, FFD_OPERATION_BLEND) : NULL;
    if (!of) {
        free(name);
        return false;
    }
    memcpy(name, value, (size_t)(comma - value));
    name[comma - value] = 0;
    s->names[s->name_count++] = name;
    of->number = share;
    of->other.path = name;
    return true;
}

/* An operation with another lattice, by a file name. */
static bool add_named(void *context, const cli_option *option, const char *value, ffd_operation_kind kind)
{
    if (!*value)
        return wrong(option, value, "the name of a lattice");
    ffd_operation *const of = add(context, kind);
    if (of)
        of->other.path = value;
    return of;
}

static bool add_other(void *context, const cli_option *option, const char *value)
{
    return add_named(context, option, value, FFD_OPERATION_ADD);
}

static bool add_deformed(void *context, const cli_option *option, const char *value)
{
    return add_named(context, option, value, FFD_OPERATION_DEFORMED);
}

static bool add_offsets(void *context, const cli_option *option, const char *value)
{
    return add_named(context, option, value, FFD_OPERATION_DEFORMED_OFFSETS);
}

/* Returns the index of a letter among three, or -1. */
static int index_of(const char *letters, char letter)
{
    const char *const at = letter ? strchr(letters, letter) : NULL;
    return at ? (int)(at - letters) : -1;
}

static bool add_mirror(void *context, const cli_option *option, const char *value)
{
    const int direction = index_of("uvw", *value);
    if (direction < 0 || value[1])
        return wrong(option, value, "u, v or w");
    ffd_operation *const of = add(context, FFD_OPERATION_MIRROR);
    if (of)
        of->direction = direction;
    return of;
}

static bool add_symmetrize(void *context, const cli_option *option, const char *value)
{
    const int direction = index_of("uvw", *value);
    if (direction < 0 || (value[1] != '+' && value[1] != '-') || value[2])
        return wrong(option, value, "u+, u-, v+, v-, w+ or w-: the half that stays");
    ffd_operation *const of = add(context, FFD_OPERATION_SYMMETRIZE);
    if (of) {
        of->direction = direction;
        of->keep_last = value[1] == '+';
    }
    return of;
}

static bool add_transform(void *context, const cli_option *option, const char *value)
{
    double matrix[16];
    if (!parse_numbers(value, 16, matrix))
        return wrong(option, value, "16 numbers, row by row, of which the last four are 0,0,0,1");
    ffd_operation *const of = add(context, FFD_OPERATION_TRANSFORM);
    if (of)
        memcpy(of->matrix, matrix, sizeof matrix);
    return of;
}

static bool add_move(void *context, const cli_option *option, const char *value)
{
    double by[3];
    if (!parse_numbers(value, 3, by))
        return wrong(option, value, "three numbers, like 0,1.5,0");
    ffd_operation *const of = add(context, FFD_OPERATION_MOVE);
    if (of)
        memcpy(of->place, by, sizeof by);
    return of;
}

/* Parses a number, and the place about which it acts: the origin if there is none. */
static bool parse_about(const char *text, double *number, double place[3])
{
    double numbers[4] = {0};
    const bool right = strchr(text, ',') ? parse_numbers(text, 4, numbers) : parse_numbers(text, 1, numbers);
    *number = numbers[0];
    memcpy(place, numbers + 1, 3 * sizeof *place);
    return right;
}

static bool add_rotate(void *context, const cli_option *option, const char *value)
{
    const int axis = index_of("xyz", *value);
    double degrees, place[3];
    if (axis < 0 || value[1] != ',' || !parse_about(value + 2, &degrees, place))
        return wrong(option, value, "an axis and degrees, like y,90, or with a place, like y,90,1,0,0");
    ffd_operation *const of = add(context, FFD_OPERATION_ROTATE);
    if (of) {
        of->direction = axis;
        of->number = degrees;
        memcpy(of->place, place, sizeof place);
    }
    return of;
}

static bool add_scale(void *context, const cli_option *option, const char *value)
{
    double factor, place[3];
    if (!parse_about(value, &factor, place))
        return wrong(option, value, "a factor, like 2, or with a place, like 2,1,0,0");
    ffd_operation *const of = add(context, FFD_OPERATION_SCALE);
    if (of) {
        of->number = factor;
        memcpy(of->place, place, sizeof place);
    }
    return of;
}

static bool add_invert(void *context, const cli_option *option, const char *value)
{
    (void)option;
    (void)value;
    return add(context, FFD_OPERATION_INVERT);
}

/* As of a job, which "none" does not change: here it would be no operation. */
static bool add_seam(void *context, const cli_option *option, const char *value)
{
    ffd_deform_desc job = {.seam = FFD_SEAM_NONE};
    if (!cli_read(ffd_deform_member_of("seam"), &job, option, value))
        return false;
    if (job.seam == FFD_SEAM_NONE)
        return wrong(option, value, "C0, C1 or C2, alone or with faces, like C1:u-,v+ or C2:all");
    ffd_operation *const of = add(context, FFD_OPERATION_SEAL);
    if (of) {
        of->continuity = (int)job.seam - 1;
        of->faces = job.seam_faces;
    }
    return of;
}

static const cli_option options[] = {
    {"deformed", 0, "LATTICE", "the deformed control points of another lattice file, .csv or .npy",
     add_deformed, 0, NULL},
    {"deformed-offsets", 0, "LATTICE", "its displacements; or its control points, taken as displacements",
     add_offsets, 0, NULL},
    {"strength", 0, "S", "S times all displacements: 0.5 half the edit, -1 the opposite", add_strength, 0,
     NULL},
    {"blend", 0, "LATTICE,T", "1 - T of it and T of another lattice of the same rest", add_blend, 0, NULL},
    {"add", 0, "LATTICE", "what another lattice of the same rest does, too", add_other, 0, NULL},
    {"mirror", 0, "u|v|w", "the mirror image across the middle of a direction", add_mirror, 0, NULL},
    {"symmetrize", 0, "u+|u-|v+|v-|w+|w-", "this half stays, the other becomes its mirror image",
     add_symmetrize, 0, NULL},
    {"transform", 0, "A,B,...", "the lattice placed by a matrix of 16 numbers, row by row", add_transform, 0,
     NULL},
    {"move", 0, "X,Y,Z", "the lattice placed elsewhere", add_move, 0, NULL},
    {"rotate", 0, "x|y|z,DEG[,X,Y,Z]", "the lattice turned about an axis, through the origin or a place",
     add_rotate, 0, NULL},
    {"scale", 0, "S[,X,Y,Z]", "the lattice scaled about the origin or a place", add_scale, 0, NULL},
    {"invert", 0, NULL, "the exact inverse: what was deformed is put back", add_invert, 0, NULL},
    {"seam", 0, "C0|C1|C2[:FACES]",
     "hold faces, to join the rest smoothly; FACES: u-,v+,.., all, or cut by --mesh, the default", add_seam,
     0, NULL},
    {"block", 0, "N|TAG", "with --deformed: of a file of several lattices, its number, from 0, or its name",
     cli_set_text, offsetof(settings, block), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int set(const settings *s, const char *lattice)
{
    const ffd_author_desc job = cli_author_describe(&s->author, lattice);
    ffd_error error;
    for (size_t i = 0; i < s->count; i++)
        s->operations[i].block = s->block;
    return ffd_lattice_set_run(&job, s->operations, s->count, &error) ? cli_fail(&error) : EXIT_DONE;
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(const settings *s, const cli_words *words)
{
    size_t streams = words->count == 1 && strcmp(words->words[0], "-") == 0;
    for (size_t i = 0; i < s->count; i++)
        streams += s->operations[i].other.path && strcmp(s->operations[i].other.path, "-") == 0;
    if (streams > 1)
        return "standard input can be read only once";
    const char *const why = cli_author_mistake(&s->author, words);
    return why || s->count > 0 ? why : "needs at least one operation, such as --strength 0.5";
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    return cli_author_prepare(&s->author) ? set(s, words->words[0]) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    const int code = cli_run(command, &s, &s.author.help, count, arguments, act);
    cli_author_end(&s.author);
    for (size_t i = 0; i < s.name_count; i++)
        free(s.names[i]);
    free(s.names);
    free(s.operations);
    return code;
}

static const cli_example examples[] = {
    {"half the edit", "ffd lattice set bend.json --mesh cow.obj -o half.json --strength 0.5"},
    {"one half mirrored to the other, then turned about a place",
     "ffd lattice set bend.json --mesh cow.obj -o turned.json --symmetrize u+ --rotate y,90,1,0,0"},
    {"a lattice at rest with the control points that a script has moved",
     "ffd lattice set rest.json -o moved.json --deformed moved.npy"},
    {"end the edit smoothly at the first and the last layers of u",
     "ffd lattice set bend.json --mesh cow.obj -o smooth.json --seam C1:u-,u+"},
    {"end it smoothly where the mesh leaves the lattice",
     "ffd lattice set upper.json --mesh column.obj -o joined.json --seam C1"},
    {"the way back: deform a mesh by bend.json, then by this one",
     "ffd lattice set bend.json --mesh cow.obj -o back.json --invert"},
    {NULL, NULL},
};

const cli_command cli_lattice_set = {"lattice set",
                                     "change what a lattice does: its control points, strength, blends, "
                                     "mirror images, places, seams, the inverse",
                                     "usage: ffd lattice set LATTICE OPERATION... -o LATTICE [options]\n"
                                     "       operations, in the order given: --deformed, --deformed-offsets, "
                                     "--strength, --blend,\n"
                                     "       --add, --mirror, --symmetrize, --transform, --move, --rotate, "
                                     "--scale, --invert, --seam\n",
                                     {.first = options, .base = cli_author_options},
                                     run,
                                     "LATTICE",
                                     examples};
