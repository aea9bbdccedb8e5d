#include "io/ply/ply_strips.h"
#include "mesh/face_filler.h"

typedef struct strip_reader {
    const ply_document *document;
    ply_walk walk;
    uint32_t last[2]; /* the two vertices before */
    size_t length;    /* number of vertices since the strip began */
    ply_triangle_visitor *visit;
    void *context;
    ffd_error *error;
} strip_reader;

/* Takes the next vertex of the strip. */
static ffd_status add_vertex(strip_reader *r, uint32_t vertex)
{
    const uint32_t a = r->last[0], b = r->last[1];
    const bool turned = r->length % 2 == 1; /* the second, the fourth, .. */
    const uint32_t triangle[3] = {turned ? b : a, turned ? a : b, vertex};
    const bool there = r->length >= 2 && a != b && a != vertex && b != vertex;
    r->last[0] = b;
    r->last[1] = vertex;
    r->length++;
    return !there || r->visit(r->context, triangle) ? FFD_OK : ffd_fail_memory(r->error);
}

static ffd_status read_strip(strip_reader *r, uint64_t row)
{
    const ply_document *d = r->document;
    const ply_property *const list = d->strip_corners;
    text_word word;
    size_t count, vertex;
    double value;
    ffd_status status = FFD_OK;
    r->length = 0;
    if (!ffd_ply_walk_list(&r->walk, list, &word, &count))
        return ffd_faces_changed(d->file.name, r->error);
    for (size_t i = 0; i < count && status == FFD_OK; i++) {
        ffd_ply_walk_value(&r->walk, list->type, &word);
        if (ffd_ply_load_count(d->header.encoding, list->type, word, &vertex) &&
            vertex < d->file.part.vertex_count)
            status = add_vertex(r, (uint32_t)vertex);
        else if (ffd_ply_load(d->header.encoding, list->type, word, &value) && value == -1)
            r->length = 0;
        else
            status = ffd_ply_refuse_vertex(d, &r->walk, "strip", row, list->type, word, r->error);
    }
    return status;
}

static ffd_status read_row(strip_reader *r, uint64_t row)
{
    const ply_element *const strips = r->document->strips;
    ffd_status status = FFD_OK;
    ffd_ply_walk_row(&r->walk);
    for (size_t i = 0; i < strips->property_count && status == FFD_OK; i++) {
        if (&strips->properties[i] == r->document->strip_corners)
            status = read_strip(r, row);
        else
            ffd_ply_walk_skip(&r->walk, &strips->properties[i]);
    }
    return status;
}

ffd_status ffd_ply_visit_strips(const ply_document *d, ply_triangle_visitor *visit, void *context,
                                ffd_error *error)
{
    strip_reader r = {.document = d, .visit = visit, .context = context, .error = error};
    ffd_status status = FFD_OK;
    if (!d->strip_corners)
        return FFD_OK;
    ffd_ply_document_walk(d, d->strips, &r.walk);
    for (uint64_t row = 0; row < d->strips->count && status == FFD_OK; row++)
        status = read_row(&r, row);
    return status;
}
