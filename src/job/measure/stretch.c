#include "job/measure/stretch.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/words.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A part is stretched unevenly if the largest singular value over it is more than this times the least. */
#define UNEVEN 1.05

ffd_status ffd_turned_parts_find(mesh_document *document, turned_parts *turned, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    const mesh_place_calls *const calls = document->format->places;
    const size_t bytes = sizeof *turned->nodes + 2 * sizeof *turned->stretches;
    if (!calls || count == 0 || ffd_budget_check(&document->budget, count, bytes, NULL))
        return FFD_OK;
    TRY(calls->find_turned(document, &turned->nodes, error));
    if (!turned->nodes)
        return FFD_OK;
    turned->stretches = ffd_alloc(count, 2 * sizeof *turned->stretches);
    if (!turned->stretches)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 2 * count; i++)
        turned->stretches[i] = NAN;
    return FFD_OK;
}

void ffd_turned_parts_free(turned_parts *turned)
{
    ffd_free(turned->nodes);
    ffd_free(turned->stretches);
    *turned = (turned_parts){0};
}

/* The largest and the least stretch of the vertices that a node turns. */
typedef struct node_stretch {
    float most, least;
    bool any;
} node_stretch;

static void add_vertex(const float stretch[2], node_stretch *node)
{
    if (isnan(stretch[0]) || isnan(stretch[1]))
        return;
    node->most = node->any ? maximum_number(node->most, stretch[0]) : stretch[0];
    node->least = node->any ? minimum_number(node->least, stretch[1]) : stretch[1];
    node->any = true;
}

static double ratio_of(const node_stretch *node)
{
    return !node->any ? 1 : node->least > 0 ? (double)node->most / (double)node->least : HUGE_VAL;
}

static ffd_status warn(const mesh_document *document, size_t worst, double ratio, size_t others,
                       const mesh_log *log, ffd_error *error)
{
    char *const name = document->format->places->name(document, worst);
    char shown[120], unnamed[40], more[60] = "";
    if (!name)
        return ffd_fail_memory(error);
    snprintf(unnamed, sizeof unnamed, "node %zu", worst);
    const char *const kind = strcmp(name, unnamed) == 0 ? "" : "node:";
    ffd_name_shown(name, shown, sizeof shown);
    ffd_free(name);
    if (others > 0)
        snprintf(more, sizeof more, "; so will %zu more", others);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "%s%s, which an animation turns, is stretched unevenly (%.3g to 1), and will wobble%s: see "
                 "{rigid}",
                 kind, shown, ratio, more);
    return FFD_OK;
}

ffd_status ffd_turned_parts_warn(const mesh_document *document, const turned_parts *turned,
                                 const mesh_log *log, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    size_t nodes = 0, worst = 0, uneven = 0;
    double most = 1;
    if (!turned->nodes)
        return FFD_OK;
    for (size_t v = 0; v < count; v++)
        if (turned->nodes[v] != MESH_NONE && turned->nodes[v] >= nodes)
            nodes = (size_t)turned->nodes[v] + 1;
    node_stretch *const of_nodes = ffd_alloc_zero(nodes, sizeof *of_nodes);
    if (!of_nodes)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < count; v++)
        if (turned->nodes[v] != MESH_NONE)
            add_vertex(turned->stretches + 2 * v, &of_nodes[turned->nodes[v]]);
    for (size_t n = 0; n < nodes; n++) {
        const double ratio = ratio_of(&of_nodes[n]);
        uneven += ratio > UNEVEN;
        if (ratio > most) {
            most = ratio;
            worst = n;
        }
    }
    ffd_free(of_nodes);
    return uneven > 0 ? warn(document, worst, most, uneven - 1, log, error) : FFD_OK;
}
