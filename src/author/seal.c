/* seal.c - ffd_lattice_seal: faces of the volume held still up to a derivative. */
#include "author/seal.h"
#include "author/refine.h"
#include "lattice/lattice.h"
#include <string.h>

/* What is held: the k + 1 outermost layers at the first and the last face of each direction. */
typedef struct held_layers {
    int k;
    bool held[3][2];
} held_layers;

static ffd_status check_face(const ffd_lattice *lattice, int a, int k, ffd_error *error)
{
    const int degree = lattice->knots[a].degree;
    if (ffd_knots_closed(&lattice->knots[a]))
        return ffd_fail(error, FFD_E_ARGUMENT, "direction %c is closed: it has no faces", "uvw"[a]);
    if (k >= degree)
        return ffd_fail(error, FFD_E_ARGUMENT, "C%d needs degree %d along %c, which has degree %d", k, k + 1,
                        "uvw"[a], degree);
    return FFD_OK;
}

static ffd_status begin(const ffd_lattice *lattice, int k, unsigned faces, held_layers *layers,
                        ffd_error *error)
{
    if (k < 0 || k >= FFD_MAX_DEGREE)
        return ffd_fail(error, FFD_E_ARGUMENT, "the continuity %d is not 0 to %d", k, FFD_MAX_DEGREE - 1);
    if (faces > FFD_FACES_ALL)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no faces 0x%x", faces);
    layers->k = k;
    bool any = false;
    for (int a = 0; a < 3; a++)
        for (int side = 0; side < 2; side++) {
            bool *const held = &layers->held[a][side];
            *held =
                faces == FFD_FACES_ALL ? !ffd_knots_closed(&lattice->knots[a]) : faces >> (2 * a + side) & 1;
            if (*held)
                TRY(check_face(lattice, a, k, error));
            any = any || *held;
        }
    return any ? FFD_OK : ffd_fail(error, FFD_E_ARGUMENT, "there is no face to hold");
}

static bool is_held(const held_layers *layers, int a, size_t layer, size_t size)
{
    const size_t k = (size_t)layers->k;
    return (layers->held[a][0] && layer <= k) || (layers->held[a][1] && size - 1 - layer <= k);
}

ffd_status ffd_seal_check(const ffd_lattice *lattice, int k, unsigned faces, ffd_error *error)
{
    held_layers layers = {0};
    return begin(lattice, k, faces, &layers, error);
}

/* Puts the control points of held layers back to rest. */
static void hold_layers(const held_layers *layers, made_lattice *made)
{
    for (size_t w = 0, i = 0; w < made->size[2]; w++)
        for (size_t v = 0; v < made->size[1]; v++)
            for (size_t u = 0; u < made->size[0]; u++, i++) {
                if (!is_held(layers, 0, u, made->size[0]) && !is_held(layers, 1, v, made->size[1]) &&
                    !is_held(layers, 2, w, made->size[2]))
                    continue;
                if (made->offsets)
                    memset(made->offsets + 3 * i, 0, 3 * sizeof *made->offsets);
                if (made->moved_weights)
                    made->moved_weights[i] = made->weights[i];
            }
}

ffd_status ffd_lattice_seal(const ffd_lattice *lattice, int k, unsigned faces, ffd_lattice **result,
                            ffd_error *error)
{
    held_layers layers = {0};
    made_lattice made = {0};
    ffd_status status;
    *result = NULL;
    TRY(begin(lattice, k, faces, &layers, error));
    const bool directions[3] = {layers.held[0][0] || layers.held[0][1],
                                layers.held[1][0] || layers.held[1][1],
                                layers.held[2][0] || layers.held[2][1]};
    TRY_END(ffd_made_begin_clamped(lattice, directions, &made, error));
    hold_layers(&layers, &made);
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}
