/* prm.c - parameter files of PyGeM: a box, turned about its corner, of Bernstein polynomials, and
   displacements in its lengths. The text is what Python's configparser reads: sections, keys with = or :,
   lines that begin deeper than their key go on with its value, and whole lines of comment. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include <math.h>
#include <string.h>

/* The most control points along a direction, whose degree is one less. */
#define MOST_POINTS ((size_t)FFD_MAX_DEGREE + 1)
#define BOX "Box info"
#define WEIGHTS "Parameters weights"

/* Keys of the box, each with the letter of an axis. */
enum { COUNT, LENGTH, ORIGIN, ANGLE, BOX_KEYS };
static const char *const box_keys[BOX_KEYS] = {"n control points ", "box length ", "box origin ",
                                               "rotation angle "};
#define WEIGHT_KEY "parameter "

/* A line of the file that is not empty or a comment. */
typedef struct prm_line {
    text_word section; /* that it is in */
    text_word key;     /* of the value that it is of */
    text_scan value;   /* its part of the value */
    bool is_first;     /* of this value */
} prm_line;

typedef struct prm_walk {
    text_scan scan;
    text_word section, key;
    size_t indent; /* of the key */
} prm_walk;

typedef struct prm_file {
    const file_input *file;
    const char *name;
    double box[BOX_KEYS][3];
    size_t lines[BOX_KEYS][3];  /* where they are; 0: not there */
    size_t size[3], layers[3];  /* control points; in the lattice, which has two of each at least */
    double axes[9], lengths[3]; /* in rows; with their signs */
    ffd_error *error;
} prm_file;

static text_word trimmed(const char *first, const char *last)
{
    while (first < last && ffd_text_is_blank(*first))
        first++;
    while (last > first && ffd_text_is_blank(last[-1]))
        last--;
    return (text_word){first, last};
}

static prm_walk begin(const prm_file *f)
{
    prm_walk walk = {.section = {NULL, NULL}};
    ffd_text_begin(&walk.scan, f->file->data, ffd_text_size(f->file->data, f->file->size), false);
    return walk;
}

/* Takes the rest of the current line, and moves to the next one. */
static text_scan take_rest(text_scan *scan)
{
    text_scan line = *scan;
    const char *last = scan->at;
    while (last < scan->last && *last != '\n' && *last != '\r')
        last++;
    line.last = last;
    scan->at = last;
    ffd_text_next_line(scan);
    return line;
}

/* Takes the next line of a value. Returns false at the end of the file. */
static bool next_line(prm_walk *walk, prm_line *line)
{
    while (walk->scan.at < walk->scan.last) {
        const text_scan all = take_rest(&walk->scan);
        const text_word text = trimmed(all.at, all.last);
        const size_t indent = (size_t)(text.first - all.at);
        if (text.first == text.last || *text.first == '#' || *text.first == ';')
            continue;
        *line = (prm_line){.section = walk->section, .key = walk->key, .value = all};
        if (walk->key.first && indent > walk->indent)
            return true;
        walk->key = (text_word){NULL, NULL};
        if (*text.first == '[') {
            walk->section = (text_word){text.first + 1, text.last - (text.last[-1] == ']')};
            continue;
        }
        const char *at = text.first;
        while (at < text.last && *at != '=' && *at != ':')
            at++;
        walk->indent = indent;
        walk->key = line->key = trimmed(text.first, at);
        line->section = walk->section;
        line->value.at = at < text.last ? at + 1 : at;
        line->is_first = true;
        return true;
    }
    return false;
}

/* Returns the axis, 0 to 2, whose key this is, or -1. */
static int axis_of(text_word key, const char *name)
{
    const size_t length = strlen(name);
    const text_word start = {key.first, key.first + length};
    if ((size_t)(key.last - key.first) != length + 1 || !ffd_text_is_any_case(start, name))
        return -1;
    const char letter = (char)(key.last[-1] | 0x20);
    return letter >= 'x' && letter <= 'z' ? letter - 'x' : -1;
}

