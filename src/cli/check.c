/* check.c - ffd check: what a deformation would do, without writing it. */
#include "base/file/folder.h"
#include "cli/job.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

typedef struct settings {
    cli_job job;
    cli_kept kept;
    const char *picture;
    bool force;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"picture", 0, "FILE.png|FILE.html",
     "draw it too, before and after; of one IN (ffd view has more options)", cli_set_text, AT(picture), NULL},
    {"force", 0, NULL, "overwrite an existing picture; else without effect", cli_set_flag, AT(force), NULL},
    CLI_KEPT_OPTIONS(AT(kept)),
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static void print_statuses(const ffd_job_result *result)
{
    static const char *const names[] = {"inside", "outside", "multiple", "singular", "invalid"};
    printf("  vertices       %" PRIu64, result->vertices);
    const char *before = ": ";
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        if (result->counts[s]) {
            printf("%s%" PRIu64 " %s", before, result->counts[s], names[s]);
            before = ", ";
        }
    printf("\n  moved          %" PRIu64 ", by %g at most\n", result->moved, result->displacement.max);
}

static void print_vector(const char *before, const double v[3])
{
    printf("%s%g %g %g", before, v[0], v[1], v[2]);
}

static void print_witness(const ffd_folds *folds, const char *lattice)
{
    print_vector("                 at u,v,w = ", folds->witness.uvw);
    print_vector(", x,y,z = ", folds->witness.rest);
    print_vector(" at rest, ", folds->witness.xyz);
    printf(" deformed, det J is %g (%s)\n", folds->witness.det, lattice);
}

static void print_folds(const ffd_job_result *result, const char *lattice)
{
    static const char *const references[] = {"its mean at rest", "the bounds of the control points at rest",
                                             "that at rest"};
    const ffd_folds *const folds = &result->folds;
    const char *const s = folds->cells == 1 ? "" : "s";
    printf("  folds          ");
    if (folds->verdict == FFD_FOLDS_NONE)
        printf("none, proven in %s %" PRIu64 " cell%s inside the lattice", folds->cells == 1 ? "the" : "all",
               folds->cells, s);
    else if (folds->verdict == FFD_FOLDS_UNKNOWN)
        printf("unknown: %" PRIu64 " of %" PRIu64 " cell%s could not be decided", folds->unknown_cells,
               folds->cells, s);
    else
        printf("some: %" PRIu64 " of %" PRIu64 " cell%s", folds->folded_cells, folds->cells, s);
    printf("; det J is at least %g of %s", folds->min_det, references[folds->relative_to]);
    if (result->det.outside <= 0)
        printf("; outside it det F falls to %g, at vertex %" PRIu64, result->det.outside,
               result->det.outside_vertex);
    printf("\n");
    if (folds->witness.is_there)
        print_witness(folds, lattice);
}

/* Prints why the edge with the largest step is torn. */
static void print_tear_reason(const ffd_job_result *result)
{
    static const char *const reasons[] = {
        [FFD_TEAR_LATTICES] = "the lattices move its two ends differently",
        [FFD_TEAR_BLOCKS] = "neighbouring blocks move their common faces differently",
        [FFD_TEAR_SEAM] = "the two faces of a lattice's seam are moved apart",
        [FFD_TEAR_AXIS] = "control points at one place on a lattice's axis are moved apart",
        [FFD_TEAR_BORDER] = "along it the nearest part of the lattice's border changes",
        [FFD_TEAR_OVERLAP] = "it leads from one part of a lattice that overlaps itself to another",
    };
    const uint64_t faces = result->shared_faces.disagreeing, stay = result->tear.stays;
    if (result->tear.cause == FFD_TEAR_BLOCKS && faces)
        printf("; blocks move %" PRIu64 " vert%s on their faces differently", faces,
               faces == 1 ? "ex" : "ices");
    else if (result->tear.cause > FFD_TEAR_UNSELECTED)
        printf("; %s", reasons[result->tear.cause]);
    else
        printf("; %" PRIu64 " vert%s", stay, stay == 1 ? "ex stays" : "ices stay");
}

static void print_tear(const ffd_job_result *result)
{
    printf("  torn edges     %" PRIu64, result->tear.edges);
    if (result->tear.edges) {
        printf(", the largest step is %g at vertex %" PRIu64, result->tear.largest, result->tear.vertex);
        if (*result->tear.part)
            printf(" of %s", result->tear.part);
        print_tear_reason(result);
    }
    printf("\n");
}

