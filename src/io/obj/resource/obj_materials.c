/* obj_materials.c - the materials of the libraries that an OBJ file names. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/obj/resource/mtl_file.h"
#include "io/obj/resource/obj_libraries.h"
#include "io/obj/resource/obj_paths.h"
#include "io/obj/resource/obj_resources.h"
#include "io/text/file_document.h"
#include "mesh/resource/material_images.h"
#include "mesh/resource/resource_copy.h"
#include "mesh/srgb.h"

/* What blended surfaces are drawn by. */
#define HALF 0.5

typedef struct reader {
    memory_budget *budget;
    mesh_materials *materials;
    material_images images;
    intern_table names; /* of the materials */
    left_out left;      /* libraries */
    ffd_error *error;
} reader;

/* What a library says of a material: from a newmtl to the next one. */
typedef struct definition {
    bool counts; /* the name is new */
    double diffuse[3];
    double opacity;   /* d */
    double clearness; /* Tr, which many programs write too, some of them wrongly: d comes first */
    bool has_opacity, has_alpha_map;
    mtl_map map; /* name.first NULL: none */
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

static void take_statement(text_scan *scan, text_word keyword, definition *d)
{
    mtl_map map;
    double number;
    if (ffd_text_is_any_case(keyword, "kd")) {
        read_colour(scan, d->diffuse);
    } else if (ffd_text_is_any_case(keyword, "d")) {
        if (read_share(scan, &number)) {
            d->opacity = number;
            d->has_opacity = true;
        }
    } else if (ffd_text_is_any_case(keyword, "tr")) {
        if (read_share(scan, &number))
            d->clearness = number;
    } else if (ffd_text_is_any_case(keyword, "map_kd")) {
        if (ffd_mtl_read_map(scan, &map))
            d->map = map;
    } else if (ffd_text_is_any_case(keyword, "map_d")) {
        d->has_alpha_map = ffd_mtl_read_map(scan, &map) || d->has_alpha_map;
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

/* Fills in the material that was added last. */
static ffd_status end(reader *r, const char *library, const definition *d)
{
    if (!d->counts)
        return FFD_OK;
    mesh_material *const m = &r->materials->list[r->materials->count - 1];
    const bool has_map = d->map.name.first;
    const bool is_black = !(d->diffuse[0] > 0 || d->diffuse[1] > 0 || d->diffuse[2] > 0);
    for (size_t c = 0; c < 3; c++) /* a black that would hide the map is not meant */
        m->color[c] = has_map && is_black ? 1 : ffd_srgb_to_linear(d->diffuse[c]);
    m->color[3] = d->has_opacity ? d->opacity : 1 - d->clearness;
    m->alpha_cutoff = m->color[3] < 1 || d->has_alpha_map ? HALF : 0;
    m->is_double_sided = true; /* the format knows no sides */
    m->wrap[0] = m->wrap[1] = d->map.is_clamped ? TEXTURE_CLAMP : TEXTURE_REPEAT;
    return has_map ? load_map(r, library, d->map.name, &m->image) : FFD_OK;
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
end:
    ffd_left_out_log(&r.left, "material library cannot be read, and its materials are unknown",
                     "material libraries cannot be read, and their materials are unknown", log);
    ffd_images_end(&r.images, log);
    ffd_intern_free(&r.names);
    ffd_intern_free(&libraries);
    return status;
}
