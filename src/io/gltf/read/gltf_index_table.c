#include "io/gltf/read/gltf_index_table.h"
#include <stdlib.h>
#include <string.h>

#define KEY_SIZE 64

/* A JSON pointer to the values. "*" stands for every member or element. "+" stands for every element of an
   array of which each copy of the named mesh needs an element of its own. */
typedef struct row {
    gltf_index_kind kind;
    const char *pointer;
} row;

#define MANIFOLD "/meshes/*/extensions/EXT_mesh_manifold/"
#define EDGES "/meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/"
#define LINKING "/meshes/*/extensions/MPEG_mesh_linking/"
#define BODIES "/nodes/*/extensions/KHR_physics_rigid_bodies/"

static const row rows[] = {
    {GLTF_INDEX_POINTER, "/animations/*/channels/+/target/extensions/KHR_animation_pointer/pointer"},
    {GLTF_INDEX_POINTER, "/extensions/KHR_interactivity/graphs/*/nodes/*/configuration/pointer/value/*"},
    {GLTF_INDEX_MESH, "/extensions/OMI_collider/colliders/*/mesh"},
    {GLTF_INDEX_MESH, "/extensions/OMI_physics_shape/shapes/*/convex/mesh"},
    {GLTF_INDEX_MESH, "/extensions/OMI_physics_shape/shapes/*/trimesh/mesh"},
    {GLTF_INDEX_MESH, "/extensions/VRM/blendShapeMaster/blendShapeGroups/*/binds/+/mesh"},
    {GLTF_INDEX_MESH, "/extensions/VRM/firstPerson/meshAnnotations/+/mesh"},
    {GLTF_INDEX_ACCESSOR, "/meshes/*/extensions/BENTLEY_primitive_restart/primitiveGroups/*/indices"},
    {GLTF_INDEX_ACCESSOR, "/meshes/*/extensions/EXT_mesh_primitive_restart/primitiveGroups/*/indices"},
    {GLTF_INDEX_SHAPE, MANIFOLD "manifoldPrimitive/attributes/*"},
    {GLTF_INDEX_ACCESSOR, MANIFOLD "manifoldPrimitive/indices"},
    {GLTF_INDEX_ACCESSOR, MANIFOLD "mergeIndices"},
    {GLTF_INDEX_ACCESSOR, MANIFOLD "mergeValues"},
    {GLTF_INDEX_ACCESSOR, LINKING "correspondence"},
    {GLTF_INDEX_MESH, LINKING "mesh"},
    {GLTF_INDEX_ACCESSOR, LINKING "pose"},
    {GLTF_INDEX_ACCESSOR, LINKING "weights"},
    {GLTF_INDEX_ACCESSOR, "/meshes/*/primitives/*/extensions/CESIUM_primitive_outline/indices"},
    {GLTF_INDEX_ACCESSOR, EDGES "lineStrings/*/indices"},
    {GLTF_INDEX_SHAPE, EDGES "silhouetteNormals"},
    {GLTF_INDEX_ACCESSOR, EDGES "visibility"},
    {GLTF_INDEX_ACCESSOR, "/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*"},
    {GLTF_INDEX_MESH, BODIES "collider/geometry/mesh"},
    {GLTF_INDEX_MESH, BODIES "trigger/geometry/mesh"},
};

/* A walk along the pointer of a row. */
typedef struct walk {
    const gltf_document *document;
    gltf_index_visit *visit;
    void *context;
    gltf_index_place place; /* what is known so far */
} walk;

/* Copies the first key of a pointer "/key/..."; returns the text after it. */
static const char *take_key(const char *pointer, char key[KEY_SIZE])
{
    const size_t length = strcspn(pointer + 1, "/");
    const size_t kept = length < KEY_SIZE ? length : KEY_SIZE - 1;
    memcpy(key, pointer + 1, kept);
    key[kept] = 0;
    return pointer + 1 + length;
}

static void follow(const walk *w, const char *pointer, uint32_t value);

