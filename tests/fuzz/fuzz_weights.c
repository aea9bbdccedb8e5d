/* fuzz_weights.c - weights of vertices: an array, which begins with the bytes of one, or the text of a
   source. What is accepted moves each vertex by 0 to 1 of the displacement. */
#include "fuzz_target.h"
#include "mutate_text.h"
#include "promise.h"
#include <ffd/job.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define VERTICES 6

static const char mesh[] = "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
                           "property double z\nproperty float mask\nelement face 2\n"
                           "property list uchar int vertex_indices\nend_header\n0 0 0 0\n1 0 0 0.5\n0 1 0 1\n"
                           "1 0 0 2\n0 1 0 -1\n1 1 0 0.25\n3 0 1 2\n3 3 5 4\n";
static const char lattice[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{"
                              "\"min\":[-1,-1,-1],\"max\":[2,2,2]}},\"moves\":[{\"by\":[0,0,1]}]}";

static ffd_status take(void *user, const char *name, const void *bytes, size_t size)
{
    char *const copy = malloc(size + 1);
    (void)name;
    PROMISE(copy, "no memory");
    memcpy(copy, bytes, size);
    copy[size] = 0;
    *(char **)user = copy;
    return FFD_OK;
}

/* Every vertex has moved along z by its weight: their mean is that of the result. */
static void check_moved(const char *written, const ffd_job_result *result)
{
    double sum = 0;
    const char *at = strstr(written, "end_header\n");
    PROMISE(at, "no head is written");
    at += strlen("end_header\n");
    for (int v = 0; v < VERTICES; v++) {
        char *end;
        strtod(at, &end);
        strtod(end, &end);
        const double moved = strtod(end, &end);
        PROMISE(moved >= 0 && moved <= 1, "vertex %d moves by %g", v, moved);
        sum += moved;
        at = strchr(end, '\n') + 1;
    }
    PROMISE(fabs(sum / VERTICES - result->weight.mean) < 1e-12, "the mean is %g, not %g", result->weight.mean,
            sum / VERTICES);
    PROMISE(result->weight.zero + result->weight.one <= VERTICES && result->weight.clamped <= VERTICES,
            "more weights than vertices");
}

static void deform(const char *source, const void *bytes, size_t size)
{
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    char *written = NULL;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input = (ffd_source){.path = "in.ply", .bytes = {mesh, sizeof mesh - 1}};
    desc.lattices = &(ffd_lattice_source){.text = {lattice, sizeof lattice - 1}};
    desc.lattice_count = 1;
    desc.weight = (ffd_weight_source){source, {bytes, size}};
    desc.output = "out.ply";
    desc.sink = take;
    desc.sink_user = &written;
    desc.threads = 1;
    const ffd_status status = ffd_deform_run(&desc, &result, &error);
    PROMISE(!status == (written != NULL), "status %d, and %s output", status, written ? "an" : "no");
    PROMISE(!status || (error.status == status && error.message[0] && !strpbrk(error.message, "\r\n")),
            "status %d says '%s'", status, error.message);
    PROMISE(!status || status == FFD_E_INVALID || status == FFD_E_LIMIT, "status %d: %s", status,
            error.message);
    if (!status)
        check_moved(written, &result);
    free(written);
}

static void check_text(const uint8_t *data, size_t size)
{
    ffd_error error;
    char *const text = malloc(size + 1);
    PROMISE(text, "no memory");
    memcpy(text, data, size);
    text[size] = 0;
    const ffd_status status = ffd_weight_check(text, &error);
    const char *const file = ffd_weight_file(text);
    PROMISE(status == FFD_OK || status == FFD_E_ARGUMENT, "status %d of '%s'", status, text);
    PROMISE(!status || (error.message[0] && !strpbrk(error.message, "\r\n")), "'%s' is refused by '%s'", text,
            error.message);
    PROMISE(!file || (!status && file >= text && strcmp(file, text + strlen(text) - strlen(file)) == 0),
            "'%s' names the file '%s'", text, file);
    if (!status && !file)
        deform(text, NULL, 0);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size > 0 && data[0] == 0x93)
        deform(NULL, data, size);
    else
        check_text(data, size);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_text(data, size, capacity, seed, ":1-.npycolrgbajtwx'(, )<>f48\n\xff");
}
