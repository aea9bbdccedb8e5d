#include "view/page_scene.h"
#include "base/memory/memory.h"
#include "view/page_text.h"
#include "json/json_text.h"
#include <ffd/version.h>
#include <string.h>

static void put_name(json_text *json, const char *key, const char *name)
{
    char *const text = ffd_page_name(name ? name : "");
    if (!text)
        json->out->failed = true;
    ffd_json_string(json, key, text);
    ffd_free(text);
}

static uint64_t index_of(const view_scene *scene, uint32_t vertex)
{
    return scene->indices ? scene->indices[vertex] : vertex;
}

static void put_mesh(json_text *json, const page_data *data)
{
    const page_mesh *const mesh = data->mesh;
    const view_scene *const scene = mesh->scene;
    const json_count counts[] = {
        {"vertices", mesh->vertex_count},
        {"verticesAll", scene->vertices_all ? scene->vertices_all : scene->vertex_count},
        {"triangles", mesh->triangle_count},
        {"trianglesAll", scene->triangle_count},
        {"segments", mesh->segment_count},
        {"points", mesh->point_count},
        {"notFinite", mesh->not_finite},
        {"tearEdges", scene->tear_edges},
        {"flippedFaces", scene->flipped_faces},
        {"numberSize", data->index_size}};
    ffd_json_counts(json, counts, sizeof counts / sizeof *counts);
    ffd_json_vector(json, "low", data->low, 3);
    ffd_json_vector(json, "step", data->step, 3);
    ffd_json_number(json, "moveStep", data->move_step);
    ffd_json_number(json, "displacementMax", scene->displacement_max);
}

/* Adds a texture that the page has; nothing if there is none. */
static void put_texture(json_text *json, const char *key, const mesh_texture *texture,
                        const page_images *images)
{
    static const char *const wraps[] = {
        [TEXTURE_REPEAT] = "repeat", [TEXTURE_MIRROR] = "mirror", [TEXTURE_CLAMP] = "clamp"};
    const uint32_t at = ffd_page_image_of(images, texture->image);
    if (at == VIEW_NONE)
        return;
    ffd_json_object(json, key, true);
    ffd_json_count(json, "image", at);
    ffd_json_array(json, "wrap", true);
    for (int a = 0; a < 2; a++)
        ffd_json_string(json, NULL, wraps[texture->wrap[a]]);
    ffd_json_end(json, ']');
    ffd_json_end(json, '}');
}

static void put_material(json_text *json, const mesh_material *material, const page_images *images)
{
    static const char *const alphas[] = {
        [MATERIAL_OPAQUE] = "opaque", [MATERIAL_MASK] = "mask", [MATERIAL_BLEND] = "blend"};
    ffd_json_object(json, NULL, true);
    put_name(json, "name", material->name);
    ffd_json_vector(json, "color", material->color, 4);
    ffd_json_string(json, "alpha", alphas[material->alpha]);
    ffd_json_number(json, "cutoff", material->alpha_cutoff);
    ffd_json_vector(json, "emission", material->emission, 3);
    ffd_json_bool(json, "twoSided", material->is_double_sided);
    ffd_json_bool(json, "unlit", material->is_unlit);
    ffd_json_bool(json, "lost", material->base.image == MATERIAL_LOST);
    put_texture(json, "base", &material->base, images);
    put_texture(json, "glow", &material->glow, images);
    put_texture(json, "opacity", &material->opacity, images);
    ffd_json_end(json, '}');
}

static void put_materials(json_text *json, const page_description *page)
{
    const mesh_materials *const materials = &page->data->mesh->scene->materials;
    ffd_json_array(json, "materials", false);
    for (size_t i = 0; i < materials->count; i++)
        put_material(json, &materials->list[i], page->images);
    ffd_json_end(json, ']');
}

