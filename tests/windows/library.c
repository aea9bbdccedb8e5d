/* library.c - a program that links the library alone, as the Python package loads it: "points LATTICE POINTS
   RESULTS" embeds and deforms points (x, y, z as doubles in one file) in all ways that arrays know, and
   writes what comes out; "file IN OUT LATTICE" deforms a mesh; "batch MANIFEST" does a batch, and prints how
   many jobs were done. */
#include <ffd/ffd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ffd_error error;

/* Ends the program if a call has failed. */
static void require(ffd_status status)
{
    if (!status)
        return;
    fprintf(stderr, "%s\n", error.message);
    exit(ffd_status_exit_code(status));
}

static void *room(size_t count, size_t size)
{
    void *const block = calloc(count ? count : 1, size);
    if (!block)
        exit(1);
    return block;
}

static double *read_points(const char *path, size_t *count)
{
    FILE *const file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        exit(1);
    *count = (size_t)ftell(file) / (3 * sizeof(double));
    double *const xyz = room(*count, 3 * sizeof *xyz);
    rewind(file);
    if (fread(xyz, 3 * sizeof *xyz, *count, file) != *count)
        exit(1);
    fclose(file);
    return xyz;
}

/* Lays the box of a lattice that has none round the points. */
static ffd_lattice *load_lattice(const char *path, const double *xyz, size_t count)
{
    ffd_lattice *lattice;
    require(ffd_lattice_load(path, &lattice, &error));
    if (!ffd_lattice_needs_bounds(lattice))
        return lattice;
    double low[3], high[3];
    for (int d = 0; d < 3; d++) {
        low[d] = high[d] = xyz[d];
        for (size_t i = 0; i < count; i++) {
            low[d] = xyz[3 * i + d] < low[d] ? xyz[3 * i + d] : low[d];
            high[d] = xyz[3 * i + d] > high[d] ? xyz[3 * i + d] : high[d];
        }
    }
    require(ffd_lattice_fit(lattice, low, high, &error));
    return lattice;
}

static void write_basis(const ffd_embedding *embedding, const ffd_lattice *lattice, FILE *to)
{
    ffd_csr basis;
    require(ffd_embedding_basis(embedding, ffd_lattice_get_weights(lattice, FFD_VOLUME_DEFORMED), &basis,
                                NULL, &error));
    fwrite(basis.indices, sizeof *basis.indices, basis.starts[basis.rows], to);
    fwrite(basis.values, sizeof *basis.values, basis.starts[basis.rows], to);
    ffd_csr_free(&basis);
}

/* u,v,w first, then the statuses, positions, gradients, normals by these, and the derivatives. */
static void write_results(const ffd_lattice *lattice, ffd_span points, size_t number, FILE *to)
{
    ffd_embedding_desc desc;
    ffd_embedding *embedding;
    const size_t count = points.count;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = points;
    require(ffd_embedding_create(&desc, NULL, &embedding, &error));
    double *const gradients = room(count, 9 * sizeof *gradients);
    ffd_span moved = points, normals = points;
    moved.data = room(count, 3 * number);
    normals.data = room(count, 3 * number);
    require(ffd_embedding_deform(embedding, lattice, points, moved, gradients, NULL, &error));
    require(ffd_normals_deform(gradients, points, normals, NULL, NULL, &error));
    fwrite(ffd_embedding_get_uvw(embedding), 3 * sizeof(double), count, to);
    fwrite(ffd_embedding_get_status(embedding), 1, count, to);
    fwrite(moved.data, 3 * number, count, to);
    fwrite(gradients, 9 * sizeof *gradients, count, to);
    fwrite(normals.data, 3 * number, count, to);
    write_basis(embedding, lattice, to);
    free(moved.data);
    free(normals.data);
    free(gradients);
    ffd_embedding_destroy(&embedding);
}

static int do_points(const char *path, const char *points, const char *results)
{
    size_t count;
    double *const xyz = read_points(points, &count);
    float *const narrow = room(count, 3 * sizeof *narrow);
    for (size_t i = 0; i < 3 * count; i++)
        narrow[i] = (float)xyz[i];
    ffd_lattice *lattice = load_lattice(path, xyz, count);
    FILE *const to = fopen(results, "wb");
    if (!to)
        return 1;
    write_results(lattice, (ffd_span){.data = xyz, .count = count, .type = FFD_FLOAT64}, sizeof *xyz, to);
    write_results(lattice, (ffd_span){.data = narrow, .count = count, .type = FFD_FLOAT32}, sizeof *narrow,
                  to);
    ffd_lattice_destroy(&lattice);
    free(narrow);
    free(xyz);
    return fclose(to) != 0;
}

static int do_file(const char *input, const char *output, const char *lattice)
{
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc_init(&desc, sizeof desc);
    const ffd_lattice_source lattices[] = {{.path = lattice}};
    desc.input.path = input;
    desc.output = output;
    desc.lattices = lattices;
    desc.lattice_count = 1;
    require(ffd_deform_run(&desc, &result, &error));
    return 0;
}

static int do_batch(const char *manifest)
{
    ffd_batch_desc desc;
    ffd_batch_result result = {.struct_size = sizeof result};
    ffd_batch_desc_init(&desc, sizeof desc);
    desc.manifest = manifest;
    desc.workers = 2;
    require(ffd_batch_run(&desc, &result, &error));
    printf("%d\n", (int)result.done);
    return result.failed != 0;
}

int main(int argc, char **argv)
{
    const char *const what = argc > 1 ? argv[1] : "";
    if (argc == 5 && strcmp(what, "points") == 0)
        return do_points(argv[2], argv[3], argv[4]);
    if (argc == 5 && strcmp(what, "file") == 0)
        return do_file(argv[2], argv[3], argv[4]);
    if (argc == 3 && strcmp(what, "batch") == 0)
        return do_batch(argv[2]);
    return 2;
}
