#include "job/figures/figure_lines.h"
#include <ffd/job.h>
#include <inttypes.h>
#include <math.h>

static void write_statuses(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out, "  vertices       %" PRIu64, result->vertices);
    const char *before = ": ";
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        if (result->counts[s]) {
            ffd_buffer_format(text->out, "%s%" PRIu64 " %s", before, result->counts[s],
                              ffd_vertex_status_name((ffd_vertex_status)s));
            before = ", ";
        }
    ffd_buffer_text(text->out, "\n");
}

static void write_moved(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out, "  moved          %" PRIu64 ", by %g at most\n", result->moved,
                      result->displacement.max);
}

static void put_vector(const figure_text *text, const char *before, const double v[3])
{
    ffd_buffer_format(text->out, "%s%g %g %g", before, v[0], v[1], v[2]);
}

static void put_witness(const figure_text *text, const ffd_fold_witness *witness)
{
    put_vector(text, "                 at u,v,w = ", witness->uvw);
    put_vector(text, ", x,y,z = ", witness->rest);
    put_vector(text, " at rest, ", witness->xyz);
    ffd_buffer_format(text->out, " deformed, det J is %g (%s)\n", witness->det, text->lattice);
}

static void write_folds(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    static const char *const references[] = {"its mean at rest", "the bounds of the control points at rest",
                                             "that at rest"};
    const ffd_folds *const folds = &result->folds;
    const char *const s = folds->cells == 1 ? "" : "s";
    ffd_buffer_text(text->out, "  folds          ");
    if (folds->verdict == FFD_FOLDS_NONE)
        ffd_buffer_format(text->out, "none, proven in %s %" PRIu64 " cell%s inside the lattice",
                          folds->cells == 1 ? "the" : "all", folds->cells, s);
    else if (folds->verdict == FFD_FOLDS_UNKNOWN)
        ffd_buffer_format(text->out, "unknown: %" PRIu64 " of %" PRIu64 " cell%s could not be decided",
                          folds->unknown_cells, folds->cells, s);
    else
        ffd_buffer_format(text->out, "some: %" PRIu64 " of %" PRIu64 " cell%s", folds->folded_cells,
                          folds->cells, s);
    ffd_buffer_format(text->out, "; det J is at least %g of %s", folds->min_det,
                      references[folds->relative_to]);
    if (result->det.outside <= 0)
        ffd_buffer_format(text->out, "; outside it det F falls to %g, at vertex %" PRIu64,
                          result->det.outside, result->det.outside_vertex);
    ffd_buffer_text(text->out, "\n");
    if (folds->witness.is_there)
        put_witness(text, &folds->witness);
}

/* Writes why the edge with the largest step is torn. */
static void put_tear_reason(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    static const char *const reasons[] = {
        [FFD_TEAR_LATTICES] = "the lattices move its two ends differently",
        [FFD_TEAR_BLOCKS] = "neighbouring blocks move their common faces differently",
        [FFD_TEAR_SEAM] = "the two faces of a lattice's seam are moved apart",
        [FFD_TEAR_AXIS] = "control points at one place on a lattice's axis are moved apart",
        [FFD_TEAR_BORDER] = "along it the nearest part of the lattice's border changes",
        [FFD_TEAR_OVERLAP] = "it leads from one part of a lattice that overlaps itself to another",
        [FFD_TEAR_WEIGHTS] = "vertices at one position have different weights",
        [FFD_TEAR_RIGID] = "a rigid part leaves vertices that were at its positions",
    };
    const uint64_t faces = result->shared_faces.disagreeing, stay = result->tear.stays;
    if (result->tear.cause == FFD_TEAR_BLOCKS && faces)
        ffd_buffer_format(text->out, "; blocks move %" PRIu64 " vert%s on their faces differently", faces,
                          faces == 1 ? "ex" : "ices");
    else if (result->tear.cause > FFD_TEAR_UNSELECTED)
        ffd_buffer_format(text->out, "; %s", reasons[result->tear.cause]);
    else
        ffd_buffer_format(text->out, "; %" PRIu64 " vert%s", stay, stay == 1 ? "ex stays" : "ices stay");
}

static void write_flipped(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out, "  flipped faces  %" PRIu64 " of %" PRIu64 "\n", result->flipped_faces,
                      result->faces);
}

static void write_tear(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out, "  torn edges     %" PRIu64, result->tear.edges);
    if (result->tear.edges) {
        ffd_buffer_format(text->out, ", the largest step is %g at vertex %" PRIu64, result->tear.largest,
                          result->tear.vertex);
        if (*result->tear.part)
            ffd_buffer_format(text->out, " of %s", result->tear.part);
        put_tear_reason(text);
    }
    ffd_buffer_text(text->out, "\n");
}

