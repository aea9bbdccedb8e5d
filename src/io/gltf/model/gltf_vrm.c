#include "io/gltf/model/gltf_vrm.h"
#include <stdio.h>

typedef struct vrm_visit {
    const gltf_document *document;
    gltf_vrm_visitor *visit;
    /* Called for a value that names no node but should; or NULL. */
    void (*fault)(void *context, uint32_t value);
    void *context;
} vrm_visit;

/* Visits a value that is the index of a node. */
static void visit_node(const vrm_visit *v, uint32_t index, gltf_vrm_role role)
{
    const size_t node = index == JSON_NONE ? GLTF_NONE : ffd_gltf_node(v->document, index);
    if (node != GLTF_NONE)
        v->visit(v->context, node, role);
    else if (index != JSON_NONE && v->fault)
        v->fault(v->context, index);
}

/* Visits a member of VRM 1.0 that must be the index of a node. */
static void visit_member(const vrm_visit *v, uint32_t object, const char *key, gltf_vrm_role role)
{
    const uint32_t index = ffd_json_tree_member(&v->document->tree, object, key);
    if (index != JSON_NONE)
        visit_node(v, index, role);
    else if (v->fault)
        v->fault(v->context, object);
}

/* Visits an index of a node in VRM 0.x, where -1 means none. */
static void visit_old_member(const vrm_visit *v, uint32_t object, const char *key, gltf_vrm_role role)
{
    const uint32_t value = ffd_json_tree_member(&v->document->tree, object, key);
    double number;
    const bool is_none =
        ffd_json_tree_number(&v->document->tree, value, &number) && number >= -1 && number <= -1;
    if (!is_none)
        visit_node(v, value, role);
}

/* Visits the member "node" of each element of a VRM 1.0 list. */
static void visit_list(const vrm_visit *v, uint32_t object, const char *list, gltf_vrm_role role)
{
    const json_tree *const tree = &v->document->tree;
    for (uint32_t e = ffd_gltf_first(v->document, object, list); e != JSON_NONE;
         e = ffd_json_tree_after(tree, e))
        visit_member(v, e, "node", role);
}

static void visit_springs(const vrm_visit *v)
{
    const gltf_document *const d = v->document;
    const uint32_t springs = ffd_gltf_extension(d, 0, "VRMC_springBone");
    const uint32_t old =
        ffd_json_tree_member(&d->tree, ffd_gltf_extension(d, 0, "VRM"), "secondaryAnimation");
    visit_list(v, springs, "colliders", VRM_COLLIDER);
    for (uint32_t g = ffd_gltf_first(d, old, "colliderGroups"); g != JSON_NONE;
         g = ffd_json_tree_after(&d->tree, g))
        visit_node(v, ffd_json_tree_member(&d->tree, g, "node"), VRM_COLLIDER);
    for (uint32_t s = ffd_gltf_first(d, springs, "springs"); s != JSON_NONE;
         s = ffd_json_tree_after(&d->tree, s)) {
        visit_node(v, ffd_json_tree_member(&d->tree, s, "center"), VRM_NAMED);
        visit_list(v, s, "joints", VRM_SPRING);
    }
    for (uint32_t g = ffd_gltf_first(d, old, "boneGroups"); g != JSON_NONE;
         g = ffd_json_tree_after(&d->tree, g)) {
        visit_old_member(v, g, "center", VRM_NAMED);
        for (uint32_t b = ffd_gltf_first(d, g, "bones"); b != JSON_NONE; b = ffd_json_tree_after(&d->tree, b))
            visit_node(v, b, VRM_SPRING_ROOT);
    }
}

/* Visits the bone that the offset of the eyes is relative to. A value that is not a node is not reported
   here: it is visited as a bone too. */
static void visit_eyes(const vrm_visit *v, uint32_t index)
{
    if (index != JSON_NONE && ffd_gltf_node(v->document, index) != GLTF_NONE)
        visit_node(v, index, VRM_EYES);
}

