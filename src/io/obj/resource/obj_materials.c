/* obj_materials.c - the materials of the libraries that an OBJ file names. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_libraries.h"
#include "io/obj/resource/obj_paths.h"
#include "io/obj/resource/obj_resources.h"
#include "io/text/file_document.h"
#include "mesh/resource/material_images.h"
#include "mesh/resource/resource_copy.h"
#include "mesh/srgb.h"

/* Whether Tr alone says how opaque a material is, and whether a map multiplies it. */
typedef enum clearness_use { NOT_BY_CLEARNESS, BY_CLEARNESS, BY_CLEARNESS_AND_MAP } clearness_use;

typedef struct reader {
    memory_budget *budget;
    mesh_materials *materials;
    material_images images;
    intern_table names;    /* of the materials */
    uint8_t *by_clearness; /* of each material: a clearness_use */
    size_t clearness_capacity, clearness_count,
        wholly_clear; /* those of which it does; those whose Tr is 1 */
    left_out left;    /* libraries */
    ffd_error *error;
} reader;

/* What a library says of a material: from a newmtl to the next one. */
typedef struct definition {
    bool counts; /* the name is new */
    double diffuse[3], emission[3];
    double opacity;   /* d */
    double clearness; /* Tr, which many programs write too, some of them wrongly: d comes first */
    bool has_emission, has_opacity, has_clearness;
    mtl_map base, glow, alpha; /* name.first NULL: none */
} definition;

static ffd_status begin(reader *r, text_scan *scan, definition *d)
{
    text_word name = {0}, word;
    const size_t known = r->names.count;
    uint32_t index;
    *d = (definition){.diffuse = {1, 1, 1}, .opacity = 1};
    while (ffd_text_word(scan, &word)) /* as usemtl has it: the first word to the last one */
        name = (text_word){name.first ? name.first : word.first, word.last};
    if (!name.first)
        return FFD_OK;
    if (!ffd_intern(&r->names, name.first, (size_t)(name.last - name.first), &index))
        return ffd_fail_memory(r->error);
    d->counts = index == known;
    if (!d->counts)
        return FFD_OK;
    return ffd_materials_add(r->materials, ffd_text_copy(ffd_intern_key(&r->names, index)), r->budget,
                             r->error);
}

/* Keeps the colour where there are not one or three numbers: a spectrum, or CIE's XYZ. */
static void read_colour(text_scan *scan, double colour[3])
{
    double numbers[3];
    size_t count = 0;
    text_word word;
    while (count < 3 && ffd_text_word(scan, &word) && ffd_text_number(word, &numbers[count]))
        count++;
    for (size_t c = 0; c < 3 && (count == 1 || count == 3); c++)
        colour[c] = material_share(numbers[count == 1 ? 0 : c]);
}

static bool read_share(text_scan *scan, double *number)
{
    text_word word;
    if (!ffd_text_word(scan, &word) || (ffd_text_is_any_case(word, "-halo") && !ffd_text_word(scan, &word)) ||
        !ffd_text_number(word, number))
        return false;
    return *number >= 0 && *number <= 1;
}

static mtl_map *map_of(definition *d, text_word keyword)
{
    return ffd_text_is_any_case(keyword, "map_kd")   ? &d->base
           : ffd_text_is_any_case(keyword, "map_ke") ? &d->glow
           : ffd_text_is_any_case(keyword, "map_d")  ? &d->alpha
                                                     : NULL;
}

static void take_statement(text_scan *scan, text_word keyword, definition *d)
{
    mtl_map *map, read;
    double number;
    if (ffd_text_is_any_case(keyword, "kd")) {
        read_colour(scan, d->diffuse);
    } else if (ffd_text_is_any_case(keyword, "ke")) {
        read_colour(scan, d->emission);
        d->has_emission = true;
    } else if (ffd_text_is_any_case(keyword, "d")) {
        if (read_share(scan, &number)) {
            d->opacity = number;
            d->has_opacity = true;
        }
    } else if (ffd_text_is_any_case(keyword, "tr")) {
        if (read_share(scan, &number)) {
            d->clearness = number;
            d->has_clearness = true;
        }
    } else if ((map = map_of(d, keyword)) && ffd_mtl_read_map(scan, &read)) {
        *map = read;
    }
}

