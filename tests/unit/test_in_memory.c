/* test_in_memory.c - jobs with meshes and lattices in memory, and outputs to a sink. The results are, byte
   for byte, those of jobs on files, and no file is touched. */
#define _GNU_SOURCE /* mkdtemp, nftw, memmem */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include <ffd/ffd.h>
#include <ffd/jacobian.h>
#include <ftw.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <sys/stat.h>

#define MOST 12
#define PICTURE "\x89PNG\r\n\x1a\n..."

static const char lattice_text[] =
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,3,3],\"rest\":{\"box\":\"mesh\"},"
    "\"moves\":[{\"at\":[2,\"all\",\"all\"],\"by\":[0.25,0.125,1]}]}";
static const char open_text[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{"
                                "\"box\":{\"min\":[-1,-1,-1],\"max\":[2,2,2]}},"
                                "\"moves\":[{\"by\":[0,{\"$\":\"lift\"},1]}]}";

/* The files of an input, or of an output. */
typedef struct named {
    char name[200];
    unsigned char *bytes;
    size_t size;
} named;

typedef struct name_list {
    named files[MOST];
    size_t count;
} name_list;

static void add(name_list *list, const char *name, const void *bytes, size_t size)
{
    assert_true(list->count < MOST);
    named *const file = &list->files[list->count++];
    snprintf(file->name, sizeof file->name, "%s", name);
    /* Misaligned, and without a byte behind. */
    file->bytes = (unsigned char *)malloc(size + 1) + 1;
    file->size = size;
    memcpy(file->bytes, bytes, size);
}

static void add_text(name_list *list, const char *name, const char *text)
{
    add(list, name, text, strlen(text));
}

static void clear(name_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->files[i].bytes - 1);
    list->count = 0;
}

static const named *find(const name_list *list, const char *name)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->files[i].name, name) == 0)
            return &list->files[i];
    return NULL;
}

/* The callbacks */

typedef struct resolver {
    const name_list *files;
    size_t calls;
    const char *fails; /* fail at this name */
    ffd_status with;   /* with this status */
} resolver;

static ffd_status resolve(void *user, const char *name, ffd_bytes *bytes)
{
    resolver *const r = user;
    const named *const file = find(r->files, name);
    r->calls++;
    if (r->fails && strcmp(r->fails, name) == 0) {
        bytes->size = 3; /* and NULL */
        return r->with;
    }
    if (file)
        *bytes = (ffd_bytes){file->bytes, file->size};
    return FFD_OK;
}

typedef struct sink {
    name_list files;
    size_t takes; /* fails after this many */
    ffd_status with;
} sink;

static ffd_status take(void *user, const char *name, const void *bytes, size_t size)
{
    sink *const s = user;
    assert_non_null(bytes);
    if (s->with && s->files.count >= s->takes)
        return s->with;
    add(&s->files, name, bytes, size);
    return FFD_OK;
}

static char logged[8192];

static void note(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    snprintf(logged + strlen(logged), sizeof logged - strlen(logged), "%d %s\n", (int)level, line);
}

/* Meshes */

static void put_number(unsigned char *to, uint32_t number)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(number >> 8 * i);
}

/* Three points of float32, little-endian. */
static const unsigned char points[36] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,    0x80, 0x3f, 0, 0,
                                         0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 0,    0,    0, 0x3f};

#define GLTF_REST                                                                                            \
    "\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0,"     \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,"    \
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,2,0.5]}],"              \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]"

static void make_gltf(name_list *files)
{
    add_text(files, "head.gltf",
             "{" GLTF_REST ",\"images\":[{\"uri\":\"tex/"
             "skin.png\"},{\"uri\":\"lost.png\"}],\"buffers\":[{\"byteLength\":36,\"uri\":"
             "\"head.bin\"}]}");
    add(files, "head.bin", points, sizeof points);
    add_text(files, "tex/skin.png", PICTURE);
}

static void make_glb(name_list *files)
{
    static const char json[] = "{" GLTF_REST ",\"buffers\":[{\"byteLength\":36}]}";
    const size_t length = (sizeof json - 1 + 3) / 4 * 4;
    unsigned char bytes[1024];
    memset(bytes, ' ', sizeof bytes);
    memcpy(bytes, "glTF", 4);
    put_number(bytes + 4, 2);
    put_number(bytes + 8, (uint32_t)(12 + 8 + length + 8 + 36));
    put_number(bytes + 12, (uint32_t)length);
    memcpy(bytes + 16, "JSON", 4);
    memcpy(bytes + 20, json, sizeof json - 1);
    put_number(bytes + 20 + length, 36);
    memcpy(bytes + 24 + length, "BIN\0", 4);
    memcpy(bytes + 28 + length, points, 36);
    add(files, "head.glb", bytes, 28 + length + 36);
}

static void make_obj(name_list *files)
{
    add_text(files, "head.obj",
             "mtllib mats\\head.mtl\nv 0 0 0\nv 1 0.25 0\nv 0 2 0.5\nvn 0 0 1\nusemtl a\nf 1//1 2//1 3//1\n");
    add_text(files, "mats/head.mtl", "newmtl a\nKd 1 1 1\nmap_Kd ../skin.png\nmap_Ks lost.png\n");
    add_text(files, "skin.png", PICTURE);
}

