/* ply_weights.c - properties of the vertices of a PLY file as weights. */
#include "io/ply/ply_weights.h"
#include "base/system/deadline.h"
#include <string.h>

/* Colours as most programs name them, and as older ones do. */
static const char *const colours[][4] = {{"red", "green", "blue", "alpha"},
                                         {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}};

/* Returns the value of a type that stands for 1; 0: its numbers are not weights. */
static double unit_of(number_type type)
{
    switch (type) {
    case NUMBER_FLOAT:
    case NUMBER_DOUBLE:
        return 1;
    case NUMBER_UINT8:
        return 255;
    case NUMBER_UINT16:
        return 65535;
    default:
        return 0;
    }
}

static ffd_status find(const ply_document *d, const weight_source *source, const ply_property **found,
                       ffd_error *error)
{
    const size_t names = sizeof colours / sizeof *colours;
    const char *const name = source->kind == WEIGHT_COLOR ? colours[0][source->channel] : source->name;
    *found = NULL;
    for (size_t i = 0; i < names && source->kind == WEIGHT_COLOR && !*found; i++)
        *found = ffd_ply_find_property(d->vertex, colours[i][source->channel]);
    if (source->kind == WEIGHT_PROPERTY)
        *found = ffd_ply_find_property(d->vertex, name);
    if (!*found)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, d->vertex->line,
                             "the vertices have no property \"%.80s\" ({weight})", name);
    if ((*found)->is_list || unit_of((*found)->type) == 0)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, (*found)->line,
                             "the property \"%.80s\" is %s%s: only float, double, uchar and ushort can be "
                             "weights ({weight})",
                             name, (*found)->is_list ? "a list of " : "of type ",
                             ffd_ply_type_name((*found)->type));
    return FFD_OK;
}

/* Rows of a fixed size: the number is at one place in each. */
static void read_rows(const ply_document *d, const ply_property *property, double *weights)
{
    const double scale = unit_of(property->type);
    size_t offset = 0;
    for (const ply_property *p = d->vertex->properties; p != property; p++)
        offset += ffd_type_size(p->type);
    for (size_t v = 0; v < d->file.part.vertex_count; v++)
        weights[v] = ply_load_binary(d->header.encoding, property->type, ply_row(d, v) + offset) / scale;
}

static ffd_status walk_rows(const ply_document *d, const ply_property *property, double *weights,
                            ffd_error *error)
{
    ply_walk walk;
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (size_t v = 0; v < d->file.part.vertex_count; v++) {
        TRY(ffd_deadline_check_at(v, error));
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *const p = &d->vertex->properties[i];
            text_word word;
            if (p != property) {
                ffd_ply_walk_skip(&walk, p);
                continue;
            }
            ffd_ply_walk_value(&walk, p->type, &word);
            if (!ffd_ply_load(d->header.encoding, p->type, word, &weights[v]))
                return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk.line,
                                     "%.*s of vertex %zu (counted from 0) is not a number: \"%.*s\"",
                                     ffd_text_display_size(p->name), p->name.first, v,
                                     ffd_text_display_size(word), word.first);
            weights[v] /= unit_of(p->type);
        }
    }
    return FFD_OK;
}

static ffd_status read(const mesh_document *document, const weight_source *source, double *weights,
                       ffd_error *error)
{
    const ply_document *const d = ffd_ply_of(document);
    const ply_property *property;
    TRY(find(d, source, &property, error));
    if (!d->has_fixed_rows)
        return walk_rows(d, property, weights, error);
    read_rows(d, property, weights);
    return FFD_OK;
}

const mesh_weight_calls ffd_ply_weights = {.kinds = WEIGHT_BIT(WEIGHT_COLOR) | WEIGHT_BIT(WEIGHT_PROPERTY),
                                           .read = read};
