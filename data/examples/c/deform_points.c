/* deform_points.c - moves points with a lattice.

       deform_points LATTICE <points >moved

   Points are text, one a line: x y z. What the lattice does not reach comes out as it went in. */
#include <ffd/points.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Reads all points of standard input into *xyz (to be freed). Returns their number, 0 where there are none.
 */
static size_t read_points(double **xyz)
{
    size_t count = 0, capacity = 0;
    double p[3];
    *xyz = NULL;
    while (scanf("%lf %lf %lf", &p[0], &p[1], &p[2]) == 3) {
        if (count == capacity) {
            capacity = capacity ? 2 * capacity : 1024;
            double *more = realloc(*xyz, capacity * sizeof p);
            if (!more)
                return 0;
            *xyz = more;
        }
        for (int a = 0; a < 3; a++)
            (*xyz)[3 * count + a] = p[a];
        count++;
    }
    return count;
}

/* A lattice whose "box" is "mesh" has no place of its own: it goes round the points. */
static ffd_status place(ffd_lattice *lattice, const double *xyz, size_t count, ffd_error *error)
{
    double min[3] = {xyz[0], xyz[1], xyz[2]}, max[3] = {xyz[0], xyz[1], xyz[2]};
    for (size_t i = 0; i < 3 * count; i++) {
        min[i % 3] = fmin(min[i % 3], xyz[i]);
        max[i % 3] = fmax(max[i % 3], xyz[i]);
    }
    return ffd_lattice_fit(lattice, min, max, error);
}

/* Points at rest, to be overwritten by where they go. An embedding is made once for a lattice at rest and its
   points: it serves any number of moved lattices, from any thread. */
static ffd_status move(const ffd_lattice *lattice, double *xyz, size_t count, ffd_error *error)
{
    const ffd_span points = {.data = xyz, .count = count, .type = FFD_FLOAT64};
    ffd_embedding_desc desc;
    ffd_embedding *embedding = NULL;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = points;
    ffd_status status = ffd_embedding_create(&desc, NULL, &embedding, error);
    if (!status)
        status = ffd_embedding_deform(embedding, lattice, points, points, NULL, NULL, error);
    ffd_embedding_destroy(&embedding);
    return status;
}

static int deform(const char *path, double *xyz, size_t count)
{
    ffd_lattice *lattice = NULL;
    ffd_error error;
    ffd_status status = ffd_lattice_load(path, &lattice, &error);
    if (!status)
        status = place(lattice, xyz, count, &error);
    if (!status)
        status = move(lattice, xyz, count, &error);
    if (status) {
        char line[2048];
        ffd_error_format(&error, line, sizeof line);
        fprintf(stderr, "deform_points: %s\n", line);
    }
    for (size_t i = 0; i < count && !status; i++)
        printf("%.17g %.17g %.17g\n", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    ffd_lattice_destroy(&lattice);
    return ffd_status_exit_code(status); /* as the program ffd would end */
}

int main(int argc, char **argv)
{
    double *xyz = NULL;
    int code = 1;
    if (argc != 2) {
        fprintf(stderr, "usage: deform_points LATTICE <points >moved\n");
        return 2;
    }
    const size_t count = read_points(&xyz);
    if (!count)
        fprintf(stderr, "deform_points: no points\n");
    else
        code = deform(argv[1], xyz, count);
    free(xyz);
    return code;
}