static void make_ply(name_list *files)
{
    static const char head[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty "
        "float y\nproperty float z\nend_header\n";
    char bytes[300];
    memcpy(bytes, head, sizeof head - 1);
    memcpy(bytes + sizeof head - 1, points, sizeof points);
    add(files, "head.ply", bytes, sizeof head - 1 + sizeof points);
}

static void make_off(name_list *files)
{
    add_text(files, "head.off", "OFF\n3 1 0\n0 0 0\n1 0.25 0\n0 2 0.5\n3 0 1 2\n");
}

static void make_stl(name_list *files)
{
    unsigned char bytes[134] = "binary";
    put_number(bytes + 80, 1);
    memcpy(bytes + 96, points, sizeof points);
    add(files, "head.stl", bytes, sizeof bytes);
}

#define FOAM(class) "FoamFile { format ascii; class " class "; }\n"

/* A tetrahedron, whose neighbour is missing as it has none. */
static void make_foam(name_list *files)
{
    add_text(files, "points", FOAM("vectorField") "4((0 0 0) (1 0.25 0) (0 2 0.5) (0 0 1))\n");
    add_text(files, "faces", FOAM("faceList") "4(3(0 2 1) 3(0 1 3) 3(1 2 3) 3(2 0 3))\n");
    add_text(files, "owner", FOAM("labelList") "4{0}\n");
    add_text(files, "boundary", FOAM("polyBoundaryMesh") "1(all { nFaces 4; startFace 0; })\n");
}

/* Points alone, with a warning. */
static void make_foam_points(name_list *files)
{
    add_text(files, "points", FOAM("vectorField") "4((0 0 0) (1 0.25 0) (0 2 0.5) (0 0 1))\n");
}

/* Writes the input of both kinds of jobs. */

static void put_all(const name_list *files, const char *under)
{
    for (size_t i = 0; i < files->count; i++) {
        char name[300];
        snprintf(name, sizeof name, "%s/%s", under, files->files[i].name);
        for (char *slash = strchr(name, '/'); slash; slash = strchr(slash + 1, '/')) {
            *slash = 0;
            mkdir(in_folder(name), 0777);
            *slash = '/';
        }
        put(name, files->files[i].bytes, files->files[i].size);
    }
}

static size_t files_found;

static int count_file(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)path, (void)info, (void)place;
    files_found += kind == FTW_F;
    return 0;
}

static size_t files_in(const char *name)
{
    files_found = 0;
    assert_int_equal(nftw(in_folder(name), count_file, 8, FTW_PHYS), 0);
    return files_found;
}

/* Checks that the files of a folder are those that the sink received. */
static void check_same(const name_list *taken, const char *where)
{
    for (size_t i = 0; i < taken->count; i++) {
        const named *const file = &taken->files[i];
        FILE *const output_set = fopen(file->name, "rb");
        if (!output_set)
            fail_msg("\"%s\" is not written", file->name);
        unsigned char *const bytes = malloc(file->size + 1);
        if (fread(bytes, 1, file->size + 1, output_set) != file->size)
            fail_msg("\"%s\" has another size", file->name);
        assert_memory_equal(bytes, file->bytes, file->size);
        free(bytes);
        fclose(output_set);
    }
    assert_int_equal(files_in(where), taken->count);
}

static void empty_folder(const char *name)
{
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", in_folder(name));
    assert_int_equal(system(command), 0);
    assert_int_equal(mkdir(in_folder(name), 0777), 0);
}

typedef struct both {
    name_list given;
    resolver resolver;
    sink sink;
    ffd_deform_desc desc;
    ffd_lattice *lattice;
    ffd_lattice_source source; /* that lattice, under the name of its file */
    char input[200], output[200], path[200];
} both;

/* Starts a job in memory, with the names that the files will have. */
static void begin(both *b, void (*make)(name_list *), const char *output)
{
    *b = (both){0};
    make(&b->given);
    empty_folder("in");
    empty_folder("out");
    snprintf(b->input, sizeof b->input, "%s/in/%s", folder, b->given.files[0].name);
    snprintf(b->output, sizeof b->output, "%s/out/%s", folder, output);
    snprintf(b->path, sizeof b->path, "%s/in/l.json", folder);
    assert_int_equal(ffd_lattice_parse(lattice_text, strlen(lattice_text), "l.json", &b->lattice, NULL),
                     FFD_OK);
    b->source = (ffd_lattice_source){.path = b->path, .object = b->lattice};
    b->resolver.files = &b->given;
    ffd_deform_desc_init(&b->desc, sizeof b->desc);
    b->desc.input = (ffd_source){.path = b->input,
                                 .bytes = {b->given.files[0].bytes, b->given.files[0].size},
                                 .resolve = resolve,
                                 .resolve_user = &b->resolver};
    b->desc.output = b->output;
    b->desc.lattice_count = 1;
    b->desc.lattices = &b->source;
    b->desc.threads = 2;
    b->desc.log = note;
    b->desc.sink = take;
    b->desc.sink_user = &b->sink;
    logged[0] = 0;
}

/* Gives the same input to a job on files. */
static void use_files(both *b)
{
    assert_int_equal(files_in("out"), 0);
    put_all(&b->given, "in");
    put_text("in/l.json", lattice_text);
    b->desc.input = (ffd_source){.path = b->input};
    b->source = (ffd_lattice_source){.path = b->path};
    b->desc.lattices = &b->source;
    b->desc.sink = NULL;
    logged[0] = 0;
}

static void end(both *b)
{
    clear(&b->given);
    clear(&b->sink.files);
    ffd_lattice_destroy(&b->lattice);
}