static void follow_all(const walk *w, const char *pointer, uint32_t container, bool repeats)
{
    const json_tree *tree = &w->document->tree;
    if (container == JSON_NONE || (repeats && tree->values[container].kind != JSON_ARRAY))
        return;
    for (uint32_t v = ffd_json_tree_first(tree, container); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        walk next = *w;
        if (repeats)
            next.place.repeats = v;
        follow(&next, pointer, v);
    }
}

/* Follows a pointer from a JSON value on. */
static void follow(const walk *w, const char *pointer, uint32_t value)
{
    char key[KEY_SIZE];
    if (value == JSON_NONE)
        return;
    if (!*pointer) {
        walk end = *w;
        end.place.value = value;
        w->visit(w->context, &end.place);
        return;
    }
    const char *rest = take_key(pointer, key);
    if (strcmp(key, "*") == 0 || strcmp(key, "+") == 0)
        follow_all(w, rest, value, *key == '+');
    else
        follow(w, rest, ffd_json_tree_member(&w->document->tree, value, key));
}

static walk begin(const gltf_document *d, const row *r, gltf_index_visit *visit, void *context)
{
    return (walk){d, visit, context, {r->kind, JSON_NONE, JSON_NONE, GLTF_NONE, NULL}};
}

/* Follows a row that begins with a top-level list, element by element, to know their indices. */
static void visit_list(walk *w, const char *list, const char *rest)
{
    const json_tree *tree = &w->document->tree;
    w->place.list = list;
    w->place.owner = 0;
    for (uint32_t v = ffd_json_tree_first(tree, ffd_json_tree_member(tree, 0, list)); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        if (!ffd_gltf_is_replaced(w->document, v))
            follow(w, rest, v);
        w->place.owner++;
    }
}

void ffd_gltf_visit_indices(const gltf_document *d, gltf_index_visit *visit, void *context)
{
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        char list[KEY_SIZE], all[KEY_SIZE];
        walk w = begin(d, &rows[r], visit, context);
        const char *rest = take_key(rows[r].pointer, list);
        const char *below = take_key(rest, all);
        if (strcmp(all, "*") == 0)
            visit_list(&w, list, below);
        else
            follow(&w, rows[r].pointer, 0);
    }
}

void ffd_gltf_visit_mesh_indices(const gltf_document *d, size_t mesh, gltf_index_visit *visit, void *context)
{
    static const char meshes[] = "/meshes/*";
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        if (strncmp(rows[r].pointer, meshes, sizeof meshes - 1) != 0)
            continue;
        walk w = begin(d, &rows[r], visit, context);
        w.place.list = "meshes";
        w.place.owner = mesh;
        follow(&w, rows[r].pointer + sizeof meshes - 1, d->mesh_values.values[mesh]);
    }
}

bool ffd_gltf_mesh_has_slot(const gltf_document *d, size_t mesh, size_t accessor)
{
    for (const gltf_primitive *primitive = NULL; (primitive = ffd_gltf_next_primitive(d, mesh, primitive));) {
        for (size_t s = 0; s < gltf_slot_count(primitive); s++)
            if (gltf_slot_accessor(primitive, s) >= 0 && (size_t)gltf_slot_accessor(primitive, s) == accessor)
                return true;
    }
    return false;
}

size_t ffd_gltf_pointed(const char *pointer, const char *list, const char **rest)
{
    const size_t length = strlen(list);
    if (pointer[0] != '/' || strncmp(pointer + 1, list, length) != 0 || pointer[1 + length] != '/')
        return GLTF_NONE;
    const char *const digits = pointer + length + 2;
    char *end = NULL;
    if (*digits < '0' || *digits > '9' || (digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9'))
        return GLTF_NONE; /* RFC 6901, 4: no leading zeros */
    const unsigned long long index = strtoull(digits, &end, 10);
    *rest = end;
    return (*end == '/' || *end == 0) && index < GLTF_NONE ? (size_t)index : GLTF_NONE;
}
