#include "job/report/report.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include "json/json_text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static void write_outcome(json_text *json, const report_entry *entry)
{
    const ffd_status status = entry->result->status;
    char line[2048];
    ffd_json_string(json, "status", entry->skipped ? "skipped" : status ? "failed" : "ok");
    ffd_json_count(json, "exit", (uint64_t)ffd_status_exit_code(status));
    if (!status) {
        ffd_json_null(json, "error");
        return;
    }
    ffd_error_format(&entry->result->error, line, sizeof line);
    ffd_json_string(json, "error", line);
}

static void write_bounds(json_text *json, const char *key, const ffd_bounds *box)
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

static void write_witness(json_text *json, const ffd_job_result *result)
{
    const ffd_folds *folds = &result->folds;
    if (!folds->witness.is_there) {
        ffd_json_null(json, "witness");
        return;
    }
    ffd_json_object(json, "witness", true);
    ffd_json_count(json, "lattice", result->folds.witness.lattice);
    ffd_json_vector(json, "uvw", folds->witness.uvw, 3);
    ffd_json_vector(json, "xyz", folds->witness.xyz, 3);
    ffd_json_vector(json, "rest", folds->witness.rest, 3);
    ffd_json_number(json, "det", folds->witness.det);
    ffd_json_end(json, '}');
}

static void write_folds(json_text *json, const ffd_job_result *result)
{
    static const char *const verdicts[] = {"none", "some", "unknown"};
    static const char *const references[] = {"mean", "bounds", "place"};
    const ffd_folds *folds = &result->folds;
    if (!result->folds.is_known) {
        ffd_json_null(json, "folds");
        return;
    }
    ffd_json_object(json, "folds", false);
    ffd_json_string(json, "verdict", verdicts[folds->verdict]);
    ffd_json_count(json, "cells", folds->cells);
    ffd_json_number(json, "min_det", folds->min_det);
    ffd_json_string(json, "relative_to", references[folds->relative_to]);
    ffd_json_count(json, "folded_cells", folds->folded_cells);
    ffd_json_count(json, "unknown_cells", folds->unknown_cells);
    write_witness(json, result);
    ffd_json_end(json, '}');
}

static void write_determinants(json_text *json, const ffd_job_result *result)
{
    if (!(result->det.min <= result->det.max)) {
        ffd_json_null(json, "det");
        return;
    }
    ffd_json_object(json, "det", true);
    ffd_json_number(json, "min", result->det.min);
    ffd_json_number(json, "max", result->det.max);
    if (isfinite(result->det.outside))
        ffd_json_number(json, "outside", result->det.outside);
    else
        ffd_json_null(json, "outside");
    ffd_json_end(json, '}');
}

static void write_tear(json_text *json, const ffd_job_result *result)
{
    if (!result->tear.is_known) {
        ffd_json_null(json, "tear");
        return;
    }
    ffd_json_object(json, "tear", true);
    ffd_json_count(json, "edges", result->tear.edges);
    ffd_json_number(json, "largest", result->tear.largest);
    if (result->tear.edges)
        ffd_json_count(json, "vertex", result->tear.vertex);
    else
        ffd_json_null(json, "vertex");
    if (*result->tear.part)
        ffd_json_string(json, "part", result->tear.part);
    else
        ffd_json_null(json, "part");
    ffd_json_end(json, '}');
}

static void write_number_or_null(json_text *json, const char *key, double value)
{
    if (isnan(value))
        ffd_json_null(json, key);
    else
        ffd_json_number(json, key, value);
}

static void write_extent(json_text *json, const char *key, double before, double after)
{
    if (!isfinite(before) && !isfinite(after)) {
        ffd_json_null(json, key);
        return;
    }
    ffd_json_object(json, key, true);
    write_number_or_null(json, "before", before);
    write_number_or_null(json, "after", after);
    ffd_json_end(json, '}');
}