static ffd_status take_box(prm_file *f, prm_line *line)
{
    for (int k = 0; k < BOX_KEYS; k++) {
        const int a = axis_of(line->key, box_keys[k]);
        text_word word;
        if (a < 0)
            continue;
        if (f->lines[k][a])
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, line->value.line,
                                 "%s%c is there twice, first in line %zu", box_keys[k], "xyz"[a],
                                 f -> lines[k][a]);
        f->lines[k][a] = line->value.line;
        if (!ffd_text_word(&line->value, &word) || !ffd_text_number(word, &f->box[k][a]) ||
            !isfinite(f->box[k][a]) || ffd_text_word(&line->value, &word))
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, line->value.line,
                                 "%s%c is not one finite number", box_keys[k], "xyz"[a]);
    }
    return FFD_OK;
}

static ffd_status read_box(prm_file *f)
{
    prm_walk walk = begin(f);
    prm_line line;
    while (next_line(&walk, &line))
        if (line.is_first && line.section.first && ffd_text_is(line.section, BOX))
            TRY(take_box(f, &line));
    for (int k = 0; k < BOX_KEYS; k++)
        for (int a = 0; a < 3; a++)
            if (!f->lines[k][a])
                return ffd_fail_file(f->error, FFD_E_INVALID, f->name, "has no \"%s%c\" in the section [%s]",
                                     box_keys[k], "xyz"[a], BOX);
    return FFD_OK;
}

/* The columns of Rx Ry Rz, as rows. */
static void find_axes(const double angles[3], double axes[9])
{
    double product[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int a = 0; a < 3; a++) {
        double turn[9], next[9];
        ffd_axis_rotation(a, angles[a], turn);
        mat_multiply(product, turn, next);
        memcpy(product, next, sizeof next);
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            axes[3 * r + c] = product[3 * c + r];
}

static ffd_status check_box(prm_file *f)
{
    for (int a = 0; a < 3; a++) {
        const double count = f->box[COUNT][a];
        if (!(count >= 1) || count != floor_of(count))
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, f->lines[COUNT][a],
                                 "%g is not a number of control points", count);
        if (count > (double)MOST_POINTS)
            return ffd_fail_line(
                f->error, FFD_E_UNSUPPORTED, f->name, f->lines[COUNT][a],
                "%g control points are Bernstein polynomials of degree %g; degrees to %d (%zu "
                "control points) are supported",
                count, count - 1, FFD_MAX_DEGREE, MOST_POINTS);
        f->size[a] = (size_t)count;
        f->layers[a] = f->size[a] > 1 ? f->size[a] : 2;
        f->lengths[a] = f->box[LENGTH][a];
        if (f->lengths[a] == 0)
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, f->lines[LENGTH][a],
                                 "the box has no length");
    }
    find_axes(f->box[ANGLE], f->axes);
    return FFD_OK;
}

/* Sets a displacement along axis a, of the control point with these indices, in all layers that it has. */
static void displace(const prm_file *f, const size_t index[3], int a, double weight, lattice_spec *spec)
{
    size_t at[3], last[3];
    for (int d = 0; d < 3; d++)
        last[d] = f->size[d] > 1 ? index[d] : 1;
    for (at[2] = index[2]; at[2] <= last[2]; at[2]++)
        for (at[1] = index[1]; at[1] <= last[1]; at[1]++)
            for (at[0] = index[0]; at[0] <= last[0]; at[0]++) {
                double *const offset =
                    spec->deformed_offsets + 3 * (at[0] + f->layers[0] * (at[1] + f->layers[1] * at[2]));
                offset[a] = weight * f->lengths[a];
            }
}