/* Checks that both jobs write the same and log the same. */
static void compare_jobs(void (*make)(name_list *), const char *output, size_t files)
{
    both b;
    ffd_job_result in_memory = {.struct_size = sizeof in_memory}, on_files = in_memory;
    ffd_error error = {0};
    char lines[sizeof logged];
    begin(&b, make, output);
    if (ffd_deform_run(&b.desc, &in_memory, &error))
        fail_msg("%s: %s", error.file, error.message);
    memcpy(lines, logged, sizeof lines);
    use_files(&b);
    assert_int_equal(ffd_deform_run(&b.desc, &on_files, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, files);
    assert_string_equal(b.sink.files.files[files - 1].name, b.output); /* the mesh comes last */
    check_same(&b.sink.files, "out");
    assert_string_equal(lines, logged);
    assert_memory_equal(in_memory.counts, on_files.counts, sizeof on_files.counts);
    assert_memory_equal(&in_memory.bounds.after, &on_files.bounds.after, sizeof on_files.bounds.after);
    assert_int_equal(in_memory.moved, on_files.moved);
    assert_true(in_memory.moved > 0);
    end(&b);
}

static void every_format_gives_the_bytes_of_the_files(void **state)
{
    compare_jobs(make_obj, "head.obj", 3); /* with library and map */
    compare_jobs(make_gltf, "moved.gltf", 3);
    compare_jobs(make_glb, "head.glb", 1);
    compare_jobs(make_ply, "head.ply", 1);
    compare_jobs(make_off, "head.off", 1);
    compare_jobs(make_stl, "head.stl", 1);
    compare_jobs(make_foam, "points", 1);
    compare_jobs(make_foam_points, "points", 1);
    (void)state;
}

static void so_does_every_conversion(void **state)
{
    compare_jobs(make_gltf, "head.glb", 1); /* the picture is in it */
    compare_jobs(make_glb, "head.gltf", 2);
    compare_jobs(make_obj, "head.gltf", 2);
    compare_jobs(make_stl, "head.obj", 1);
    compare_jobs(make_off, "head.glb", 1);
    compare_jobs(make_gltf, "head.ply", 1);
    (void)state;
}

static void one_of_both_may_be_a_file(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    begin(&b, make_gltf, "head.gltf");
    b.desc.sink = NULL; /* to files */
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(files_in("out"), 3);
    put_all(&b.given, "in");
    b.desc.input = (ffd_source){.path = b.input};
    b.desc.sink = take;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK); /* --force is not needed */
    assert_int_equal(b.sink.files.count, 3);
    check_same(&b.sink.files, "out");
    /* An output's name that is the path of the input means no file. */
    clear(&b.sink.files);
    b.desc.output = b.input;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, 3);
    clear(&b.sink.files);
    b.desc.output = b.output;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    check_same(&b.sink.files, "out"); /* as before: the input is as it was */
    end(&b);
    (void)state;
}

/* Without a name, a format is needed. A name need not have a folder. Each file is requested once. */
static void names_are_the_callers(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    begin(&b, make_gltf, "");
    b.desc.input.path = NULL;
    b.desc.input.format = FFD_FORMAT_GLTF;
    b.desc.output = "moved.gltf";
    b.source.path = NULL;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, 3);
    assert_non_null(find(&b.sink.files, "moved.bin"));
    assert_non_null(find(&b.sink.files, "tex/skin.png"));
    assert_string_equal(b.sink.files.files[2].name, "moved.gltf");
    assert_int_equal(b.resolver.calls, 3);
    assert_string_equal(logged, "0 the image \"lost.png\" is missing and was not copied\n");
    clear(&b.sink.files);
    b.desc.input.path = "head.gltf"; /* the input's name as the output is not a conflict */
    b.desc.output = "head.gltf";
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_non_null(find(&b.sink.files, "head.bin"));
    clear(&b.sink.files);
    b.desc.dry_run = true;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
    (void)state;
}

/* A name that ends like a folder is refused. */
static void names_that_are_no_files_are_refused(void **state)
{
    static const char *const names[] = {"", "/", ".", "..", "in/", "in/..", "-", "/dev/stdin"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (int which = 0; which < 2; which++) {
            both b;
            ffd_job_result result = {.struct_size = sizeof result};
            ffd_error error;
            begin(&b, make_off, "head.off");
            b.desc.input.format = b.desc.output_format = FFD_FORMAT_OFF;
            *(which ? &b.desc.output : &b.desc.input.path) = names[i];
            assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
            assert_non_null(strstr(error.message, "is no name for a file"));
            assert_int_equal(b.sink.files.count, 0);
            end(&b);
        }
    (void)state;
}

/* Relative paths in a lattice text lead nowhere, even if such a file exists. */
static void a_text_names_no_meshes(void **state)
{
    static const char around[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,3,3],"
                                 "\"rest\":{\"box\":{\"meshes\":[\"head.off\"]}}}";
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    begin(&b, make_off, "head.off");
    put_all(&b.given, "in");
    b.source = (ffd_lattice_source){.path = b.path, .text = {around, sizeof around - 1}};
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.file, b.path);
    assert_non_null(strstr(error.message, "cannot be read from memory"));
    end(&b);
    (void)state;
}

static void texts_of_lattices_have_values(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    begin(&b, make_off, "head.off");
    const ffd_setting set = {"lift", "0.5"};
    b.source = (ffd_lattice_source){.text = {open_text, strlen(open_text)}};
    ffd_error error;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_INVALID);
    assert_string_equal(error.file, "lattice 1");
    b.desc.set = &set;
    b.desc.set_count = 1;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_true(memmem(b.sink.files.files[0].bytes, b.sink.files.files[0].size, "0 2.5 1.5", 9));
    assert_int_equal(ffd_check_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(result.moved, 3);
    end(&b);
    (void)state;
}

/* The report of several morph targets names the lattice of each, even of one without a name. */
static void check_lattice_names(const ffd_deform_desc *callers, const char *second)
{
    ffd_deform_desc desc = *callers;
    ffd_job_result targets[2] = {{.struct_size = sizeof *targets}, {.struct_size = sizeof *targets}};
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_report *report;
    sink s = {0};
    desc.morph_results = targets;
    desc.dry_run = true;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(ffd_report_create_sink("r.json", true, take, &s, &report, NULL), FFD_OK);
    assert_int_equal(ffd_report_add(report, "a.gltf", "b.gltf", &result, NULL), FFD_OK);
    assert_int_equal(ffd_report_write(report, NULL), FFD_OK);
    assert_non_null(memmem(s.files.files[0].bytes, s.files.files[0].size, second, strlen(second)));
    ffd_report_destroy(&report);
    clear(&s.files);
}