static void write_edges(json_text *json, const ffd_job_result *result)
{
    if (!result->edges.is_known) {
        ffd_json_null(json, "edges");
        return;
    }
    ffd_json_object(json, "edges", false);
    ffd_json_count(json, "count", result->edges.count);
    ffd_json_object(json, "deviation", true);
    ffd_json_number(json, "max", result->edges.deviation.max);
    ffd_json_number(json, "mean", result->edges.deviation.mean);
    ffd_json_end(json, '}');
    ffd_json_end(json, '}');
}

static void write_behind(json_text *json, const ffd_job_result *result)
{
    static const char *const kinds[FFD_BEHIND_KIND_COUNT] = {
        [FFD_BEHIND_SOCKET] = "socket", [FFD_BEHIND_CAMERA] = "camera",
        [FFD_BEHIND_LIGHT] = "light",   [FFD_BEHIND_JOINT] = "joint",
        [FFD_BEHIND_PIVOT] = "pivot",   [FFD_BEHIND_PHYSICS_SHAPE] = "physics_shape",
        [FFD_BEHIND_SPLAT] = "splat"};
    ffd_json_array(json, "behind", false);
    for (int k = 0; k < FFD_BEHIND_KIND_COUNT; k++) {
        const ffd_behind *behind = &result->behind[k];
        if (behind->count == 0)
            continue;
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "kind", kinds[k]);
        ffd_json_count(json, "count", behind->count);
        ffd_json_array(json, "names", true);
        for (int i = 0; i < FFD_BEHIND_NAMES && behind->names[i][0]; i++)
            ffd_json_string(json, NULL, behind->names[i]);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

/* Only if there are splats. */
static void write_splats(json_text *json, const ffd_job_result *result)
{
    if (result->splats.carried == 0 && result->splats.broken == 0)
        return;
    ffd_json_object(json, "splats", true);
    ffd_json_count(json, "carried", result->splats.carried);
    ffd_json_count(json, "flattened", result->splats.flattened);
    ffd_json_count(json, "broken", result->splats.broken);
    ffd_json_end(json, '}');
}

/* Only if weights are off. */
static void write_weights(json_text *json, const ffd_job_result *result)
{
    if (result->skin_weights.off == 0 && result->skin_weights.none == 0)
        return;
    ffd_json_object(json, "skin_weights", true);
    ffd_json_count(json, "off", result->skin_weights.off);
    ffd_json_number(json, "farthest", result->skin_weights.farthest);
    ffd_json_count(json, "none", result->skin_weights.none);
    ffd_json_end(json, '}');
}

/* Only if floats change the shape. */
static void write_precision(json_text *json, const ffd_job_result *result)
{
    if (!(result->precision.side > 0))
        return;
    ffd_json_object(json, "precision", true);
    ffd_json_number(json, "error", result->precision.error);
    ffd_json_number(json, "side", result->precision.side);
    ffd_json_end(json, '}');
}

/* Only if there are flaws. */
static void write_flaws(json_text *json, const ffd_job_result *result)
{
    if (result->flaw_count == 0)
        return;
    ffd_json_array(json, "flaws", false);
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

/* Only if something is left behind. */
static void write_left(json_text *json, const ffd_job_result *result)
{
    if (result->indices_left)
        ffd_json_count(json, "indices_left", result->indices_left);
    if (result->bytes_left)
        ffd_json_count(json, "bytes_left", result->bytes_left);
    if (result->bounds_left)
        ffd_json_count(json, "bounds_left", result->bounds_left);
}

/* Vertices on faces that two lattices share. */
static void write_shared_faces(json_text *json, const ffd_job_result *result)
{
    ffd_json_object(json, "shared_faces", true);
    ffd_json_count(json, "moved_twice", result->shared_faces.moved_twice);
    ffd_json_count(json, "disagreeing", result->shared_faces.disagreeing);
    ffd_json_number(json, "largest", result->shared_faces.largest);
    ffd_json_end(json, '}');
}

/* Figures of stored shapes, which gates count separately; of the base only if default weights show another
   shape. */
static void write_targets(json_text *json, const ffd_job_result *result)
{
    ffd_json_object(json, "morph_targets", true);
    ffd_json_count(json, "outside", result->morph_targets.outside);
    ffd_json_count(json, "shown_outside", result->morph_targets.shown_outside);
    if (result->morph_targets.base_outside)
        ffd_json_count(json, "base_outside", result->morph_targets.base_outside);
    ffd_json_count(json, "invalid", result->morph_targets.invalid);
    ffd_json_end(json, '}');
}

/* Only if there are joints, pivots or sockets, or if nodes follow. */
static void write_rig(json_text *json, const ffd_rig_figures *rig)
{
    if (!rig->is_there)
        return;
    ffd_json_object(json, "rig", true);
    ffd_json_count(json, "joints", rig->joints);
    ffd_json_count(json, "moved", rig->moved);
    ffd_json_number(json, "largest_lag", rig->largest_lag);
    if (*rig->worst)
        ffd_json_string(json, "worst", rig->worst);
    else
        ffd_json_null(json, "worst");
    ffd_json_count(json, "sheared", rig->sheared);
    if (rig->singular)
        ffd_json_count(json, "singular", rig->singular);
    if (rig->partial)
        ffd_json_count(json, "partial", rig->partial);
    if (rig->unscaled)
        ffd_json_count(json, "unscaled", rig->unscaled);
    if (rig->unselected) {
        ffd_json_count(json, "unselected", rig->unselected);
        ffd_json_number(json, "unselected_by", rig->unselected_by);
    }
    ffd_json_end(json, '}');
}

/* What the deformation does to the vertices, from their positions to folds. */
static void write_deformation(json_text *json, const ffd_job_result *result)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    ffd_json_count(json, "vertices", result->vertices);
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        ffd_json_count(json, names[s], result->counts[s]);
    ffd_json_count(json, "unused", result->unused);
    ffd_json_count(json, "hidden", result->hidden);
    write_targets(json, result);
    ffd_json_count(json, "moved", result->moved);
    write_shared_faces(json, result);
    ffd_json_object(json, "residual", true);
    ffd_json_number(json, "max", result->residual.max);
    ffd_json_number(json, "rms", result->residual.rms);
    ffd_json_end(json, '}');
    ffd_json_object(json, "iterations", true);
    ffd_json_number(json, "mean", result->iterations.mean);
    ffd_json_count(json, "max", result->iterations.max);
    ffd_json_end(json, '}');
    write_folds(json, result);
    if (result->has_flipped)
        ffd_json_count(json, "flipped_faces", result->flipped_faces);
    else
        ffd_json_null(json, "flipped_faces");
    write_tear(json, result);
    write_extent(json, "volume", result->volume.before, result->volume.after);
    write_extent(json, "area", result->area.before, result->area.after);
    write_determinants(json, result);
}

static void write_reach(json_text *json, const ffd_job_result *result)
{
    ffd_json_object(json, "bounds", false);
    write_bounds(json, "before", &result->bounds.before);
    write_bounds(json, "after", &result->bounds.after);
    ffd_json_end(json, '}');
    ffd_json_object(json, "displacement", true);
    ffd_json_number(json, "max", result->displacement.max);
    ffd_json_number(json, "rms", result->displacement.rms);
    ffd_json_end(json, '}');
}

/* Takes the name from messages: a lattice object or text may have no name. */
static void write_lattice_name(json_text *json, const ffd_job_result *result, size_t k)
{
    char number[40];
    const char *const name = result->morphs.lattices ? result->morphs.lattices[k] : NULL;
    snprintf(number, sizeof number, "lattice %zu", k + 1);
    ffd_json_string(json, "lattice", name ? name : number);
}

/* Only if the job made several morph targets: the figures of each one. */
static void write_morphs(json_text *json, const ffd_job_result *result)
{
    if (!result->morphs.results)
        return;
    ffd_json_array(json, "morphs", false);
    for (size_t k = 0; k < result->morphs.count; k++) {
        ffd_json_object(json, NULL, false);
        ffd_json_string(json, "name", result->morphs.names[k]);
        write_lattice_name(json, result, k);
        write_deformation(json, &result->morphs.results[k]);
        write_reach(json, &result->morphs.results[k]);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void write_figures(json_text *json, const ffd_job_result *result)
{
    write_deformation(json, result);
    write_edges(json, result);
    write_weights(json, result);
    write_precision(json, result);
    write_splats(json, result);
    write_reach(json, result);
    write_behind(json, result);
    write_rig(json, &result->rig);
    write_morphs(json, result);
    write_left(json, result);
    write_flaws(json, result);
}

static void write_seconds(json_text *json, const ffd_job_result *result)
{
    ffd_json_object(json, "seconds", true);
    ffd_json_number(json, "read", result->seconds.read);
    ffd_json_number(json, "embed", result->seconds.embed);
    ffd_json_number(json, "deform", result->seconds.deform);
    ffd_json_number(json, "judge", result->seconds.judge);
    ffd_json_number(json, "write", result->seconds.write);
    ffd_json_end(json, '}');
}

/* Writes the members that every entry has, for a job without figures. */
static void write_unknown(json_text *json)
{
    static const char *const names[] = {
        "vertices",   "inside", "outside",       "multiple",     "singular",     "invalid",
        "unused",     "hidden", "morph_targets", "moved",        "shared_faces", "residual",
        "iterations", "folds",  "flipped_faces", "tear",         "volume",       "area",
        "det",        "edges",  "bounds",        "displacement", "behind"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        ffd_json_null(json, names[i]);
}

/* Copies the members of a text that ffd_report_figures has made. Returns false if it is not one. */
static bool copy_figures(json_text *json, const char *figures, bool stable)
{
    const json_input input = {.text = figures, .size = strlen(figures), .name = ""};
    json_span tree;
    if (ffd_json_parse(&input, &tree, NULL))
        return false;
    for (uint32_t v = ffd_json_span_first(&tree, 0); v != JSON_NONE; v = ffd_json_span_after(&tree, v)) {
        char *const key = ffd_json_span_key(&tree, v);
        json->out->failed = json->out->failed || !key;
        if (key && !(stable && strcmp(key, "seconds") == 0))
            ffd_json_raw(json, key, tree.text + tree.values[v].begin,
                         tree.values[v].end - tree.values[v].begin);
        ffd_free(key);
    }
    ffd_json_span_free(&tree);
    return true;
}

static void write_entry(json_text *json, const report_entry *entry)
{
    ffd_json_object(json, NULL, false);
    if (entry->line)
        ffd_json_count(json, "line", entry->line);
    ffd_json_string(json, "input", entry->input);
    ffd_json_string(json, "output", entry->output);
    if (entry->positions) {
        ffd_json_string(json, "positions", entry->positions);
        ffd_json_count(json, "row", entry->row);
    }
    if (entry->result->picture)
        ffd_json_string(json, "picture", entry->result->picture);
    if (entry->set)
        ffd_json_raw(json, "set", entry->set, strlen(entry->set));
    write_outcome(json, entry);
    if (entry->planned) {
        write_unknown(json);
    } else if (!entry->figures || !copy_figures(json, entry->figures, entry->stable)) {
        write_figures(json, entry->result);
        if (!entry->stable)
            write_seconds(json, entry->result);
    }
    ffd_json_end(json, '}');
}

void ffd_report_entry_text(const report_entry *entry, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, false);
    ffd_json_array(&json, NULL, false);
    const size_t before = whole.size; /* indented like an entry of a report */
    write_entry(&json, entry);
    const char *const start = whole.failed ? NULL : memchr(whole.data + before, '{', whole.size - before);
    if (start)
        ffd_buffer_append(text, start, whole.size - (size_t)(start - whole.data));
    text->failed = text->failed || !start;
    ffd_buffer_free(&whole);
}

void ffd_report_figures(const ffd_job_result *result, byte_buffer *text)
{
    byte_buffer whole = {0};
    json_text json;
    ffd_json_begin(&json, &whole);
    ffd_json_object(&json, NULL, false);
    write_figures(&json, result);
    write_seconds(&json, result);
    ffd_json_end(&json, '}');
    if (!whole.failed)
        ffd_json_join_lines(whole.data, whole.size, text);
    text->failed = text->failed || whole.failed;
    ffd_buffer_free(&whole);
}