static ffd_status take_weight(const prm_file *f, prm_line *line, int a, lattice_spec *spec)
{
    text_word word;
    uint64_t number;
    size_t index[3];
    double weight;
    if (!ffd_text_word(&line->value, &word))
        return FFD_OK;
    for (int d = 0; d < 3; d++) {
        if (!ffd_text_whole(word, &number) || number >= f->size[d])
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, line->value.line,
                                 "\"%s\" is not an index below %zu", ffd_text_shown(word).text, f->size[d]);
        index[d] = (size_t)number;
        if (!ffd_text_word(&line->value, &word))
            return ffd_fail_line(f->error, FFD_E_INVALID, f->name, line->value.line,
                                 "is not three indices and a number");
    }
    if (!ffd_text_number(word, &weight) || !isfinite(weight) || ffd_text_word(&line->value, &word))
        return ffd_fail_line(f->error, FFD_E_INVALID, f->name, line->value.line,
                             "is not three indices and a finite number");
    displace(f, index, a, weight, spec);
    return FFD_OK;
}

/* The displacements along the axes of the box become those along x, y, z. */
static void turn_offsets(const prm_file *f, lattice_spec *spec)
{
    for (size_t i = 0; i < spec->count; i++) {
        double *const offset = spec->deformed_offsets + 3 * i, turned[3];
        for (int c = 0; c < 3; c++)
            turned[c] = offset[0] * f->axes[c] + offset[1] * f->axes[3 + c] + offset[2] * f->axes[6 + c];
        memcpy(offset, turned, sizeof turned);
    }
}

static ffd_status read_weights(const prm_file *f, lattice_spec *spec)
{
    prm_walk walk = begin(f);
    prm_line line;
    while (next_line(&walk, &line)) {
        const int a =
            line.section.first && ffd_text_is(line.section, WEIGHTS) ? axis_of(line.key, WEIGHT_KEY) : -1;
        if (a >= 0)
            TRY(take_weight(f, &line, a, spec));
    }
    turn_offsets(f, spec);
    return FFD_OK;
}

/* A side of negative length lies on the other side of the origin. */
static void place_box(const prm_file *f, lattice_spec *spec)
{
    ffd_free(spec->points);
    spec->points = NULL;
    spec->rest = SPEC_BOX;
    spec->spacing = FFD_SPACING_GREVILLE;
    spec->has_axes = true;
    for (int a = 0; a < 3; a++) {
        const double sign = f->lengths[a] < 0 ? -1 : 1;
        for (int c = 0; c < 3; c++)
            spec->box_axes[3 * a + c] = sign * f->axes[3 * a + c];
        spec->box_min[a] = vec_dot(spec->box_axes + 3 * a, f->box[ORIGIN]);
        spec->box_max[a] = spec->box_min[a] + fabs(f->lengths[a]);
        spec->degree[a] = (int)f->layers[a] - 1;
    }
}

ffd_status ffd_lattice_read_prm(const file_input *file, const char *name, const format_wish *wish,
                                lattice_spec **spec, ffd_error *error)
{
    prm_file f = {.file = file, .name = name, .error = error};
    *spec = NULL;
    TRY(read_box(&f));
    TRY(check_box(&f));
    TRY(ffd_format_begin(f.layers, name, wish, spec, error));
    (*spec)->deformed_offsets = ffd_alloc_zero((*spec)->count, 3 * sizeof *(*spec)->deformed_offsets);
    if (!(*spec)->deformed_offsets)
        return ffd_fail_memory(error);
    place_box(&f, *spec);
    return read_weights(&f, *spec);
}

/* The angles of a rotation Rx Ry Rz whose columns are the rows of axes. */
static void find_angles(const double axes[9], double angles[3])
{
    const double level = sqrt(axes[0] * axes[0] + axes[3] * axes[3]);
    const bool is_upright = level < 1e-12; /* y turns by 90 degrees, and x and z about one axis */
    angles[0] = is_upright ? ffd_angle_degrees(axes[5], axes[4]) : ffd_angle_degrees(-axes[7], axes[8]);
    angles[1] = ffd_angle_degrees(axes[6], level);
    angles[2] = is_upright ? 0 : ffd_angle_degrees(-axes[3], axes[0]);
}

