#include "io/gltf/rig/gltf_vrm.h"

typedef struct vrm_visit {
    const gltf_document *document;
    gltf_vrm_visitor *visit;
    void *context;
} vrm_visit;

/* A number of a node; what is none is passed over. */
static void visit_node(const vrm_visit *v, uint32_t number, gltf_vrm_role role)
{
    const size_t node = number == JSON_NONE ? GLTF_NONE : ffd_gltf_node(v->document, number);
    if (node != GLTF_NONE)
        v->visit(v->context, node, role);
}

/* The member "node" of each element of a list. */
static void visit_list(const vrm_visit *v, uint32_t object, const char *list, gltf_vrm_role role)
{
    const json_span *const tree = &v->document->tree;
    for (uint32_t e = ffd_gltf_first(v->document, object, list); e != JSON_NONE;
         e = ffd_json_span_after(tree, e))
        visit_node(v, ffd_json_span_member(tree, e, "node"), role);
}

static void visit_springs(const vrm_visit *v)
{
    const gltf_document *const d = v->document;
    const uint32_t springs = ffd_gltf_extension(d, 0, "VRMC_springBone");
    const uint32_t old =
        ffd_json_span_member(&d->tree, ffd_gltf_extension(d, 0, "VRM"), "secondaryAnimation");
    visit_list(v, springs, "colliders", VRM_COLLIDER);
    visit_list(v, old, "colliderGroups", VRM_COLLIDER);
    for (uint32_t s = ffd_gltf_first(d, springs, "springs"); s != JSON_NONE;
         s = ffd_json_span_after(&d->tree, s))
        visit_list(v, s, "joints", VRM_SPRING);
    for (uint32_t g = ffd_gltf_first(d, old, "boneGroups"); g != JSON_NONE;
         g = ffd_json_span_after(&d->tree, g))
        for (uint32_t b = ffd_gltf_first(d, g, "bones"); b != JSON_NONE; b = ffd_json_span_after(&d->tree, b))
            visit_node(v, b, VRM_SPRING_ROOT);
}

/* Of VRM 1.0: {"hips": {"node": 0}, ..}. */
static void visit_humanoid(const vrm_visit *v)
{
    const json_span *const tree = &v->document->tree;
    const uint32_t vrm = ffd_gltf_extension(v->document, 0, "VRMC_vrm");
    const uint32_t bones =
        ffd_json_span_member(tree, ffd_json_span_member(tree, vrm, "humanoid"), "humanBones");
    const uint32_t eyes =
        ffd_json_span_member(tree, ffd_json_span_member(tree, vrm, "lookAt"), "offsetFromHeadBone");
    if (bones == JSON_NONE || tree->values[bones].kind != JSON_OBJECT)
        return;
    for (uint32_t b = ffd_json_span_first(tree, bones); b != JSON_NONE; b = ffd_json_span_after(tree, b)) {
        const uint32_t node = ffd_json_span_member(tree, b, "node");
        visit_node(v, node, VRM_BONE);
        if (eyes != JSON_NONE && ffd_json_span_key_is(tree, b, "head"))
            visit_node(v, node, VRM_EYES);
    }
}

/* Of VRM 0.x: [{"bone": "hips", "node": 0}, ..]; the bone of the first person is the head unless it is named.
 */
static void visit_old_humanoid(const vrm_visit *v)
{
    const json_span *const tree = &v->document->tree;
    const uint32_t vrm = ffd_gltf_extension(v->document, 0, "VRM");
    const uint32_t person = ffd_json_span_member(tree, vrm, "firstPerson");
    const uint32_t named = ffd_json_span_member(tree, person, "firstPersonBone");
    const bool is_named = named != JSON_NONE && ffd_gltf_node(v->document, named) != GLTF_NONE;
    const bool has_eyes = ffd_json_span_member(tree, person, "firstPersonBoneOffset") != JSON_NONE;
    for (uint32_t b = ffd_gltf_first(v->document, ffd_json_span_member(tree, vrm, "humanoid"), "humanBones");
         b != JSON_NONE; b = ffd_json_span_after(tree, b)) {
        const uint32_t bone = ffd_json_span_member(tree, b, "bone"),
                       node = ffd_json_span_member(tree, b, "node");
        visit_node(v, node, VRM_BONE);
        if (has_eyes && !is_named && bone != JSON_NONE && ffd_json_span_string_is(tree, bone, "head"))
            visit_node(v, node, VRM_EYES);
    }
    if (has_eyes && is_named)
        visit_node(v, named, VRM_EYES);
}

static void visit_constraints(const vrm_visit *v)
{
    const gltf_document *const d = v->document;
    for (size_t n = 0; n < d->model.node_count; n++) {
        const uint32_t driven = ffd_gltf_extension(d, d->node_values.values[n], "VRMC_node_constraint");
        const uint32_t constraint = ffd_json_span_member(&d->tree, driven, "constraint");
        if (driven == JSON_NONE)
            continue;
        v->visit(v->context, n, VRM_DRIVEN);
        if (ffd_json_span_member(&d->tree, constraint, "aim") != JSON_NONE)
            v->visit(v->context, n, VRM_AIM);
    }
}

void ffd_gltf_visit_vrm(const gltf_document *document, gltf_vrm_visitor *visit, void *context)
{
    const vrm_visit v = {document, visit, context};
    visit_springs(&v);
    visit_humanoid(&v);
    visit_old_humanoid(&v);
    visit_constraints(&v);
}
