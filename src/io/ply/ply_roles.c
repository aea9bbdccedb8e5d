/* ply_roles.c - finds the meanings of the elements and properties of a PLY file. */
#include "io/ply/ply_document.h"

static const char *const slot_names[PLY_SLOT_COUNT] = {"x", "y", "z", "nx", "ny", "nz"};

const char *const ffd_ply_texcoord_names[PLY_TEXCOORD_NAMES][2] = {
    {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};

/* Marks and returns the vertex property of a slot's name; NULL if there is none, or it is a list. */
static ply_property *fill_slot(ply_document *d, size_t slot)
{
    const ply_property *found = ffd_ply_find_property(d->vertex, slot_names[slot]);
    if (!found || found->is_list)
        return NULL;
    ply_property *property = &d->header.properties[found - d->header.properties];
    property->slot = (unsigned char)slot;
    d->types[slot] = property->type;
    return property;
}

static ffd_status find_positions(ply_document *d, ffd_error *error)
{
    if (ffd_ply_find_element(&d->header, "chunk") && ffd_ply_find_property(d->vertex, "packed_position"))
        return ffd_fail_line(error, FFD_E_UNSUPPORTED, d->file.name, d->vertex->line,
                             "compressed Gaussian splats (packed_position): save them uncompressed");
    for (size_t slot = 0; slot < PLY_NORMAL_SLOT; slot++)
        if (!fill_slot(d, slot))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, d->vertex->line,
                                 "element vertex has no property %s that is one number", slot_names[slot]);
    return FFD_OK;
}

/* All three must be float or double; otherwise none of them is used. */
static void find_normals(ply_document *d)
{
    ply_property *properties[3];
    bool there = true, whole = false;
    for (size_t i = 0; i < 3; i++) {
        properties[i] = fill_slot(d, PLY_NORMAL_SLOT + i);
        there = there && properties[i];
        whole = whole || (properties[i] && !number_is_real(properties[i]->type));
    }
    d->has_normals = there && !whole;
    d->has_whole_normals = there && whole;
    for (size_t i = 0; i < 3; i++)
        if (properties[i] && !d->has_normals)
            properties[i]->slot = PLY_NO_SLOT;
}

/* Returns the list of vertices of an element; NULL if it has none, or element is NULL. */
static const ply_property *find_corners(const ply_element *element)
{
    static const char *const names[] = {"vertex_indices", "vertex_index"};
    const ply_property *found = NULL;
    for (size_t i = 0; element && i < sizeof names / sizeof *names && !found; i++) {
        found = ffd_ply_find_property(element, names[i]);
        if (found && !found->is_list)
            found = NULL;
    }
    return found;
}

static void find_faces(ply_document *d)
{
    const ply_element *const face = ffd_ply_find_element(&d->header, "face");
    d->face_corners = find_corners(face);
    d->face = d->face_corners ? face : NULL;
    d->strips = ffd_ply_find_element(&d->header, "tristrips");
    d->strip_corners = find_corners(d->strips);
}

/* As for vertices, all three must be present. */
static void find_face_normals(ply_document *d)
{
    const ply_property *found[3] = {NULL, NULL, NULL};
    bool there = d->face, whole = false;
    for (size_t a = 0; a < 3 && there; a++) {
        found[a] = ffd_ply_find_property(d->face, slot_names[PLY_NORMAL_SLOT + a]);
        there = found[a] && !found[a]->is_list;
        whole = whole || (there && !number_is_real(found[a]->type));
    }
    d->has_whole_face_normals = there && whole;
    for (size_t a = 0; a < 3; a++)
        d->face_normals[a] = there && !whole ? found[a] : NULL;
    d->file.base.has_face_normals = d->face_normals[0];
}

static void find_offsets(ply_document *d)
{
    size_t offset = 0;
    d->has_fixed_rows = d->header.encoding != PLY_ASCII && !d->vertex->has_lists;
    for (size_t slot = 0; slot < PLY_SLOT_COUNT; slot++)
        d->offsets[slot] = PLY_NOWHERE;
    for (size_t i = 0; i < d->vertex->property_count && d->has_fixed_rows; i++) {
        const ply_property *const property = &d->vertex->properties[i];
        if (property->slot != PLY_NO_SLOT)
            d->offsets[property->slot] = offset;
        offset += ffd_type_size(property->type);
    }
}

/* Whether the harmonics to turn are contiguous floats in the machine's byte order. */
static bool are_plain(const ply_document *d)
{
    const size_t count = HARMONICS_CHANNELS * (size_t)harmonics_count(d->file.part.form.degree);
    bool all = d->has_fixed_rows && d->header.encoding == PLY_LITTLE_ENDIAN;
    for (size_t i = 0; i < count && all; i++)
        all = d->types[PLY_REST_SLOT + i] == NUMBER_FLOAT &&
              d->offsets[PLY_REST_SLOT + i] == d->offsets[PLY_REST_SLOT] + i * sizeof(float);
    return all;
}

ffd_status ffd_ply_find_roles(ply_document *d, ffd_error *error)
{
    d->vertex = ffd_ply_find_element(&d->header, "vertex");
    if (!d->vertex)
        return ffd_fail_file(error, FFD_E_INVALID, d->file.name, "the header has no element vertex");
    if (d->vertex->count > UINT32_MAX)
        return ffd_fail_line(error, FFD_E_LIMIT, d->file.name, d->vertex->line, "more than %u vertices",
                             (unsigned)UINT32_MAX);
    TRY(find_positions(d, error));
    find_normals(d);
    find_faces(d);
    find_face_normals(d);
    ffd_ply_find_splats(d);
    find_offsets(d);
    d->has_plain_rests = are_plain(d);
    return FFD_OK;
}

const ply_element *ffd_ply_find_edges(const ply_document *d)
{
    const ply_element *edge = ffd_ply_find_element(&d->header, "edge");
    return edge && ffd_ply_find_property(edge, "vertex1") && ffd_ply_find_property(edge, "vertex2") ? edge
                                                                                                    : NULL;
}