static ffd_status check_written(const ffd_lattice *lattice, ffd_error *error)
{
    const lattice_spec *const spec = lattice->spec;
    bool is_bernstein =
        spec && spec->rest == SPEC_BOX && spec->spacing == FFD_SPACING_GREVILLE && !lattice->rest_weights;
    for (int a = 0; a < 3; a++)
        is_bernstein = is_bernstein && lattice->knots[a].kind == KNOTS_CLAMPED &&
                       lattice->size[a] == (size_t)lattice->knots[a].degree + 1;
    return is_bernstein
               ? FFD_OK
               : ffd_fail(error, FFD_E_UNSUPPORTED,
                          "a .prm file holds a box of Bernstein polynomials alone: without weights, with "
                          "clamped knots, and one control point more than its degree in each direction");
}

static void append_box(const prm_file *f, byte_buffer *text)
{
    ffd_buffer_text(text, "[" BOX "]\n");
    for (int k = 0; k < BOX_KEYS; k++) {
        for (int a = 0; a < 3; a++) {
            ffd_buffer_format(text, "%s%c: ", box_keys[k], "xyz"[a]);
            ffd_buffer_number(text, f->box[k][a]);
            ffd_buffer_text(text, "\n");
        }
        ffd_buffer_text(text, "\n");
    }
    ffd_buffer_text(text, "[" WEIGHTS "]\n");
}

static void append_weights(const prm_file *f, const ffd_lattice *lattice, int a, byte_buffer *text)
{
    const size_t *const n = lattice->size;
    const char *before = "";
    ffd_buffer_format(text, WEIGHT_KEY "%c:", "xyz"[a]);
    for (size_t i = 0; i < n[0]; i++)
        for (size_t j = 0; j < n[1]; j++)
            for (size_t k = 0; k < n[2]; k++) {
                const double *const offset = lattice->difference + 3 * (i + n[0] * (j + n[1] * k));
                ffd_buffer_format(text, "%s %zu %zu %zu ", before, i, j, k);
                ffd_buffer_number(text, vec_dot(f->axes + 3 * a, offset) / f->lengths[a]);
                ffd_buffer_text(text, "\n");
                before = "             ";
            }
    ffd_buffer_text(text, "\n");
}

/* Finds the corner, the lengths and the angles of a box. One whose axes are left-handed gets a negative
   length. */
static void describe(const ffd_lattice *lattice, prm_file *f)
{
    const lattice_spec *const spec = lattice->spec;
    const double sign = mat_determinant(spec->box_axes) < 0 ? -1 : 1;
    memcpy(f->axes, spec->box_axes, sizeof f->axes);
    for (int a = 0; a < 3; a++) {
        const double side = a == 2 ? sign : 1;
        f->lengths[a] = side * (spec->box_max[a] - spec->box_min[a]);
        for (int c = 0; c < 3; c++) {
            f->box[ORIGIN][c] += spec->box_min[a] * spec->box_axes[3 * a + c];
            f->axes[3 * a + c] *= side;
        }
        f->box[COUNT][a] = (double)lattice->size[a];
        f->box[LENGTH][a] = f->lengths[a];
    }
    find_angles(f->axes, f->box[ANGLE]);
}

ffd_status ffd_lattice_write_prm(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    prm_file f = {.error = error};
    byte_buffer text = {0};
    TRY(check_written(lattice, error));
    describe(lattice, &f);
    append_box(&f, &text);
    for (int a = 0; a < 3; a++)
        append_weights(&f, lattice, a, &text);
    const ffd_status status =
        text.failed ? ffd_fail_memory(error) : ffd_output_write(output, text.data, text.size, error);
    ffd_buffer_free(&text);
    return status;
}