static void several_morph_targets_are_made(void **state)
{
    both b;
    ffd_lattice *second;
    ffd_job_result result = {.struct_size = sizeof result};
    begin(&b, make_gltf, "head.gltf");
    assert_int_equal(ffd_lattice_copy(b.lattice, &second, NULL), FFD_OK);
    static const char *const names[] = {"wide", "tall"};
    char other[200];
    snprintf(other, sizeof other, "%s/in/k.json", folder);
    ffd_lattice_source lattices[] = {{.path = b.path, .object = b.lattice},
                                     {.path = other, .object = second}};
    b.desc.lattice_count = 2;
    b.desc.lattices = lattices;
    b.desc.morphs = names;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(result.morphs.count, 2);
    assert_ptr_equal(result.morphs.lattices, lattices);
    check_lattice_names(&b.desc, "k.json\"");
    lattices[1].path = NULL;
    check_lattice_names(&b.desc, "\"lattice 2\"");
    use_files(&b);
    put_text("in/k.json", lattice_text);
    lattices[0] = (ffd_lattice_source){.path = b.path};
    lattices[1] = (ffd_lattice_source){.path = other};
    b.desc.lattices = lattices;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    check_same(&b.sink.files, "out");
    ffd_lattice_destroy(&second);
    end(&b);
    (void)state;
}

static void embeddings_pass_through_memory(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_embed_desc embed;
    begin(&b, make_gltf, "head.gltf");
    ffd_embed_desc_init(&embed, sizeof embed);
    embed.input = b.desc.input;
    embed.lattice.object = b.lattice;
    char uvw[200], statuses[200];
    snprintf(uvw, sizeof uvw, "%s/out/e.npy", folder);
    snprintf(statuses, sizeof statuses, "%s/out/s.npy", folder);
    embed.output = uvw;
    embed.status_output = statuses;
    embed.sink = take;
    embed.sink_user = &b.sink;
    assert_int_equal(ffd_embed_run(&embed, &result, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, 2);
    const named *const made = find(&b.sink.files, uvw);
    sink deformed = {0};
    b.desc.embedding.bytes = (ffd_bytes){made->bytes, made->size};
    b.desc.sink_user = &deformed;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(deformed.files.count, 3);
    b.desc.embedding.bytes.size--;
    ffd_error error;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_INVALID);
    assert_string_equal(error.file, "embedding");
    use_files(&b);
    embed.input = b.desc.input;
    embed.lattice = (ffd_lattice_source){.path = b.path};
    embed.sink = NULL;
    assert_int_equal(ffd_embed_run(&embed, &result, NULL), FFD_OK);
    check_same(&b.sink.files, "out");
    clear(&deformed.files);
    end(&b);
    (void)state;
}

