/* names.c - the names of values in public headers, as options, reports, pages and messages have them. */
#include <ffd/job.h>

#define NAME_OF(names, value) ((size_t)(value) < sizeof(names) / sizeof *(names) ? (names)[value] : NULL)

const char *ffd_vertex_status_name(ffd_vertex_status status)
{
    static const char *const names[] = {[FFD_VERTEX_INSIDE] = "inside",
                                        [FFD_VERTEX_OUTSIDE] = "outside",
                                        [FFD_VERTEX_MULTIPLE] = "multiple",
                                        [FFD_VERTEX_SINGULAR] = "singular",
                                        [FFD_VERTEX_INVALID] = "invalid"};
    return NAME_OF(names, status);
}

const char *ffd_fold_verdict_name(ffd_fold_verdict verdict)
{
    static const char *const names[] = {
        [FFD_FOLDS_NONE] = "none", [FFD_FOLDS_SOME] = "some", [FFD_FOLDS_UNKNOWN] = "unknown"};
    return NAME_OF(names, verdict);
}

const char *ffd_fold_reference_name(ffd_fold_reference reference)
{
    static const char *const names[] = {
        [FFD_FOLDS_TO_MEAN] = "mean", [FFD_FOLDS_TO_BOUNDS] = "bounds", [FFD_FOLDS_TO_PLACE] = "place"};
    return NAME_OF(names, reference);
}

const char *ffd_behind_kind_name(ffd_behind_kind kind)
{
    static const char *const names[] = {
        [FFD_BEHIND_SOCKET] = "socket", [FFD_BEHIND_CAMERA] = "camera",
        [FFD_BEHIND_LIGHT] = "light",   [FFD_BEHIND_JOINT] = "joint",
        [FFD_BEHIND_PIVOT] = "pivot",   [FFD_BEHIND_PHYSICS_SHAPE] = "physics_shape",
        [FFD_BEHIND_SPLAT] = "splat"};
    return NAME_OF(names, kind);
}

const char *ffd_view_color_name(ffd_view_color color)
{
    static const char *const names[] = {[FFD_VIEW_DISPLACEMENT] = "displacement",
                                        [FFD_VIEW_STATUS] = "status",
                                        [FFD_VIEW_DET] = "det",
                                        [FFD_VIEW_PLAIN] = "plain",
                                        [FFD_VIEW_AUTO] = "auto"};
    return NAME_OF(names, color);
}