/* Loads the map of a material, which a library names. */
static ffd_status load_map(reader *r, const char *library, text_word name, uint32_t *image)
{
    byte_buffer text = {0};
    char *path = NULL;
    bool is_known;
    ffd_buffer_append(&text, name.first, (size_t)(name.last - name.first));
    char *const named = ffd_buffer_finish(&text);
    ffd_status status;
    TRY_END(named ? ffd_obj_find_map(&r->images.mesh, library, named, &path, r->error)
                  : ffd_fail_memory(r->error));
    if (path) {
        TRY_END(ffd_images_load(&r->images, path, image, r->error));
    } else {
        TRY_END(ffd_images_find(&r->images, named, &is_known, image, r->error));
        if (!is_known)
            ffd_left_add(&r->images.left, named, "is outside the model's folder");
    }
    if (r->images.known.count > OBJ_RESOURCES_MAX)
        TRY_END(ffd_fail_file(r->error, FFD_E_LIMIT, r->images.mesh.file, "names more than %d maps",
                              OBJ_RESOURCES_MAX));
end:
    ffd_free(named);
    ffd_free(path);
    return status;
}

static ffd_status read_map(reader *r, const char *library, const mtl_map *map, mesh_texture *to)
{
    if (!map->name.first)
        return FFD_OK;
    *to = (mesh_texture){.image = MATERIAL_NONE,
                         .scale = {map->scale[0], map->scale[1]},
                         .offset = {map->offset[0], map->offset[1]}};
    to->wrap[0] = to->wrap[1] = map->is_clamped ? TEXTURE_CLAMP : TEXTURE_REPEAT;
    return load_map(r, library, map->name, &to->image);
}

/* Sets a colour, which a map multiplies: a black that would hide the map is not meant. */
static void set_colour(const double read[3], const mtl_map *map, double colour[3])
{
    const bool is_black = !(read[0] > 0 || read[1] > 0 || read[2] > 0);
    for (size_t c = 0; c < 3; c++)
        colour[c] = map->name.first && is_black ? 1 : ffd_srgb_to_linear(read[c]);
}

/* Returns the opacity without its map. d counts where both are there. d 0 is not meant where Tr says the
   opposite, nor where a map would have nothing to multiply. */
static double opacity_of(const definition *d)
{
    const bool is_contradicted = d->has_clearness && !(d->clearness > 0);
    if (!d->has_opacity)
        return 1 - d->clearness;
    return !(d->opacity > 0) && (is_contradicted || d->alpha.name.first) ? 1 : d->opacity;
}

/* Notes whether Tr alone says how opaque the material is (see settle_clearness). */
static ffd_status note_clearness(reader *r, const definition *d)
{
    const size_t count = r->materials->count;
    const bool counts = d->has_clearness && !d->has_opacity;
    if (!ffd_grow((void **)&r->by_clearness, &r->clearness_capacity, count, sizeof *r->by_clearness))
        return ffd_fail_memory(r->error);
    r->by_clearness[count - 1] = (uint8_t)(!counts               ? NOT_BY_CLEARNESS
                                           : d->alpha.name.first ? BY_CLEARNESS_AND_MAP
                                                                 : BY_CLEARNESS);
    r->clearness_count += counts;
    r->wholly_clear += counts && d->clearness >= 1;
    return FFD_OK;
}

/* Fills in the material that was added last. */
static ffd_status end(reader *r, const char *library, const definition *d)
{
    if (!d->counts)
        return FFD_OK;
    mesh_material *const m = &r->materials->list[r->materials->count - 1];
    set_colour(d->diffuse, &d->base, m->color);
    set_colour(d->emission, &d->glow, m->emission);
    m->color[3] = opacity_of(d);
    m->alpha = m->color[3] < 1 || d->alpha.name.first ? MATERIAL_BLEND : MATERIAL_OPAQUE;
    m->is_double_sided = true; /* the format knows no sides */
    TRY(note_clearness(r, d));
    TRY(read_map(r, library, &d->base, &m->base));
    TRY(read_map(r, library, &d->glow, &m->glow));
    TRY(read_map(r, library, &d->alpha, &m->opacity));
    if (m->opacity.image == m->base.image && m->base.image < MATERIAL_LOST)
        m->opacity.image = MATERIAL_NONE; /* the alpha of one image, which counts once */
    return FFD_OK;
}