static void other_jobs_take_memory_too(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_info_desc info;
    ffd_compare_desc compare;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    char *ours, *theirs, output[200];
    begin(&b, make_gltf, "head.gltf");
    ffd_info_desc_init(&info, sizeof info);
    info.file = b.desc.input;
    info.json = info.parts = true;
    assert_int_equal(ffd_info_run(&info, &ours, NULL), FFD_OK);
    ffd_compare_desc_init(&compare, sizeof compare);
    compare.a = compare.b = b.desc.input;
    assert_int_equal(ffd_compare_run(&compare, &comparison, NULL), FFD_OK);
    assert_true(comparison.equal && comparison.positions_compared == 3);
    ffd_lattice_desc shape;
    ffd_lattice_new_desc made;
    ffd_lattice_desc_init(&shape, sizeof shape);
    ffd_lattice_new_desc_init(&made, sizeof made);
    snprintf(output, sizeof output, "%s/out/new.json", folder);
    made.meshes = &b.desc.input;
    made.mesh_count = 1;
    made.lattice = &shape;
    made.output = output;
    made.sink = take;
    made.sink_user = &b.sink;
    assert_int_equal(ffd_lattice_new_run(&made, NULL), FFD_OK);
    static const char text[] =
        "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": "
        "\"mesh\"}, \"moves\": [{\"at\": [1, 1, 1], \"by\": [1, 0, 0]}]}";
    ffd_refine_desc finer;
    ffd_author_desc refine;
    char refined[4096];
    ffd_refine_desc_init(&finer, sizeof finer);
    ffd_author_desc_init(&refine, sizeof refine);
    snprintf(refined, sizeof refined, "%s/out/refined.json", folder);
    finer.size[1] = 6;
    refine.lattice = (ffd_lattice_source){.text = {text, sizeof text - 1}};
    refine.meshes = &b.desc.input;
    refine.mesh_count = 1;
    refine.output = refined;
    refine.sink = take;
    refine.sink_user = &b.sink;
    assert_int_equal(ffd_lattice_refine_run(&refine, &finer, NULL, NULL), FFD_OK);
    ffd_shared_box *box;
    assert_int_equal(ffd_shared_box_create(&box, NULL), FFD_OK);
    assert_int_equal(ffd_shared_box_add(box, &b.desc, NULL), FFD_OK);
    b.desc.shared_box = box;
    assert_int_equal(ffd_check_run(&b.desc, &result, NULL), FFD_OK);
    ffd_shared_box_destroy(&box);
    b.desc.shared_box = NULL;
    use_files(&b);
    info.file = b.desc.input;
    assert_int_equal(ffd_info_run(&info, &theirs, NULL), FFD_OK);
    assert_string_equal(ours, theirs);
    made.sink = refine.sink = NULL;
    assert_int_equal(ffd_lattice_new_run(&made, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_refine_run(&refine, &finer, NULL, NULL), FFD_OK);
    check_same(&b.sink.files, "out");
    ffd_free(ours);
    ffd_free(theirs);
    end(&b);
    (void)state;
}

static void pictures_pages_and_derivatives_go_to_a_sink(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    static const char *const names[] = {"v.png", "v.html", "j.npz"};
    char paths[3][200];
    ffd_view_desc view;
    ffd_jacobian_desc jacobian;
    begin(&b, make_obj, "head.obj");
    ffd_view_desc_init(&view, sizeof view);
    ffd_jacobian_desc_init(&jacobian, sizeof jacobian);
    view.job = jacobian.job = &b.desc;
    view.width = view.height = 64;
    view.sink_user = &b.sink;
    for (int pass = 0; pass < 2; pass++) {
        view.sink = b.desc.sink;
        for (int i = 0; i < 3; i++) {
            snprintf(paths[i], sizeof paths[i], "%s/out/%s", folder, names[i]);
            view.output = jacobian.output = paths[i];
            view.width = view.height = i == 0 ? 64 : 0;
            assert_int_equal(
                i < 2 ? ffd_view_run(&view, &result, NULL) : ffd_jacobian_run(&jacobian, NULL, NULL), FFD_OK);
            if (i == 0)
                assert_ptr_equal(result.picture, paths[0]);
        }
        if (pass == 0)
            use_files(&b);
    }
    assert_int_equal(b.sink.files.count, 3);
    check_same(&b.sink.files, "out");
    end(&b);
    (void)state;
}

/* The product with the transposed derivative, and the product of that with the derivative: in memory or in
   files. */
static void multiply(both *b, ffd_jacobian_desc *desc, const char *const outputs[3])
{
    const bool in_memory = b->desc.sink != NULL;
    ffd_embed_desc embed;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_embed_desc_init(&embed, sizeof embed);
    embed.input = b->desc.input;
    embed.lattice = (ffd_lattice_source){.path = b->path, .object = in_memory ? b->lattice : NULL};
    embed.output = outputs[0];
    embed.sink = b->desc.sink;
    embed.sink_user = &b->sink;
    assert_int_equal(ffd_embed_run(&embed, &result, NULL), FFD_OK);
    for (int i = 1; i < 3; i++) {
        ffd_bytes *const bytes = i == 1 ? &desc->transposed_bytes : &desc->times_bytes;
        const char **const path = i == 1 ? &desc->transposed : &desc->times;
        const named *const factor = find(&b->sink.files, outputs[i - 1]);
        desc->times = desc->transposed = NULL;
        desc->times_bytes = desc->transposed_bytes = (ffd_bytes){0};
        if (in_memory)
            *bytes = (ffd_bytes){factor->bytes, factor->size};
        else
            *path = outputs[i - 1];
        desc->output = outputs[i];
        assert_int_equal(ffd_jacobian_run(desc, NULL, NULL), FFD_OK);
    }
}

static void derivatives_are_multiplied_by_bytes(void **state)
{
    both b;
    ffd_error error;
    ffd_jacobian_desc desc;
    char paths[3][200];
    const char *const outputs[3] = {paths[0], paths[1], paths[2]};
    begin(&b, make_obj, "head.obj");
    for (int i = 0; i < 3; i++)
        snprintf(paths[i], sizeof paths[i], "%s/out/%d.npy", folder, i);
    ffd_jacobian_desc_init(&desc, sizeof desc);
    desc.job = &b.desc;
    multiply(&b, &desc, outputs);
    assert_int_equal(b.sink.files.count, 3);
    desc.times_bytes.size--;
    assert_int_equal(ffd_jacobian_run(&desc, NULL, &error), FFD_E_INVALID);
    assert_string_equal(error.file, "times");
    desc.times_bytes.data = NULL;
    assert_int_equal(ffd_jacobian_run(&desc, NULL, NULL), FFD_E_ARGUMENT);
    use_files(&b);
    multiply(&b, &desc, outputs);
    check_same(&b.sink.files, "out");
    end(&b);
    (void)state;
}

static void a_report_goes_to_a_sink(void **state)
{
    const ffd_job_result result = {.struct_size = sizeof result};
    sink s = {0};
    char path[200];
    empty_folder("out");
    snprintf(path, sizeof path, "%s/out/r.json", folder);
    for (int pass = 0; pass < 2; pass++) {
        ffd_report *report;
        assert_int_equal(pass ? ffd_report_create(path, true, NULL, &report, NULL)
                              : ffd_report_create_sink(path, true, take, &s, &report, NULL),
                         FFD_OK);
        for (int i = 0; i < 3; i++)
            assert_int_equal(ffd_report_add(report, "a.obj", "b.obj", &result, NULL), FFD_OK);
        assert_int_equal(s.files.count, pass);
        assert_int_equal(ffd_report_write(report, NULL), FFD_OK);
        ffd_report_destroy(&report);
    }
    check_same(&s.files, "out");
    s.with = FFD_E_LIMIT;
    ffd_report *report;
    assert_int_equal(ffd_report_create_sink("r.jsonl", true, take, &s, &report, NULL), FFD_OK);
    assert_int_equal(ffd_report_write(report, NULL), FFD_E_LIMIT);
    ffd_report_destroy(&report);
    assert_int_equal(ffd_report_create_sink("r.json", true, NULL, NULL, &report, NULL), FFD_E_ARGUMENT);
    assert_int_equal(ffd_report_create_sink(NULL, true, take, &s, &report, NULL), FFD_E_ARGUMENT);
    assert_int_equal(ffd_report_create_sink("out/", true, take, &s, &report, NULL), FFD_E_ARGUMENT);
    assert_null(report);
    clear(&s.files);
    (void)state;
}

/* The job has the status of a resolver that fails, the error has the caller's name for the mesh, and there is
   no output. */
static void check_resolver(const char *fails, ffd_status with, ffd_status expected)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    begin(&b, make_gltf, "head.gltf");
    b.resolver.fails = fails;
    b.resolver.with = with;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), expected);
    assert_int_equal(result.status, expected);
    assert_int_equal(error.status, expected);
    assert_string_equal(error.file, b.input);
    assert_non_null(strstr(error.message, fails));
    assert_int_equal(b.sink.files.count, 0);
    b.desc.sink = NULL;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), expected);
    assert_int_equal(files_in("out"), 0);
    end(&b);
}

