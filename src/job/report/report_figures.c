#include "job/report/report_figures.h"
#include "base/struct_size.h"
#include "job/figures/figure_values.h"
#include "job/figures/figures.h"
#include <ffd/job.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Returns what follows a figure; behind a group, what follows its end. */
static const figure *after(const figure *f)
{
    int depth = 0;
    do {
        depth += (f->result.type == FIGURE_GROUP) - (f->result.type == FIGURE_END);
        f++;
    } while (depth > 0);
    return f;
}

/* Returns the figure after the last one of a job: those of a pass have no name. */
static bool is_of_report(const figure *f)
{
    return f < ffd_figures + ffd_figure_count && *f->name;
}

/* A group of plain values is written on one line. */
static bool has_inner_object(const figure *group)
{
    for (const figure *f = group + 1; f->result.type != FIGURE_END; f++)
        if (f->result.type == FIGURE_GROUP || f->result.type == FIGURE_BOX)
            return true;
    return false;
}

static void write_box(json_text *json, const char *key, const ffd_bounds *box)
{
    ffd_json_object(json, key, true);
    if (box->min[0] <= box->max[0]) {
        ffd_json_vector(json, "min", box->min, 3);
        ffd_json_vector(json, "max", box->max, 3);
    } else {
        ffd_json_null(json, "min");
        ffd_json_null(json, "max");
    }
    ffd_json_end(json, '}');
}