static void put_size(const figure_text *text, double value, const char *unknown)
{
    if (isnan(value))
        ffd_buffer_format(text->out, "%s", unknown);
    else if (isinf(value))
        ffd_buffer_text(text->out, "too large for a double");
    else
        ffd_buffer_format(text->out, "%g", value);
}

/* Writes a line with a size at rest and deformed. before, after: what stands for an unknown one. */
static void put_sizes(const figure_text *text, const char *label, const ffd_before_after *size,
                      const char *before, const char *after)
{
    ffd_buffer_format(text->out, "  %-14s ", label);
    put_size(text, size->before, before);
    if (!isnan(size->before)) {
        ffd_buffer_text(text->out, ", deformed ");
        put_size(text, size->after, after);
    }
    ffd_buffer_text(text->out, "\n");
}

/* Why there is no volume, by the area of the same faces. */
static const char *reason_of(const ffd_job_result *result, double area)
{
    if (isnan(area))
        return "not known";
    return result->faces == 0 && fpclassify(area) == FP_ZERO ? "none: the mesh has no faces"
                                                             : "none: the mesh is not closed";
}

/* The area first: the volume's line refers to it. */
static void write_extent(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    put_sizes(text, "area", &result->area, "not known", "not known");
    put_sizes(text, "volume", &result->volume, reason_of(result, result->area.before),
              reason_of(result, result->area.after));
}

static void write_det(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out, "  det F          %g to %g at the vertices\n", result->det.min,
                      result->det.max);
}

static void write_edges(const figure_text *text)
{
    const ffd_job_result *const result = text->result;
    ffd_buffer_format(text->out,
                      "  edges          %" PRIu64 ", %g at most from the deformed surface, %g on average\n",
                      result->edges.count, result->edges.deviation.max, result->edges.deviation.mean);
}

static void write_cells(const figure_text *text)
{
    const ffd_cell_figures *const cells = &text->result->cells;
    ffd_buffer_format(text->out, "  cells          %" PRIu64 ": %" PRIu64 " inverted by the deformation",
                      cells->count, cells->by_deformation);
    if (cells->unknown)
        ffd_buffer_format(text->out, ", %" PRIu64 " not decided", cells->unknown);
    ffd_buffer_format(text->out, " (inverted: %" PRIu64 ", deformed %" PRIu64 ")\n", cells->inverted.before,
                      cells->inverted.after);
    if (cells->has_worst)
        ffd_buffer_format(text->out,
                          "                 scaled Jacobian at least %g, deformed %g, of cell %" PRIu64 "\n",
                          cells->scaled_jacobian.before, cells->scaled_jacobian.after, cells->worst);
}

static void write_rig(const figure_text *text)
{
    const ffd_rig_figures *const rig = &text->result->rig;
    ffd_buffer_format(text->out, "  rig            %" PRIu64 " joint%s, ", rig->joints,
                      rig->joints == 1 ? "" : "s");
    if (rig->moved)
        ffd_buffer_format(text->out, "%" PRIu64 " node%s, ", rig->moved,
                          rig->moved == 1 ? " follows" : "s follow");
    ffd_buffer_format(text->out, "the largest lag is %g", rig->largest_lag);
    if (*rig->worst)
        ffd_buffer_format(text->out, " (%s)", rig->worst);
    ffd_buffer_text(text->out, "\n");
}

static void write_rigid(const figure_text *text)
{
    const ffd_rigid_figures *const rigid = &text->result->rigid;
    for (uint64_t k = 0; k < rigid->count; k++) {
        const ffd_rigid_part *const part = &rigid->parts[k];
        ffd_buffer_format(text->out, "  %-14s %s, ", k == 0 ? "rigid" : "", part->part);
        if (part->pieces != 1)
            ffd_buffer_format(text->out, "%" PRIu64 " pieces, ", part->pieces);
        ffd_buffer_format(text->out, "turned by %.6g degrees, ", part->rotation);
        if (part->scale < 1 || part->scale > 1)
            ffd_buffer_format(text->out, "scaled by %g, ", part->scale);
        ffd_buffer_format(text->out, "%g at most from the deformation\n", part->distance);
    }
}

void ffd_lines_write(figure_lines lines, const figure_text *text)
{
    static void (*const writers[])(const figure_text *text) = {
        [LINES_OF_STATUSES] = write_statuses, [LINES_OF_MOVED] = write_moved,
        [LINES_OF_FOLDS] = write_folds,       [LINES_OF_FLIPPED] = write_flipped,
        [LINES_OF_TEAR] = write_tear,         [LINES_OF_EXTENT] = write_extent,
        [LINES_OF_DET] = write_det,           [LINES_OF_EDGES] = write_edges,
        [LINES_OF_CELLS] = write_cells,       [LINES_OF_RIG] = write_rig,
        [LINES_OF_RIGID] = write_rigid,
    };
    writers[lines](text);
}
