/* deform_points LATTICE <points >moved: moves points with a lattice. Points are text, one a line: x y z.
   What the lattice does not reach comes out as it went in. */
#include <ffd/points.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Reads points into *xyz, to be freed, and finds their box; returns their number. */
static size_t read_points(double **xyz, double min[3], double max[3])
{
    size_t count = 0, room = 0;
    for (double p[3]; scanf("%lf %lf %lf", &p[0], &p[1], &p[2]) == 3; count++) {
        if (count == room)
            *xyz = realloc(*xyz, (room = 2 * room + 1024) * sizeof p);
        if (!*xyz)
            return 0;
        for (int a = 0; a < 3; a++) {
            min[a] = count ? fmin(min[a], p[a]) : p[a];
            max[a] = count ? fmax(max[a], p[a]) : p[a];
            (*xyz)[3 * count + a] = p[a];
        }
    }
    return count;
}

int main(int argc, char **argv)
{
    double *xyz = NULL, min[3], max[3];
    const size_t count = argc == 2 ? read_points(&xyz, min, max) : 0;
    const ffd_span points = {.data = xyz, .count = count, .type = FFD_FLOAT64};
    ffd_lattice *lattice = NULL;
    ffd_embedding *embedding = NULL;
    ffd_embedding_desc desc;
    ffd_error error;
    if (count == 0) {
        fprintf(stderr, "usage: deform_points LATTICE <points >moved, of one point at least\n");
        return 2;
    }
    ffd_status status = ffd_lattice_load(argv[1], &lattice, &error);
    if (!status) /* one whose "box" is "mesh" has no place of its own: it goes round the points */
        status = ffd_lattice_fit(lattice, min, max, &error);
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = points;
    if (!status) /* made once for a lattice at rest and points, it serves any number of moved lattices */
        status = ffd_embedding_create(&desc, NULL, &embedding, &error);
    if (!status) /* overwrites the points */
        status = ffd_embedding_deform(embedding, lattice, points, points, NULL, NULL, &error);
    for (size_t i = 0; i < count && !status; i++)
        printf("%.17g %.17g %.17g\n", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    if (status) {
        char line[2048];
        ffd_error_format(&error, line, sizeof line);
        fprintf(stderr, "deform_points: %s\n", line);
    }
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    free(xyz);
    return ffd_status_exit_code(status); /* as the program ffd would end */
}
