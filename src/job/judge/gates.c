#include "job/judge/gates.h"
#include "job/chain/coverage.h"
#include "job/judge/figures.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

ffd_status ffd_policies_judge(const ffd_deform_desc *desc, const char *name, bool check,
                              const lattice_chain *chain, const pass_totals *totals, ffd_error *error)
{
    if (totals->first_invalid != UINT64_MAX && !check)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "vertex %" PRIu64 " (counted from 0) has a coordinate that is not finite",
                             totals->first_invalid);
    if (totals->first_shape_invalid != UINT64_MAX && !check)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "a morph target moves vertex %" PRIu64
                             " (counted from 0) to a coordinate that is not finite",
                             totals->first_shape_invalid);
    if (desc->outside == FFD_OUTSIDE_ERROR && totals->outside_any) {
        char coverage[600];
        ffd_chain_coverage(chain, coverage, sizeof coverage);
        return ffd_fail_file(
            error, FFD_E_EMBEDDING, name,
            "%" PRIu64 " of %" PRIu64 " vertices are outside the lattice, the first is vertex %" PRIu64
            " (counted from 0)%s%s",
            totals->outside_any, totals->vertices, totals->first_outside, *coverage ? "; " : "", coverage);
    }
    if (desc->outside == FFD_OUTSIDE_ERROR && totals->shapes_outside)
        return ffd_fail_file(error, FFD_E_EMBEDDING, name,
                             "morph targets move vertices outside the lattice, the first is vertex %" PRIu64
                             " (counted from 0)",
                             totals->first_shape_outside);
    if (totals->first_overflow != UINT64_MAX)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "the deformed position of vertex %" PRIu64
                             " is too large for the file's numbers",
                             totals->first_overflow);
    return FFD_OK;
}

/* A line that grows by what each violated gate has to say. */
typedef struct complaint {
    char text[500];
    size_t length;
} complaint;

static void add(complaint *line, const char *text, const char *gate)
{
    const size_t space = sizeof line->text - line->length;
    const int length = snprintf(line->text + line->length, space, "%s%s (--fail-on %s)",
                                line->length ? "; " : "", text, gate);
    line->length += length < 0 ? 0 : (size_t)length < space ? (size_t)length : space - 1;
}

static void add_count(complaint *line, uint64_t count, const pass_totals *totals, const char *what,
                      const char *gate)
{
    char text[200];
    snprintf(text, sizeof text, "%" PRIu64 " of %" PRIu64 " vertices %s", count, totals->vertices, what);
    if (count)
        add(line, text, gate);
}

ffd_status ffd_gates_judge(const ffd_deform_desc *desc, const char *name, const pass_totals *totals,
                           const ffd_job_result *result, ffd_error *error)
{
    complaint line = {"", 0};
    if (desc->fail_on & FFD_GATE_FOLDS && result->folds.verdict != FFD_FOLDS_NONE) {
        char text[400] = "the deformed volume ";
        const size_t begun = strlen(text);
        ffd_figures_describe_folds(desc, result, text + begun, sizeof text - begun);
        add(&line, text, "folds");
    }
    if (desc->fail_on & FFD_GATE_OUTSIDE)
        add_count(&line, totals->outside_any, totals, "are outside the lattice", "outside");
    if (desc->fail_on & FFD_GATE_OUTSIDE && totals->shapes_outside)
        add(&line, "morph targets move vertices outside the lattice", "outside");
    if (desc->fail_on & FFD_GATE_MULTIPLE)
        add_count(&line, totals->multiple_any, totals, "have several u,v,w", "multiple");
    if (desc->fail_on & FFD_GATE_SINGULAR)
        add_count(&line, totals->counts[FFD_SINGULAR], totals, "are where the lattice has no inverse",
                  "singular");
    return line.length ? ffd_fail_file(error, FFD_E_GATE, name, "%s", line.text) : FFD_OK;
}