/* Likewise for a view, in which a missing image is drawn grey. */
static void check_resolver_of_view(const char *output)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    ffd_view_desc view;
    begin(&b, make_obj, "head.obj");
    ffd_view_desc_init(&view, sizeof view);
    view.job = &b.desc;
    view.output = output;
    view.sink = take;
    view.sink_user = &b.sink;
    assert_int_equal(ffd_view_run(&view, &result, NULL), FFD_OK);
    assert_int_equal(b.sink.files.count, 1);
    clear(&b.sink.files);
    b.resolver.fails = "mats/head.mtl";
    b.resolver.with = FFD_E_CANCELLED;
    assert_int_equal(ffd_view_run(&view, &result, &error), FFD_E_CANCELLED);
    assert_string_equal(error.message, "the file \"mats/head.mtl\" was not given by the caller");
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
}

static void a_resolver_that_fails_ends_the_job(void **state)
{
    check_resolver_of_view("v.png");
    check_resolver_of_view("v.html");
    check_resolver("head.bin", FFD_E_CANCELLED, FFD_E_CANCELLED);
    check_resolver("head.bin", FFD_E_IO, FFD_E_IO);
    check_resolver("tex/skin.png", FFD_E_MEMORY, FFD_E_MEMORY); /* a missing image is not an error */
    check_resolver("lost.png", (ffd_status)77, FFD_E_IO);
    check_resolver("lost.png", FFD_OK, FFD_E_ARGUMENT); /* invalid bytes are not treated as a missing file */
    (void)state;
}

static void what_is_not_there_is_named(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    begin(&b, make_gltf, "head.gltf");
    b.desc.input.resolve = NULL;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_IO);
    assert_string_equal(error.file, b.input);
    assert_string_equal(error.message, "the file \"head.bin\" cannot be opened: No such file or directory");
    /* Even if a file of this name exists. */
    put_all(&b.given, "in");
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_IO);
    end(&b);
    (void)state;
}

static void nothing_outside_of_the_folder_is_asked_for(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    static const char *const uris[] = {"../x.bin", "a/../../x.bin", "/etc/passwd", "%2e%2e/x.bin"};
    for (size_t i = 0; i < sizeof uris / sizeof *uris; i++) {
        char text[1024];
        begin(&b, make_gltf, "head.gltf");
        snprintf(text, sizeof text, "{" GLTF_REST ",\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
                 uris[i]);
        b.desc.input.bytes = (ffd_bytes){text, strlen(text)};
        assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_IO);
        assert_non_null(strstr(error.message, "is outside the model's folder"));
        assert_int_equal(b.resolver.calls, 0);
        end(&b);
    }
    (void)state;
}

static void a_sink_that_fails_ends_the_job(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    for (size_t takes = 0; takes < 3; takes++) {
        begin(&b, make_gltf, "head.gltf");
        b.sink.with = takes == 1 ? (ffd_status)5 : FFD_E_CANCELLED;
        b.sink.takes = takes;
        assert_int_equal(ffd_deform_run(&b.desc, &result, &error), takes == 1 ? FFD_E_IO : FFD_E_CANCELLED);
        assert_string_equal(error.message, "was not taken by the caller");
        assert_int_equal(b.sink.files.count, takes);
        assert_null(find(&b.sink.files, b.output)); /* never the mesh without the files that it needs */
        end(&b);
    }
    begin(&b, make_off, "head.off");
    b.desc.fail_on = FFD_GATE_TEAR;
    b.desc.tear_most = -1;
    b.desc.fail_on |= FFD_GATE_OUTSIDE;
    ffd_lattice_destroy(&b.lattice);
    const char far_away[] =
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":[8,8,8],"
        "\"max\":[9,9,9]}}}";
    assert_int_equal(ffd_lattice_parse(far_away, strlen(far_away), "far", &b.lattice, NULL), FFD_OK);
    b.source.object = b.lattice;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_E_GATE);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
    (void)state;
}

/* For each length of each format the error is that of a job on a file. */
static void truncated_bytes_fail_as_files_do(void **state)
{
    static void (*const make[])(name_list *) = {make_obj, make_gltf, make_glb, make_ply,
                                                make_off, make_stl,  make_foam};
    for (size_t m = 0; m < sizeof make / sizeof *make; m++) {
        both b;
        ffd_job_result result = {.struct_size = sizeof result};
        begin(&b, make[m], "o.glb");
        put_text("in/l.json", lattice_text);
        put_all(&b.given, "in");
        for (size_t size = 0; size < b.given.files[0].size; size += 1 + size / 16) {
            const ffd_source file = {.path = b.input};
            ffd_error ours = {0}, theirs = {0};
            unsigned char *const cut = malloc(size + 1);
            memcpy(cut, b.given.files[0].bytes, size);
            put(strrchr(b.input, '/') - 2, cut, size);
            b.desc.input.bytes = (ffd_bytes){cut, size};
            ffd_deform_desc on_file = b.desc;
            on_file.input = file;
            on_file.dry_run = b.desc.dry_run = true;
            const ffd_status status = ffd_deform_run(&b.desc, &result, &ours);
            assert_int_equal(ffd_deform_run(&on_file, &result, &theirs), status);
            assert_string_equal(ours.message, theirs.message);
            assert_string_equal(ours.file, theirs.file);
            assert_int_equal(ours.line, theirs.line);
            assert_string_equal(ours.pointer, theirs.pointer);
            free(cut);
        }
        end(&b);
    }
    (void)state;
}

/* What is in memory is not taken for the file of its name: not for one that an earlier job has read or
   written, and not for the output. */