/* Tr 1 is wholly clear by the format. Two writers of textured scans and a mesh editor wrote it for opaque
   materials, and nobody writes a mesh that cannot be seen: where Tr is 1 in all materials that say Tr and not
   d, these are opaque. */
static void settle_clearness(const reader *r, const mesh_log *log)
{
    if (r->clearness_count == 0 || r->wholly_clear < r->clearness_count)
        return;
    for (size_t i = 0; i < r->materials->count; i++) {
        mesh_material *const m = &r->materials->list[i];
        if (r->by_clearness[i] != NOT_BY_CLEARNESS)
            m->color[3] = 1;
        if (r->by_clearness[i] == BY_CLEARNESS)
            m->alpha = MATERIAL_OPAQUE;
    }
    ffd_log_line(log, FFD_LOG_WARNING, "\"Tr 1\" of %zu %s is taken for opaque: no material has another Tr",
                 r->clearness_count, ffd_plural(r->clearness_count, "material", "materials"));
}

static ffd_status read_statements(reader *r, const char *library, const file_input *bytes)
{
    text_scan scan;
    text_word keyword;
    definition d = {0};
    ffd_text_begin(&scan, bytes->data, ffd_text_size(bytes->data, bytes->size), false);
    do {
        if (!ffd_text_word(&scan, &keyword))
            continue;
        if (ffd_text_is_any_case(keyword, "newmtl")) {
            TRY(end(r, library, &d));
            TRY(begin(r, &scan, &d));
        } else {
            take_statement(&scan, keyword, &d);
        }
    } while (ffd_text_next_line(&scan));
    return end(r, library, &d);
}

static ffd_status read_file(reader *r, const char *path)
{
    const mesh_resource library = {.path = (char *)path, .kind = &ffd_resource_library};
    file_input bytes = {0};
    const char *left;
    ffd_error refused;
    TRY(ffd_resource_load(&r->images.mesh, &library, &bytes, &left, &refused, r->error));
    if (left || refused.status) {
        ffd_left_add_unloaded(&r->left, path, left);
        return FFD_OK;
    }
    ffd_status status = read_statements(r, path, &bytes);
    ffd_file_unload(&bytes);
    return status;
}

static ffd_status read_library(reader *r, const char *name)
{
    char *path;
    if (!r->images.has_folder) {
        ffd_left_add(&r->left, name, "is a file, and standard input has no folder");
        return FFD_OK;
    }
    TRY(ffd_obj_find_path(&r->images.mesh, "", name, &path, r->error));
    ffd_status status = FFD_OK;
    if (path)
        status = read_file(r, path);
    else
        ffd_left_add(&r->left, name, "is outside the model's folder");
    ffd_free(path);
    return status;
}

ffd_status ffd_obj_list_materials(mesh_document *document, const mesh_log *log, mesh_materials *materials,
                                  ffd_error *error)
{
    const file_document *const file = (const file_document *)document;
    intern_table libraries = {0};
    const file_folder mesh = {file->path ? file->path : file->name, document->folder.resolve,
                              document->folder.user};
    reader r = {.budget = &document->budget,
                .materials = materials,
                .images = {.materials = materials,
                           .budget = &document->budget,
                           .mesh = mesh,
                           .has_folder = file->path},
                .error = error};
    ffd_status status;
    TRY_END(ffd_obj_list_libraries(&file->input, &mesh, &libraries, error));
    for (uint32_t i = 0; i < libraries.count; i++)
        TRY_END(read_library(&r, ffd_intern_key(&libraries, i)));
    settle_clearness(&r, log);
end:
    ffd_left_out_log(&r.left, "material library cannot be read, and its materials are unknown",
                     "material libraries cannot be read, and their materials are unknown", log);
    ffd_images_end(&r.images, log);
    ffd_intern_free(&r.names);
    ffd_free(r.by_clearness);
    ffd_intern_free(&libraries);
    return status;
}