static void put_parts(json_text *json, const page_mesh *mesh)
{
    const view_scene *const scene = mesh->scene;
    ffd_json_array(json, "parts", false);
    for (size_t i = 0; i < mesh->part_count; i++) {
        const view_part *const part = scene->part_count ? &scene->parts[i] : NULL;
        ffd_json_object(json, NULL, true);
        put_name(json, "name", part ? part->name : "");
        ffd_json_count(json, "first", mesh->parts[i].first_triangle);
        ffd_json_count(json, "count", mesh->parts[i].triangle_count);
        ffd_json_count(json, "all", part ? part->triangle_count : scene->triangle_count);
        if (part && part->material < scene->materials.count)
            ffd_json_count(json, "material", part->material);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void put_cages(json_text *json, const page_description *page)
{
    const view_scene *const scene = page->data->mesh->scene;
    ffd_json_array(json, "cages", false);
    for (size_t i = 0; i < scene->cage_count; i++) {
        const view_cage *const cage = &scene->cages[i];
        const double size[3] = {(double)cage->size[0], (double)cage->size[1], (double)cage->size[2]};
        ffd_json_object(json, NULL, true);
        put_name(json, "name", cage->name);
        ffd_json_vector(json, "size", size, 3);
        ffd_json_array(json, "closed", true);
        for (int a = 0; a < 3; a++)
            ffd_json_bool(json, NULL, cage->closed[a]);
        ffd_json_end(json, ']');
        ffd_json_bool(json, "shown", page->has_cage[i]);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void put_vertex(json_text *json, const page_mesh *mesh, uint32_t vertex)
{
    const view_scene *const scene = mesh->scene;
    const double *const after = scene->after ? scene->after : scene->before;
    ffd_json_object(json, NULL, true);
    ffd_json_count(json, "number", index_of(scene, vertex));
    /* A vertex that the page leaves out has no index in its arrays. */
    if (mesh->places[vertex] != VIEW_NONE)
        ffd_json_count(json, "vertex", mesh->places[vertex]);
    ffd_json_vector(json, "before", scene->before + 3 * (size_t)vertex, 3);
    ffd_json_vector(json, "after", after + 3 * (size_t)vertex, 3);
    ffd_json_end(json, '}');
}

static void put_tears(json_text *json, const page_mesh *mesh)
{
    const view_scene *const scene = mesh->scene;
    ffd_json_array(json, "tears", false);
    for (size_t i = 0; i < scene->tear_count; i++) {
        ffd_json_object(json, NULL, true);
        ffd_json_number(json, "step", scene->tears[i].step);
        ffd_json_array(json, "ends", true);
        for (int end = 0; end < 2; end++)
            put_vertex(json, mesh, scene->tears[i].vertices[end]);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static void put_witness(json_text *json, const view_scene *scene)
{
    if (!scene->witness.is_there) {
        ffd_json_null(json, "witness");
        return;
    }
    ffd_json_object(json, "witness", true);
    ffd_json_count(json, "cage", scene->witness.lattice);
    ffd_json_vector(json, "uvw", scene->witness.uvw, 3);
    ffd_json_vector(json, "before", scene->witness.rest, 3);
    ffd_json_vector(json, "after", scene->witness.xyz, 3);
    ffd_json_number(json, "det", scene->witness.det);
    ffd_json_end(json, '}');
}

static void put_view(json_text *json, const view_page_options *options)
{
    ffd_json_object(json, "view", true);
    ffd_json_string(json, "color", ffd_view_color_name(options->color));
    ffd_json_vector(json, "camera", options->camera, 3);
    ffd_json_string(json, "up", options->up == FFD_UP_Z ? "z" : options->up == FFD_UP_X ? "x" : "y");
    ffd_json_end(json, '}');
}

void ffd_page_describe(const page_description *page, byte_buffer *out)
{
    const page_mesh *const mesh = page->data->mesh;
    const view_scene *const scene = mesh->scene;
    byte_buffer text = {0};
    json_text json;
    ffd_json_begin(&json, &text);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "program", FFD_VERSION);
    put_name(&json, "name", scene->name);
    if (scene->output)
        put_name(&json, "output", scene->output);
    put_view(&json, page->options);
    put_mesh(&json, page->data);
    put_witness(&json, scene);
    put_cages(&json, page);
    put_materials(&json, page);
    put_parts(&json, mesh);
    ffd_page_texcoords_describe(page->texcoords, &json);
    ffd_page_images_describe(page->images, &json);
    put_tears(&json, mesh);
    if (ffd_page_rig_is_there(page->rig))
        ffd_page_rig_describe(page->rig, &json);
    ffd_page_targets_describe(page->targets, &json);
    ffd_page_edit_describe(page->edit, &json);
    ffd_json_array(&json, "notices", false);
    for (size_t i = 0; i < page->notice_count; i++)
        ffd_json_string(&json, NULL, page->notices[i]);
    ffd_json_end(&json, ']');
    ffd_json_end(&json, '}');
    if (text.size)
        ffd_page_json(out, text.data, text.size);
    out->failed = out->failed || text.failed;
    ffd_buffer_free(&text);
}
