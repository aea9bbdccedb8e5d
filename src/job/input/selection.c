#include "job/input/selection.h"
#include "base/memory/memory.h"

ffd_status ffd_selector_check(const char *text, ffd_error *error)
{
    mesh_selector selector;
    return ffd_selector_parse("only", text, &selector, error);
}

ffd_status ffd_selection_apply(const char *const *only, size_t count, const char *name,
                               mesh_document *document, ffd_error *error)
{
    const mesh_selector_calls *const calls = document->format->selectors;
    if (count == 0)
        return FFD_OK;
    mesh_selector *selectors = ffd_alloc(count, sizeof *selectors);
    ffd_status status;
    TRY_END(selectors ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++) {
        TRY_END(ffd_selector_parse("only", only[i], &selectors[i], error));
        TRY_END(ffd_selector_check_kind(&selectors[i], calls ? calls->kinds : 0, document->format->name, name,
                                        error));
    }
    TRY_END(calls->select(document, selectors, count, error));
end:
    ffd_free(selectors);
    return status;
}

bool ffd_selection_is_all(const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (document->parts[i].skipped || document->parts[i].selected)
            return false;
    return true;
}

/* marks: one byte for each vertex of the document. */
static void mark_selected(const mesh_document *document, uint8_t *marks)
{
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *part = &document->parts[i];
        for (size_t v = 0; v < part->vertex_count && !part->repeats_positions; v++)
            *marks++ = ffd_part_selects(part, v);
    }
}

ffd_status ffd_selection_reduce(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    uint8_t *marks = ffd_alloc(faces->vertex_count, 1);
    if (!marks)
        return ffd_fail_memory(error);
    mark_selected(document, marks);
    size_t kept = 0, end = 0, first = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const size_t last = faces->start[f + 1];
        bool all = true;
        for (size_t c = first; c < last && all; c++)
            all = marks[faces->corners[c]];
        for (size_t c = first; c < last && all; c++)
            faces->corners[end++] = faces->corners[c];
        first = last;
        kept += all;
        faces->start[kept] = end;
    }
    faces->face_count = kept;
    ffd_free(marks);
    return FFD_OK;
}