static void names_in_memory_mean_no_files(void **state)
{
    static const char other[] = "OFF\n1 0 0\n5 5 5\n";
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_job_cache *cache;
    ffd_output_set *output_set;
    begin(&b, make_off, "head.off");
    use_files(&b);
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    assert_int_equal(ffd_output_set_create(&output_set, NULL), FFD_OK);
    b.desc.cache = cache;
    b.desc.output_set = output_set;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_true(result.vertices > 1);
    b.desc.input.bytes = (ffd_bytes){other, sizeof other - 1};
    b.desc.output = "in/no.off"; /* and no such folder */
    b.desc.dry_run = true;
    b.desc.sink = take;
    b.desc.sink_user = &b.sink;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(result.vertices, 1);
    b.desc.dry_run = false;
    b.desc.sink = NULL;
    b.desc.input.path = b.output; /* that file was written by this run */
    b.desc.output = b.input;
    b.desc.force = true;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_int_equal(result.vertices, 1);
    b.desc.output_set = NULL;
    b.desc.input.path = b.input; /* and that one is replaced, as any other */
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    ffd_output_set_destroy(&output_set);
    ffd_job_cache_destroy(&cache);
    end(&b);
    (void)state;
}

static void descriptions_that_contradict_themselves_are_refused(void **state)
{
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    ffd_depfile *depfile;
    begin(&b, make_off, "head.off");
    const ffd_deform_desc whole = b.desc;
    assert_int_equal(ffd_depfile_create(in_folder("out/d"), &depfile, NULL), FFD_OK);
    for (int wrong = 0; wrong < 9; wrong++) {
        b.desc = whole;
        b.source = (ffd_lattice_source){.object = b.lattice};
        if (wrong == 0)
            b.desc.input.bytes.data = NULL;
        if (wrong == 1)
            b.desc.input.bytes = (ffd_bytes){0}; /* with a resolver only */
        if (wrong == 2)
            b.desc.in_place = true;
        if (wrong == 3)
            b.desc.depfile = depfile;
        if (wrong == 4)
            b.desc.resources = FFD_RESOURCES_REFERENCE;
        if (wrong == 5)
            b.source.text = (ffd_bytes){lattice_text, strlen(lattice_text)}; /* together with an object */
        if (wrong == 6)
            b.source.object = NULL;
        if (wrong == 7)
            b.desc.embedding.bytes.size = 3;
        if (wrong == 8)
            b.desc.output = NULL;
        assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
        assert_true(error.message[0]);
        error = (ffd_error){0};
    }
    ffd_depfile_destroy(&depfile);
    b.desc = whole;
    b.source.object = b.lattice;
    b.desc.input.bytes.size = 0; /* an empty file */
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_INVALID);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
    (void)state;
}

static void arrays_of_descriptions_are_complete(void **state)
{
    static const char *const none[] = {NULL}, *const names[] = {"lifted"};
    static const ffd_setting settings[] = {{"lift", NULL}, {NULL, "1"}};
    const ffd_source nameless = {.path = NULL};
    const ffd_lattice_desc *const nothing = &(ffd_lattice_desc){.struct_size = sizeof *nothing};
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    both b;
    begin(&b, make_gltf, "head.glb");
    const ffd_deform_desc whole = b.desc;
    for (int wrong = 0; wrong < 7; wrong++) {
        b.desc = whole;
        if (wrong == 0)
            b.desc.only = none;
        if (wrong == 1) {
            b.desc.clips = none;
            b.desc.morphs = names;
        }
        if (wrong == 2)
            b.desc.morphs = none;
        if (wrong >= 3 && wrong < 5)
            b.desc.set = &settings[wrong - 3];
        if (wrong == 5)
            b.desc.input.allow_extensions = none;
        if (wrong == 6)
            b.desc.lattices = NULL;
        b.desc.only_count = b.desc.only != NULL;
        b.desc.clip_count = b.desc.clips != NULL;
        b.desc.set_count = b.desc.set != NULL;
        b.desc.input.allow_extension_count = b.desc.input.allow_extensions != NULL;
        assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
        assert_non_null(strstr(error.message, "is not complete"));
        error = (ffd_error){0};
    }
    ffd_embed_desc embed;
    ffd_info_desc info;
    ffd_lattice_new_desc new;
    char *text;
    ffd_embed_desc_init(&embed, sizeof embed);
    embed.input = whole.input;
    embed.lattice.text = (ffd_bytes){open_text, sizeof open_text - 1};
    embed.output = "uvw.npy";
    embed.sink = take;
    embed.sink_user = &b.sink;
    embed.set = settings;
    embed.set_count = 1;
    assert_int_equal(ffd_embed_run(&embed, NULL, &error), FFD_E_ARGUMENT);
    embed.set_count = 0;
    embed.status_output = "uvw.npy";
    assert_int_equal(ffd_embed_run(&embed, NULL, &error), FFD_E_ARGUMENT);
    ffd_info_desc_init(&info, sizeof info);
    info.file = (ffd_source){.path = "l.json", .bytes = embed.lattice.text};
    info.set = settings;
    info.set_count = 1;
    assert_int_equal(ffd_info_run(&info, &text, &error), FFD_E_ARGUMENT);
    ffd_lattice_new_desc_init(&new, sizeof new);
    new.output = "new.json";
    new.sink = take;
    new.sink_user = &b.sink;
    new.lattice = nothing;
    new.meshes = &nameless;
    new.mesh_count = 1;
    assert_int_equal(ffd_lattice_new_run(&new, &error), FFD_E_ARGUMENT);
    new.meshes = &whole.input;
    new.only = none;
    new.only_count = 1;
    assert_int_equal(ffd_lattice_new_run(&new, &error), FFD_E_ARGUMENT);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
    (void)state;
}

static void negative_threads_are_refused(void **state)
{
    static const char message[] = "threads is -2: it is 0 for all cores, or positive";
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    both b;
    (void)state;
    begin(&b, make_gltf, "head.glb");
    b.desc.threads = -2;
    assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, message);
    b.desc.threads = 2;
    b.desc.input.threads = -2;
    assert_int_equal(ffd_check_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, message);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
}

