/* obj_open.c - opens and closes an OBJ file. */
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/content.h"
#include "base/text/words.h"
#include "io/obj/obj_document.h"
#include "io/obj/obj_faces.h"
#include "io/obj/obj_vectors.h"

/* A file that is not text may have lines that begin like a statement. */
static ffd_status check_bytes(const obj_document *d, ffd_error *error)
{
    const content_kind *const kind = ffd_content_kind(d->file.input.data, d->file.input.size);
    if (d->file.input.size == 0)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, 1, "the file has no content");
    if (kind && kind->is_binary)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, 1,
                             "is not an OBJ file, which is text in ASCII or UTF-8");
    return FFD_OK;
}

/* Statements of which a file without a vertex may consist. */
static bool is_statement(const obj_scan *scan)
{
    static const char *const others[] = {"s",      "mg",     "vp",         "lod",      "cstype",
                                         "usemap", "maplib", "shadow_obj", "trace_obj"};
    bool is_one = scan->keyword != OBJ_OTHER;
    for (size_t i = 0; i < sizeof others / sizeof *others && !is_one; i++)
        is_one = ffd_text_is(scan->name, others[i]);
    return is_one;
}

/* Refuses a file without any statement. Statements that are not known are let pass, so that every text
   would be an empty mesh. */
static ffd_status check_statements(const obj_document *d, ffd_error *error)
{
    const content_kind *const kind = ffd_content_kind(d->file.input.data, d->file.input.size);
    bool found = false;
    obj_walk walk;
    if (d->vertices || d->texcoords || d->normals || d->faces || d->lines || d->points)
        return FFD_OK;
    ffd_obj_document_walk(d, &walk);
    while ((!kind || kind->format == FFD_FORMAT_OBJ) && !found && ffd_obj_walk_next(&walk))
        found = is_statement(&walk.scan);
    if (found)
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, 1,
                         "is not an OBJ file: it has no statement of one");
}

static ffd_status note_unknown(obj_document *d, ffd_error *error)
{
    char shown[200] = "";
    if (d->unknown.count > 0)
        ffd_bytes_shown(d->unknown.name.first, (size_t)ffd_text_display_size(d->unknown.name), shown,
                        sizeof shown);
    for (size_t i = 0; i < d->unknown.count; i++)
        TRY(ffd_flaw_line(&d->file.base.flaws, d->file.name, d->unknown.line, error,
                          "\"%s\" is no statement of OBJ: it is left as it is", shown));
    return FFD_OK;
}

static void describe_part(obj_document *d)
{
    d->file.part.vertex_count = d->vertices;
    if (d->pair_start) {
        d->file.part.normal_start = d->pair_start;
        d->file.part.normal_count = d->pair_start[d->vertices];
    }
}

static void free_document(obj_document *d)
{
    ffd_obj_blocks_free(&d->blocks);
    ffd_obj_free_normals(d);
    ffd_spill_free(&d->position_store);
    ffd_spill_free(&d->direction_store);
    ffd_spill_free(&d->result_store);
    ffd_free(d->pair_start);
    ffd_free(d->pair_normal);
    ffd_free(d->selected_vertices);
    ffd_free(d->selected_faces);
    ffd_free(d->selected_pairs);
    ffd_free(d->held_normals);
    ffd_free(d->position_changes);
    ffd_free(d->direction_changes);
    ffd_free(d->file.used);
    ffd_free(d->file.name);
    ffd_free(d->file.path);
    ffd_free(d);
}

static ffd_status read_elements(obj_document *d, ffd_error *error)
{
    obj_users users = {0};
    ffd_status status;
    TRY_END(ffd_obj_read_vectors(d, &users, error));
    TRY_END(ffd_obj_read_faces(d, &users, error));
end:
    ffd_obj_users_free(d, &users);
    return status;
}

/* What a backslash took from the file can be what is missing below: leads to that line too. */
static ffd_status lead_to_joined(const obj_document *d, ffd_status status, ffd_error *error)
{
    if (status != FFD_E_INVALID || !error || d->joined_line == 0 || error->line <= d->joined_line)
        return status;
    return ffd_fail_line(error, status, d->file.name, error->line,
                         "%s (the backslash at the end of line %zu joins the next one to it)", error->message,
                         d->joined_line);
}

ffd_status ffd_obj_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    obj_document *d = ffd_file_document_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    d->threads = ffd_threads_for_bytes(source->threads, input->size);
    d->only_positions = source->only_positions;
    ffd_status status;
    TRY_END(check_bytes(d, error));
    TRY_END(read_elements(d, error));
    TRY_END(check_statements(d, error));
    TRY_END(note_unknown(d, error));
    describe_part(d);
    *document = ffd_file_document_ready(&d->file, true, source);
    return FFD_OK;
end:
    status = lead_to_joined(d, status, error);
    free_document(d);
    return status;
}

void ffd_obj_close(mesh_document *document)
{
    obj_document *d = (obj_document *)document;
    if (!d)
        return;
    ffd_file_unload(&d->file.input);
    free_document(d);
}
