/* caller.c - a program that was written with the headers of 0.3, as they are kept. It links the library of
   today, which must take its structs as they were, and write nothing behind them. */
#include "ffd-0.3.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BEHIND 0x5a

/* One of a struct, with bytes behind it that nobody may touch. */
#define GUARDED(type, name)                                                                                  \
    struct {                                                                                                 \
        type as;                                                                                             \
        unsigned char behind[512];                                                                           \
    } name;                                                                                                  \
    memset(&name, BEHIND, sizeof name)

static int failures;

static void expect(bool holds, const char *what)
{
    failures += !holds;
    if (!holds)
        printf("caller.c: %s\n", what);
}

static void untouched(const unsigned char behind[512], const char *what)
{
    for (int i = 0; i < 512; i++)
        if (behind[i] != BEHIND) {
            expect(false, what);
            return;
        }
}

static ffd_lattice *make_lattice(void)
{
    ffd_lattice *lattice = NULL;
    GUARDED(ffd_lattice_arrays, arrays);
    ffd_lattice_arrays_init(&arrays.as, sizeof arrays.as);
    untouched(arrays.behind, "ffd_lattice_arrays_init");
    for (int a = 0; a < 3; a++) {
        arrays.as.size[a] = 4;
        arrays.as.box_max[a] = 1;
    }
    expect(ffd_lattice_from_arrays(&arrays.as, &lattice, NULL) == FFD_OK, "ffd_lattice_from_arrays");
    const size_t corner = 63;
    const double to[3] = {1, 1, 2};
    expect(ffd_lattice_set_points(lattice, &corner, 1, to, NULL) == FFD_OK, "ffd_lattice_set_points");
    return lattice;
}

static void deform_arrays(const ffd_lattice *lattice)
{
    double xyz[6] = {0.5, 0.5, 0.5, 1, 1, 1}, out[6];
    ffd_embedding *embedding = NULL;
    GUARDED(ffd_embedding_desc, desc);
    ffd_embedding_desc_init(&desc.as, sizeof desc.as);
    untouched(desc.behind, "ffd_embedding_desc_init");
    GUARDED(ffd_run_options, options);
    ffd_run_options_init(&options.as, sizeof options.as);
    untouched(options.behind, "ffd_run_options_init");
    desc.as.lattice = lattice;
    desc.as.points = (ffd_span){xyz, 2, FFD_FLOAT64, 0, 0};
    options.as.threads = 1;
    expect(ffd_embedding_create(&desc.as, &options.as, &embedding, NULL) == FFD_OK, "ffd_embedding_create");
    expect(ffd_embedding_deform(embedding, lattice, desc.as.points, (ffd_span){out, 2, FFD_FLOAT64, 0, 0},
                                NULL, &options.as, NULL) == FFD_OK &&
               out[2] == 0.5 + 1.0 / 512 && out[5] == 2,
           "ffd_embedding_deform");
    ffd_embedding_destroy(&embedding);
}

static void find_results(const ffd_lattice *lattice)
{
    GUARDED(ffd_folds, folds);
    folds.as.struct_size = sizeof folds.as;
    expect(ffd_folds_find(lattice, 1, &folds.as, NULL) == FFD_OK && folds.as.verdict == FFD_FOLDS_NONE,
           "ffd_folds_find");
    untouched(folds.behind, "ffd_folds_find");
    ffd_locator *locator = NULL;
    GUARDED(ffd_location, found);
    const double middle[3] = {0.5, 0.5, 0.5};
    expect(ffd_locator_create(lattice, &locator, NULL) == FFD_OK &&
               ffd_locator_locate(locator, middle, 1, NULL, &found.as, sizeof found.as, NULL) == FFD_OK &&
               found.as.status == FFD_VERTEX_INSIDE && found.as.uvw[0] == 0.5,
           "ffd_locator_locate");
    untouched(found.behind, "ffd_locator_locate");
    ffd_locator_destroy(&locator);
}

static void run_jobs(const ffd_lattice *lattice, const char *mesh, const char *output)
{
    char file[1024];
    snprintf(file, sizeof file, "%s.json", output);
    expect(ffd_lattice_save(lattice, file, true, NULL) == FFD_OK, "ffd_lattice_save");
    const ffd_lattice_source lattices[] = {{.path = file}};
    GUARDED(ffd_deform_desc, desc);
    GUARDED(ffd_job_result, result);
    ffd_deform_desc_init(&desc.as, sizeof desc.as);
    untouched(desc.behind, "ffd_deform_desc_init");
    desc.as.input.path = mesh;
    desc.as.output = output;
    desc.as.lattices = lattices;
    desc.as.lattice_count = 1;
    desc.as.force = desc.as.quality = true;
    result.as.struct_size = sizeof result.as;
    expect(ffd_deform_run(&desc.as, &result.as, NULL) == FFD_OK && result.as.folds.is_known &&
               result.as.vertices == 8,
           "ffd_deform_run");
    untouched(result.behind, "ffd_deform_run");
    GUARDED(ffd_compare_desc, compare);
    GUARDED(ffd_comparison, comparison);
    ffd_compare_desc_init(&compare.as, sizeof compare.as);
    untouched(compare.behind, "ffd_compare_desc_init");
    compare.as.a.path = mesh;
    compare.as.b.path = output;
    comparison.as.struct_size = sizeof comparison.as;
    expect(ffd_compare_run(&compare.as, &comparison.as, NULL) == FFD_OK && comparison.as.differences == 1,
           "ffd_compare_run");
    untouched(comparison.behind, "ffd_compare_run");
}

/* caller MESH OUTPUT: a cube of eight corners, and where to write. */
int main(int count, char **arguments)
{
    if (count != 3)
        return 2;
    ffd_lattice *lattice = make_lattice();
    deform_arrays(lattice);
    find_results(lattice);
    run_jobs(lattice, arguments[1], arguments[2]);
    ffd_lattice_destroy(&lattice);
    return failures != 0;
}