static void choices_that_are_none_are_refused(void **state)
{
    const double lengths[] = {(double)NAN, -1};
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    ffd_view_desc view;
    both b;
    begin(&b, make_gltf, "head.glb");
    const ffd_deform_desc whole = b.desc;
    for (int wrong = 0; wrong < 10; wrong++) {
        const int number = wrong % 2 ? 3 : -1;
        b.desc = whole;
        if (wrong / 2 == 0)
            b.desc.outside = (ffd_outside)number;
        if (wrong / 2 == 1)
            b.desc.normals = (ffd_normals)number;
        if (wrong / 2 == 2)
            b.desc.rig = (ffd_rig)number;
        if (wrong / 2 == 3)
            b.desc.resources = (ffd_resources)number;
        if (wrong / 2 == 4)
            b.desc.input.space = (ffd_space)number;
        assert_int_equal(ffd_deform_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
        assert_non_null(strstr(error.message, "is not a value of "));
        error = (ffd_error){0};
    }
    for (int i = 0; i < 2; i++) {
        b.desc = whole;
        b.desc.fail_on = FFD_GATE_EDGES;
        b.desc.edges_most = lengths[i];
        assert_int_equal(ffd_check_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
    }
    b.desc.fail_on = FFD_GATE_TEAR;
    b.desc.tear_most = (double)NAN;
    assert_int_equal(ffd_check_run(&b.desc, &result, &error), FFD_E_ARGUMENT);
    ffd_view_desc_init(&view, sizeof view);
    view.job = &whole;
    view.output = "head.png";
    view.sink = take;
    view.sink_user = &b.sink;
    view.color = (ffd_view_color)(FFD_VIEW_AUTO + 1);
    assert_int_equal(ffd_view_run(&view, &result, &error), FFD_E_ARGUMENT);
    assert_int_equal(b.sink.files.count, 0);
    end(&b);
    (void)state;
}

/* Runs a whole job inside the callback of another one. */
static ffd_status take_and_run(void *user, const char *name, const void *bytes, size_t size)
{
    static const char lifted[] =
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":\"mesh\"},"
        "\"moves\":[{\"by\":[0,0,1]}]}";
    const ffd_lattice_source lattice = {.text = {lifted, sizeof lifted - 1}};
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input = (ffd_source){.path = name, .bytes = {bytes, size}};
    desc.output = "again.off";
    desc.lattices = &lattice;
    desc.lattice_count = 1;
    desc.threads = 1;
    desc.sink = take;
    desc.sink_user = user;
    return ffd_deform_run(&desc, &result, NULL);
}

/* Runs the same job several times in a thread. Returns the number of correct runs. */
static void *run_some(void *user)
{
    static const char off[] = "OFF\n1 0 0\n0 0 0\n";
    size_t *const good = user;
    for (int i = 0; i < 20; i++) {
        sink s = {0};
        if (!take_and_run(&s, "a.off", off, sizeof off - 1) && s.files.count == 1 &&
            !take_and_run(&s, "b.off", s.files.files[0].bytes, s.files.files[0].size))
            *good += s.files.files[1].size == s.files.files[0].size;
        clear(&s.files);
    }
    return NULL;
}

static void jobs_run_in_threads_and_in_callbacks(void **state)
{
    pthread_t threads[4];
    size_t good[4] = {0};
    both b;
    ffd_job_result result = {.struct_size = sizeof result};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, run_some, &good[i]), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(good[i], 20);
    }
    begin(&b, make_off, "head.off");
    b.desc.sink = take_and_run;
    assert_int_equal(ffd_deform_run(&b.desc, &result, NULL), FFD_OK);
    assert_string_equal(b.sink.files.files[0].name, "again.off");
    end(&b);
    (void)state;
}

/* Wherever memory runs out the job fails; for example, an image is never just taken as missing. */
static void memory_may_run_out_anywhere(void **state)
{
    both b;
    ffd_status status = FFD_E_MEMORY;
    long failures = 0;
    begin(&b, make_gltf, "head.gltf");
    b.desc.threads = 1;
    for (; status; failures++) {
        ffd_job_result result = {.struct_size = sizeof result};
        ffd_alloc_fail_after(failures);
        status = ffd_deform_run(&b.desc, &result, NULL);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        assert_int_equal(b.sink.files.count, status ? 0 : 3);
    }
    assert_true(failures > 50);
    end(&b);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_gives_the_bytes_of_the_files),
        cmocka_unit_test(so_does_every_conversion),
        cmocka_unit_test(one_of_both_may_be_a_file),
        cmocka_unit_test(names_are_the_callers),
        cmocka_unit_test(names_that_are_no_files_are_refused),
        cmocka_unit_test(texts_of_lattices_have_values),
        cmocka_unit_test(a_text_names_no_meshes),
        cmocka_unit_test(several_morph_targets_are_made),
        cmocka_unit_test(embeddings_pass_through_memory),
        cmocka_unit_test(other_jobs_take_memory_too),
        cmocka_unit_test(pictures_pages_and_derivatives_go_to_a_sink),
        cmocka_unit_test(derivatives_are_multiplied_by_bytes),
        cmocka_unit_test(a_report_goes_to_a_sink),
        cmocka_unit_test(a_resolver_that_fails_ends_the_job),
        cmocka_unit_test(what_is_not_there_is_named),
        cmocka_unit_test(nothing_outside_of_the_folder_is_asked_for),
        cmocka_unit_test(a_sink_that_fails_ends_the_job),
        cmocka_unit_test(truncated_bytes_fail_as_files_do),
        cmocka_unit_test(jobs_run_in_threads_and_in_callbacks),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(names_in_memory_mean_no_files),
        cmocka_unit_test(descriptions_that_contradict_themselves_are_refused),
        cmocka_unit_test(arrays_of_descriptions_are_complete),
        cmocka_unit_test(choices_that_are_none_are_refused),
        cmocka_unit_test(negative_threads_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