/* VRM 1.0: {"hips": {"node": 0}, ..}. */
static void visit_humanoid(const vrm_visit *v)
{
    const json_tree *const tree = &v->document->tree;
    const uint32_t vrm = ffd_gltf_extension(v->document, 0, "VRMC_vrm");
    const uint32_t bones =
        ffd_json_tree_member(tree, ffd_json_tree_member(tree, vrm, "humanoid"), "humanBones");
    const uint32_t eyes =
        ffd_json_tree_member(tree, ffd_json_tree_member(tree, vrm, "lookAt"), "offsetFromHeadBone");
    if (bones == JSON_NONE || tree->values[bones].kind != JSON_OBJECT)
        return;
    for (uint32_t b = ffd_json_tree_first(tree, bones); b != JSON_NONE; b = ffd_json_tree_after(tree, b)) {
        visit_member(v, b, "node", VRM_BONE);
        if (eyes != JSON_NONE && ffd_json_tree_key_is(tree, b, "head"))
            visit_eyes(v, ffd_json_tree_member(tree, b, "node"));
    }
}

/* VRM 0.x: [{"bone": "hips", "node": 0}, ..]; the first person bone is the head unless one is named. */
static void visit_old_humanoid(const vrm_visit *v)
{
    const json_tree *const tree = &v->document->tree;
    const uint32_t vrm = ffd_gltf_extension(v->document, 0, "VRM");
    const uint32_t person = ffd_json_tree_member(tree, vrm, "firstPerson");
    const uint32_t named = ffd_json_tree_member(tree, person, "firstPersonBone");
    const bool is_named = named != JSON_NONE && ffd_gltf_node(v->document, named) != GLTF_NONE;
    const bool has_eyes = ffd_json_tree_member(tree, person, "firstPersonBoneOffset") != JSON_NONE;
    for (uint32_t b = ffd_gltf_first(v->document, ffd_json_tree_member(tree, vrm, "humanoid"), "humanBones");
         b != JSON_NONE; b = ffd_json_tree_after(tree, b)) {
        const uint32_t bone = ffd_json_tree_member(tree, b, "bone"),
                       node = ffd_json_tree_member(tree, b, "node");
        visit_node(v, node, VRM_BONE);
        if (has_eyes && !is_named && bone != JSON_NONE && ffd_json_tree_string_is(tree, bone, "head"))
            visit_eyes(v, node);
    }
    visit_old_member(v, person, "firstPersonBone", VRM_NAMED);
    if (has_eyes)
        visit_eyes(v, named);
}

static void visit_constraints(const vrm_visit *v)
{
    static const char *const kinds[] = {"roll", "aim", "rotation"};
    const gltf_document *const d = v->document;
    for (size_t n = 0; n < d->model.node_count; n++) {
        const uint32_t driven = ffd_gltf_extension(d, d->node_values.values[n], "VRMC_node_constraint");
        const uint32_t constraint = ffd_json_tree_member(&d->tree, driven, "constraint");
        if (driven == JSON_NONE)
            continue;
        v->visit(v->context, n, VRM_DRIVEN);
        if (ffd_json_tree_member(&d->tree, constraint, "aim") != JSON_NONE)
            v->visit(v->context, n, VRM_AIM);
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            const uint32_t kind = ffd_json_tree_member(&d->tree, constraint, kinds[k]);
            if (kind != JSON_NONE)
                visit_member(v, kind, "source", VRM_NAMED);
        }
    }
}

static void visit_all(const vrm_visit *v)
{
    visit_springs(v);
    visit_humanoid(v);
    visit_old_humanoid(v);
    visit_constraints(v);
}

void ffd_gltf_visit_vrm(const gltf_document *document, gltf_vrm_visitor *visit, void *context)
{
    visit_all(&(vrm_visit){document, visit, NULL, context});
}

typedef struct vrm_check {
    gltf_document *document;
    ffd_status status;
    ffd_error *error;
} vrm_check;

static void pass_over(void *context, size_t node, gltf_vrm_role role)
{
    (void)context;
    (void)node;
    (void)role;
}

static void note_fault(void *context, uint32_t value)
{
    vrm_check *const check = context;
    const gltf_document *const d = check->document;
    char number[40] = "";
    double found;
    /* A valid index of a node is not shown: the fault is that it stands where an object should. */
    if (ffd_json_tree_number(&d->tree, value, &found) && ffd_gltf_node(d, value) == GLTF_NONE)
        snprintf(number, sizeof number, ", not %g", found);
    if (check->status == FFD_OK)
        check->status = ffd_gltf_flaw(check->document, value, check->error,
                                      "VRM should name one of the %zu nodes here%s: it is ignored",
                                      d->model.node_count, number);
}

ffd_status ffd_gltf_check_vrm(gltf_document *document, ffd_error *error)
{
    vrm_check check = {document, FFD_OK, error};
    visit_all(&(vrm_visit){document, pass_over, note_fault, &check});
    return check.status;
}