static void write_behind(json_text *json, const char *key, const ffd_behind *behind)
{
    ffd_json_array(json, key, false);
    for (int k = 0; k < FFD_BEHIND_KIND_COUNT; k++) {
        if (behind[k].count == 0)
            continue;
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "kind", ffd_behind_kind_name((ffd_behind_kind)k));
        ffd_json_count(json, "count", behind[k].count);
        ffd_json_array(json, "names", true);
        for (int i = 0; i < FFD_BEHIND_NAMES && behind[k].names[i][0]; i++)
            ffd_json_string(json, NULL, behind[k].names[i]);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void write_flaws(json_text *json, const char *key, const ffd_job_result *result)
{
    ffd_json_array(json, key, false);
    for (size_t i = 0; i < result->flaw_count; i++) {
        const ffd_flaw *const flaw = &result->flaws[i];
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "message", flaw->message);
        if (*flaw->pointer)
            ffd_json_string(json, "pointer", flaw->pointer);
        if (flaw->line)
            ffd_json_count(json, "line", flaw->line);
        ffd_json_count(json, "count", flaw->count);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

typedef struct face_text {
    char text[3];
} face_text;

/* The name of the face of a bit, as "u-". */
static face_text face_name(int bit)
{
    return (face_text){{"uvw"[bit / 2], "-+"[bit % 2], 0}};
}

static void write_rigid(json_text *json, const char *key, const ffd_rigid_figures *rigid)
{
    ffd_json_array(json, key, false);
    for (uint64_t k = 0; k < rigid->count; k++) {
        const ffd_rigid_part *const part = &rigid->parts[k];
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "part", part->part);
        ffd_json_count(json, "pieces", part->pieces);
        ffd_json_number(json, "rotation", part->rotation);
        ffd_json_number(json, "scale", part->scale);
        ffd_json_number(json, "distance", part->distance);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

/* Writes the faces of each lattice that are held. */
static void write_faces(json_text *json, const char *key, const ffd_seam_figures *seam)
{
    ffd_json_array(json, key, true);
    for (uint64_t l = 0; l < seam->count; l++) {
        ffd_json_array(json, NULL, true);
        for (int f = 0; f < 6; f++)
            if (seam->faces[l] >> f & 1)
                ffd_json_string(json, NULL, face_name(f).text);
        ffd_json_end(json, ']');
    }
    ffd_json_end(json, ']');
}

typedef struct lattice_name {
    char text[40];
} lattice_name;

/* Returns the name of a lattice, or one by its index, as messages have it: an object or a text may have
   none. */
static const char *name_of(const char *name, uint64_t index, lattice_name *by_index)
{
    snprintf(by_index->text, sizeof by_index->text, "lattice %" PRIu64, index + 1);
    return name ? name : by_index->text;
}

static void write_figure(json_text *json, const figure *f, const ffd_job_result *result);

/* Writes each morph target with what it does by itself. */
static void write_morphs(json_text *json, const char *key, const ffd_morph_results *morphs)
{
    ffd_json_array(json, key, false);
    for (size_t k = 0; k < morphs->count; k++) {
        lattice_name name;
        const char *const lattice = morphs->lattices[k].path;
        ffd_json_object(json, NULL, false);
        ffd_json_string(json, "name", morphs->names[k]);
        ffd_json_string(json, "lattice", name_of(lattice, k, &name));
        for (const figure *f = ffd_figures; is_of_report(f); f = after(f))
            if (!f->is_of_job)
                write_figure(json, f, &morphs->results[k]);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void write_group(json_text *json, const figure *group, const ffd_job_result *result)
{
    ffd_json_object(json, ffd_figure_key(group), !has_inner_object(group));
    for (const figure *f = group + 1; f->result.type != FIGURE_END; f = after(f))
        write_figure(json, f, result);
    ffd_json_end(json, '}');
}

static void write_value(json_text *json, const figure *f, const ffd_job_result *result)
{
    const void *const value = ffd_figure_value(&f->result, result);
    const char *const key = ffd_figure_key(f);
    switch (f->result.type) {
    case FIGURE_COUNT:
        ffd_json_count(json, key, *(const uint64_t *)value);
        break;
    case FIGURE_NUMBER:
        ffd_json_number(json, key, *(const double *)value);
        break;
    case FIGURE_TEXT:
        ffd_json_string(json, key, *(const char *)value ? value : NULL);
        break;
    case FIGURE_VECTOR:
        ffd_json_vector(json, key, value, 3);
        break;
    case FIGURE_BOX:
        write_box(json, key, value);
        break;
    case FIGURE_STATUSES:
        for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
            ffd_json_count(json, ffd_vertex_status_name((ffd_vertex_status)s), ((const uint64_t *)value)[s]);
        break;
    case FIGURE_VERDICT:
        ffd_json_string(json, key, ffd_fold_verdict_name(*(const ffd_fold_verdict *)value));
        break;
    case FIGURE_REFERENCE:
        ffd_json_string(json, key, ffd_fold_reference_name(*(const ffd_fold_reference *)value));
        break;
    case FIGURE_SEAM:
        ffd_json_string(json, key, ffd_seam_name(*(const ffd_seam *)value));
        break;
    case FIGURE_BEHIND:
        write_behind(json, key, value);
        break;
    case FIGURE_FLAWS:
        write_flaws(json, key, result);
        break;
    case FIGURE_MORPHS:
        write_morphs(json, key, &result->morphs);
        break;
    case FIGURE_RIGID:
        write_rigid(json, key, &result->rigid);
        break;
    case FIGURE_FACES:
        write_faces(json, key, &result->seam);
        break;
    case FIGURE_GROUP:
        write_group(json, f, result);
        break;
    case FIGURE_NONE:
    case FIGURE_FLAG:
    case FIGURE_CAUSE:
    case FIGURE_END:
        break;
    }
}

static void write_figure(json_text *json, const figure *f, const ffd_job_result *result)
{
    bool null;
    if (f->is_held_back)
        return;
    if (ffd_figure_is_there(f, result, &null))
        write_value(json, f, result);
    else if (null)
        ffd_json_null(json, ffd_figure_key(f));
}

void ffd_figures_write_folds(json_text *json, const ffd_folds *folds)
{
    const ffd_job_result result = {.folds = *folds};
    for (const figure *f = ffd_figures; is_of_report(f); f = after(f))
        if (strcmp(f->name, "folds") == 0)
            write_figure(json, f, &result);
}

void ffd_figures_write(json_text *json, const ffd_job_result *result, bool stable)
{
    for (const figure *f = ffd_figures; is_of_report(f); f = after(f))
        if (!(stable && f->is_time))
            write_figure(json, f, result);
}

void ffd_figures_write_unknown(json_text *json)
{
    for (const figure *f = ffd_figures; is_of_report(f); f = after(f)) {
        if (f->is_held_back || f->is_time || f->presence == FIGURE_ABSENT_UNLESS)
            continue;
        if (f->result.type != FIGURE_STATUSES)
            ffd_json_null(json, ffd_figure_key(f));
        for (int s = 0; s < FFD_VERTEX_STATUS_COUNT && f->result.type == FIGURE_STATUSES; s++)
            ffd_json_null(json, ffd_vertex_status_name((ffd_vertex_status)s));
    }
}

static uint64_t count_of(const json_tree *tree, uint32_t object, const char *key)
{
    double number = 0;
    const uint32_t value = ffd_json_tree_member(tree, object, key);
    if (value == JSON_NONE || !ffd_json_tree_number(tree, value, &number))
        return 0;
    return number > 0 && number < 0x1p64 ? (uint64_t)number : 0;
}

/* Returns the name of a value of an enum; NULL behind the last. */
static const char *enum_name(figure_type type, int value)
{
    return type == FIGURE_VERDICT     ? ffd_fold_verdict_name((ffd_fold_verdict)value)
           : type == FIGURE_REFERENCE ? ffd_fold_reference_name((ffd_fold_reference)value)
                                      : ffd_seam_name((ffd_seam)value);
}

/* Returns the value of the enum that a name stands for; 0 if there is none. */
static int enum_of(const json_tree *tree, uint32_t value, figure_type type)
{
    for (int i = 0; value != JSON_NONE; i++) {
        const char *const name = enum_name(type, i);
        if (!name || ffd_json_tree_string_is(tree, value, name))
            return name ? i : 0;
    }
    return 0;
}

static bool is_array(const json_tree *tree, uint32_t value)
{
    return value != JSON_NONE && tree->values[value].kind == JSON_ARRAY;
}

static uint8_t read_face_names(const json_tree *tree, uint32_t array)
{
    unsigned faces = 0;
    if (!is_array(tree, array))
        return 0;
    for (uint32_t face = ffd_json_tree_first(tree, array); face != JSON_NONE;
         face = ffd_json_tree_after(tree, face))
        for (int f = 0; f < 6; f++)
            if (ffd_json_tree_string_is(tree, face, face_name(f).text))
                faces |= 1U << f;
    return (uint8_t)faces;
}

/* Reads the faces of each lattice, and so the number of lattices. */
static void read_faces(const json_tree *tree, uint32_t array, ffd_seam_figures *seam)
{
    seam->count = 0;
    if (!is_array(tree, array))
        return;
    for (uint32_t l = ffd_json_tree_first(tree, array); l != JSON_NONE && seam->count < FFD_LATTICES_MOST;
         l = ffd_json_tree_after(tree, l))
        seam->faces[seam->count++] = read_face_names(tree, l);
}

/* Reads the figures from f to the end of its group, which object holds. */
static void read_figures(const json_tree *tree, uint32_t object, const figure *f, ffd_job_result *result)
{
    for (; is_of_report(f) && f->result.type != FIGURE_END; f = after(f)) {
        const char *const key = ffd_figure_key(f);
        const uint32_t found = f->is_held_back ? JSON_NONE : ffd_json_tree_member(tree, object, key);
        void *const value = (char *)result + f->result.at;
        if (f->needs[0].type == FIGURE_FLAG)
            *((bool *)result + f->needs[0].at) = found != JSON_NONE && tree->values[found].kind != JSON_NULL;
        if (f->result.type == FIGURE_GROUP)
            read_figures(tree, found, f + 1, result);
        else if (f->result.type == FIGURE_COUNT)
            *(uint64_t *)value = count_of(tree, object, key);
        else if (f->result.type == FIGURE_NUMBER &&
                 (found == JSON_NONE || !ffd_json_tree_number(tree, found, value)))
            *(double *)value = NAN;
        else if (f->result.type == FIGURE_VERDICT)
            *(ffd_fold_verdict *)value = (ffd_fold_verdict)enum_of(tree, found, f->result.type);
        else if (f->result.type == FIGURE_REFERENCE)
            *(ffd_fold_reference *)value = (ffd_fold_reference)enum_of(tree, found, f->result.type);
        else if (f->result.type == FIGURE_SEAM)
            *(ffd_seam *)value = (ffd_seam)enum_of(tree, found, f->result.type);
        else if (f->result.type == FIGURE_FACES)
            read_faces(tree, found, &result->seam);
        for (int s = 0; s < FFD_VERTEX_STATUS_COUNT && f->result.type == FIGURE_STATUSES; s++)
            ((uint64_t *)value)[s] = count_of(tree, object, ffd_vertex_status_name((ffd_vertex_status)s));
    }
}

void ffd_figures_read(const json_tree *tree, uint32_t entry, ffd_job_result *result)
{
    ffd_result_clear(result);
    read_figures(tree, entry, ffd_figures, result);
}

ffd_status ffd_job_result_text(const ffd_job_result *callers, const char *lattice, char **text,
                               ffd_error *error)
{
    ffd_job_result result;
    byte_buffer out = {0};
    lattice_name name;
    ffd_result_clear(&result);
    *text = NULL;
    TRY(ffd_struct_take(&result, sizeof result, callers, "ffd_job_result", error));
    const figure_text lines = {&result, name_of(lattice, result.folds.witness.lattice, &name), &out};
    for (const figure *f = ffd_figures; is_of_report(f); f = after(f)) {
        bool null;
        /* The lines of sizes say why they are not known. */
        if (f->lines && (ffd_figure_is_there(f, &result, &null) || f->presence == FIGURE_NULL_UNLESS_FINITE))
            ffd_lines_write(f->lines, &lines);
    }
    *text = ffd_buffer_finish(&out);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
