/* volume_describe.c - what `ffd info` reports of a volume mesh. */
#include "io/volume/volume_document.h"
#include <string.h>

static void describe_cells(const volume_cells *cells, json_text *json)
{
    uint64_t counts[CELL_KINDS] = {0};
    for (size_t c = 0; c < cells->count; c++)
        counts[cells->kinds[c]]++;
    ffd_json_array(json, "cell_types", false);
    for (size_t k = 0; k < CELL_KINDS; k++) {
        if (!counts[k])
            continue;
        ffd_json_object(json, NULL, true);
        ffd_json_string(json, "name", ffd_cell_kind(k)->name);
        ffd_json_count(json, "count", counts[k]);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

static size_t count_dimension(const volume_cells *cells, uint8_t dimension)
{
    size_t count = 0;
    for (size_t c = 0; c < cells->count; c++)
        count += ffd_cell_kind(cells->kinds[c])->dimension == dimension;
    return count;
}

ffd_status ffd_volume_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    const json_count members[] = {
        {"vertices", d->file.part.vertex_count},
        {"normals", d->file.part.normal_count},
        {"cells", d->cells.count},
        {"volumes", d->cells.volumes},
        {"faces", count_dimension(&d->cells, 2) + d->listed_faces},
        {"lines", count_dimension(&d->cells, 1)},
        {"points", count_dimension(&d->cells, 0)},
        {"groups", d->group_count},
    };
    (void)error;
    ffd_json_string(json, "encoding", d->encoding);
    if (d->content)
        ffd_json_string(json, "dataset", d->content);
    ffd_json_string(json, "number_type", ffd_type_name(d->point_type));
    ffd_json_count(json, "dimensions", d->dimensions);
    ffd_json_counts(json, members, sizeof members / sizeof *members);
    describe_cells(&d->cells, json);
    return FFD_OK;
}