static void print_size(double value, const char *unknown)
{
    if (isnan(value))
        printf("%s", unknown);
    else if (isinf(value))
        printf("too large for a double");
    else
        printf("%g", value);
}

static void print_area(const ffd_job_result *result)
{
    printf("  area           ");
    print_size(result->area.before, "not known");
    if (!isnan(result->area.before)) {
        printf(", deformed ");
        print_size(result->area.after, "not known");
    }
    printf("\n");
}

/* Why there is no volume, by the area of the same faces. */
static const char *reason_of(const ffd_job_result *result, double area)
{
    if (isnan(area))
        return "not known";
    return result->faces == 0 && fpclassify(area) == FP_ZERO ? "none: the mesh has no faces"
                                                             : "none: the mesh is not closed";
}

static void print_volume(const ffd_job_result *result)
{
    printf("  volume         ");
    print_size(result->volume.before, reason_of(result, result->area.before));
    if (!isnan(result->volume.before)) {
        printf(", deformed ");
        print_size(result->volume.after, reason_of(result, result->area.after));
    }
    printf("\n");
}

static void print_rig(const ffd_rig_figures *rig)
{
    if (!rig->is_there)
        return;
    printf("  rig            %" PRIu64 " joint%s, ", rig->joints, rig->joints == 1 ? "" : "s");
    if (rig->moved)
        printf("%" PRIu64 " node%s, ", rig->moved, rig->moved == 1 ? " follows" : "s follow");
    printf("the largest lag is %g", rig->largest_lag);
    if (*rig->worst)
        printf(" (%s)", rig->worst);
    printf("\n");
}

static void print_summary(const cli_job *job, const char *input, const ffd_job_result *result)
{
    printf("%s\n", cli_display_name(input));
    print_statuses(result);
    print_folds(result, cli_display_name(job->lattices[result->folds.witness.lattice]));
    printf("  flipped faces  %" PRIu64 " of %" PRIu64 "\n", result->flipped_faces, result->faces);
    print_tear(result);
    print_area(result);
    print_volume(result);
    if (result->det.min <= result->det.max)
        printf("  det F          %g to %g at the vertices\n", result->det.min, result->det.max);
    printf("  edges          %" PRIu64 ", %g at most from the deformed surface, %g on average\n",
           result->edges.count, result->edges.deviation.max, result->edges.deviation.mean);
    print_rig(&result->rig);
}

/* Runs the check, and draws the picture if one is wanted. */
static ffd_status run_job(const settings *s, const ffd_deform_desc *desc, ffd_job_result *result)
{
    ffd_view_desc view;
    if (!s->picture)
        return ffd_check_run(desc, result, NULL);
    ffd_view_desc_init(&view, sizeof view);
    view.job = desc;
    view.output = s->picture;
    view.force = s->force;
    return ffd_view_run(&view, result, NULL);
}

static int check(cli_job *job, const char *input, ffd_report *report)
{
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    cli_job_describe(job, input, &desc);
    const ffd_status status = run_job((settings *)job, &desc, &result);
    const bool reported = job->report && cli_is_stream(job->report);
    if ((status == FFD_OK || status == FFD_E_GATE) && !reported && !job->logging.quiet)
        print_summary(job, input, &result);
    return cli_job_ended(job, &result, input, NULL, report);
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *why = words->count ? cli_job_mistake(&s->job, words, words->count) : "needs IN";
    if (!why && s->picture && words->count > 1)
        why = "--picture is of one mesh, but several IN are given";
    if (!why && s->picture && s->job.report && ffd_paths_meet(s->job.report, s->picture))
        why = "the report would replace the picture";
    if (why)
        return cli_usage(command, why);
    if (!cli_job_knows_formats(&s->job, words, words->count))
        return EXIT_USAGE;
    return cli_job_run_all(&s->job, words, words->count, check);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"what a deformation would do", "ffd check cow.obj -l bend.json"},
    {"fail where the deformed volume folds, or is not proven not to",
     "ffd check cow.obj vase.obj -l bend.json --fail-on folds --quiet"},
    {NULL, NULL},
};

const cli_command cli_check = {"check",
                               "what a deformation would do: folds, statuses, quality",
                               "usage: ffd check IN... -l LATTICE [-l LATTICE ...] [options]\n"
                               "       exit 1: a gate of --fail-on is violated\n",
                               {.first = cli_job_options, .more = options},
                               run,
                               "MESH",
                               examples};
