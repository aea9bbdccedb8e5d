/* fuzz_lattice.c - a lattice file's text, a 0 byte, raw float64 points: everything that is done with them
   must keep what the headers promise. Without points, the lattice's own are taken (probe.h). */
#include "base/memory/memory.h"
#include "check_boundary.h"
#include "check_embedding.h"
#include "check_folds.h"
#include "fuzz_target.h"
#include "lattice/file/spec_parse.h"
#include "lattice/file/spec_text.h"
#include "lattice/spec.h"
#include "promise.h"
#include <math.h>
#include <string.h>

/* Larger lattices only take longer. */
#define MOST_POINTS 4096
/* Span cells times control points of a cell, likewise. */
#define MOST_WORK 16384

static void check_refusal(ffd_status status, const ffd_error *error)
{
    PROMISE(status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_UNSUPPORTED, "status %d",
            status);
    PROMISE(error->status == status && error->message[0] && !strpbrk(error->message, "\r\n"),
            "status %d says '%s'", status, error->message);
}

/* The size that the text asks for, before memory is taken for it; and that what is saved can be read. */
static bool is_small(const char *text, size_t size)
{
    lattice_spec *spec, *again;
    ffd_error error;
    const ffd_status status = ffd_spec_parse(text, size, "input", NULL, &spec, &error);
    if (status) {
        check_refusal(status, &error);
        return false;
    }
    double work = 1;
    for (int a = 0; a < 3; a++)
        work *= (double)(spec->size[a] - (size_t)spec->degree[a] + 1) * (spec->degree[a] + 1);
    const bool small = spec->count <= MOST_POINTS && work <= MOST_WORK;
    if (small) {
        size_t saved_size, second_size;
        char *const saved = ffd_spec_text(spec, &saved_size);
        PROMISE(saved, "no text");
        PROMISE(ffd_spec_parse(saved, saved_size, "saved", NULL, &again, &error) == FFD_OK,
                "what was saved is refused, %s: %s", error.pointer, error.message);
        char *const second = ffd_spec_text(again, &second_size);
        PROMISE(second && saved_size == second_size && !memcmp(saved, second, saved_size),
                "what was saved is saved in other words");
        ffd_free(second);
        ffd_spec_free(again);
        ffd_free(saved);
    }
    ffd_spec_free(spec);
    return small;
}

/* The bounds of the tail's finite points, as a mesh would give them. */
static bool fit(ffd_lattice *lattice, const unsigned char *tail, size_t size)
{
    double min[3] = {-1, -2, -3}, max[3] = {2, 3, 4};
    bool first = true;
    for (size_t at = 0; at + 24 <= size; at += 24) {
        double p[3];
        memcpy(p, tail + at, sizeof p);
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            continue;
        for (int a = 0; a < 3; a++) {
            min[a] = first ? p[a] : fmin(min[a], p[a]);
            max[a] = first ? p[a] : fmax(max[a], p[a]);
        }
        first = false;
    }
    ffd_error error;
    const ffd_status status = ffd_lattice_fit(lattice, min, max, &error);
    if (status)
        check_refusal(status, &error);
    return status == FFD_OK;
}

/* Moves a lattice with keys to the middle of the first two. */
static void set_time(ffd_lattice *lattice)
{
    const size_t count = ffd_lattice_get_keys(lattice, NULL);
    double *const times = ffd_alloc(count > 0 ? count : 1, sizeof *times);
    ffd_error error;
    PROMISE(times && count != 1, "%zu keys", count);
    PROMISE(ffd_lattice_get_keys(lattice, times) == count, "other keys");
    const double time = count > 0 ? (times[0] + times[1]) / 2 : 0;
    const ffd_status status = ffd_lattice_set_time(lattice, time, &error);
    ffd_free(times);
    if (count == 0)
        PROMISE(status == FFD_E_ARGUMENT, "a time of a lattice without keys: status %d", status);
    else if (status)
        check_refusal(status, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *const end = size > 0 ? memchr(data, 0, size) : NULL;
    const size_t text_size = end ? (size_t)(end - data) : size;
    const uint8_t *const tail = end ? end + 1 : data + size;
    const size_t tail_size = end ? size - text_size - 1 : 0;
    const char *const text = size > 0 ? (const char *)data : "";

    ffd_lattice *lattice = NULL;
    ffd_error error;
    if (!is_small(text, text_size))
        return 0;
    const ffd_status status = ffd_lattice_parse(text, text_size, "input", &lattice, &error);
    if (status) {
        check_refusal(status, &error);
        PROMISE(!lattice, "a lattice in spite of status %d", status);
        return 0;
    }
    if (fit(lattice, tail, tail_size)) {
        probe of;
        probe_point points[PROBE_MOST];
        set_time(lattice);
        probe_measure(lattice, &of);
        const size_t count = probe_points(&of, tail, tail_size, points);
        if (check_embedding(&of, points, count))
            check_boundary(&of, points, count);
        check_folds(&of, points, count);
    }
    ffd_lattice_destroy(&lattice);
    PROMISE(!lattice, "a destroyed lattice is still there");
    return 0;
}
