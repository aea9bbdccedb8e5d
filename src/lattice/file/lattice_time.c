#include "lattice/file/lattice_time.h"
#include "base/memory/memory.h"
#include "lattice/build.h"
#include "lattice/copy.h"
#include "lattice/file/spec_keys.h"
#include "lattice/file/spec_parse.h"
#include "lattice/file/spec_still.h"
#include <math.h>

bool ffd_lattice_has_keys(const ffd_lattice *lattice)
{
    return lattice->spec && !lattice->edited && lattice->spec->keys.kind != KEYS_NONE;
}

void ffd_lattice_look(const ffd_lattice_source *source, const ffd_setting *placeholder, bool *has_keys,
                      bool *has_placeholder)
{
    bool used = false;
    const spec_settings settings = {.values = placeholder, .used = &used, .count = 1, .may_be_open = true};
    lattice_spec *spec = NULL;
    size_t size;
    *has_keys = *has_placeholder = false;
    if (ffd_spec_load(source, &settings, &spec, &size, NULL))
        return;
    *has_keys = spec->keys.kind != KEYS_NONE;
    *has_placeholder = used;
    ffd_spec_free(spec);
}

size_t ffd_lattice_get_keys(const ffd_lattice *lattice, double *times)
{
    const size_t count = ffd_lattice_has_keys(lattice) ? lattice->spec->keys.count : 0;
    for (size_t k = 0; times && k < count; k++)
        times[k] = lattice->spec->keys.list[k].time;
    return count;
}

/* Builds the lattice anew from its changed spec, unless it has no positions yet. A failure changes nothing
   but the spec. */
static ffd_status build_again(ffd_lattice *lattice, ffd_error *error)
{
    const bool needs_bounds = ffd_lattice_needs_bounds(lattice);
    ffd_lattice *made;
    if (!lattice->rest)
        return FFD_OK;
    TRY(ffd_spec_build(lattice->spec, needs_bounds ? &lattice->fitted : NULL, &made, error));
    const ffd_lattice old = *lattice;
    *lattice = *made;
    *made = old;
    made->spec = NULL; /* it belongs to the lattice still */
    ffd_lattice_destroy(&made);
    return FFD_OK;
}

static ffd_status check(const ffd_lattice *lattice, double time, ffd_error *error)
{
    if (!ffd_lattice_has_keys(lattice))
        return ffd_fail(error, FFD_E_ARGUMENT, "the lattice has no keys");
    if (!isfinite(time))
        return ffd_fail(error, FFD_E_ARGUMENT, "the time %g is not finite", time);
    return lattice->spec->open.count > 0
               ? ffd_fail(error, FFD_E_INVALID, "placeholders of the lattice have no values")
               : FFD_OK;
}

ffd_status ffd_lattice_set_time(ffd_lattice *lattice, double time, ffd_error *error)
{
    TRY(check(lattice, time, error));
    lattice_spec *const spec = lattice->spec;
    const lattice_spec before = *spec;
    const bool has_moves = spec->keys.kind == KEYS_VALUES;
    lattice_spec changed = before;
    ffd_status status = FFD_OK;
    changed.keys.time = time;
    changed.keys.is_chosen = true;
    if (has_moves)
        status = ffd_spec_moves_at(&changed, error);
    *spec = changed;
    if (!status)
        status = build_again(lattice, error);
    if (status)
        *spec = before;
    if (has_moves) {
        ffd_free(status ? changed.moves : before.moves);
        ffd_free(status ? changed.drags : before.drags);
    }
    return status;
}

ffd_status ffd_lattice_make_still(ffd_lattice **lattice, ffd_error *error)
{
    const ffd_lattice *const from = *lattice;
    lattice_spec shared = *from->spec, *spec = NULL;
    ffd_lattice *made = NULL;
    double *own = NULL;
    ffd_status status;
    TRY_END(ffd_spec_still(from, &shared, &own, error));
    spec = ffd_spec_copy(&shared);
    TRY_END(spec ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_spec_build(spec, from->rest && ffd_lattice_needs_bounds(from) ? &from->fitted : NULL, &made,
                           error));
    spec = NULL;
    ffd_lattice_destroy(lattice);
    *lattice = made;
end:
    ffd_spec_free(spec);
    ffd_free(own);
    return status;
}
