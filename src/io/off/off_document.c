#include "io/off/off_document.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"

static ffd_status refuse_number(const off_document *d, size_t line, const char *what, text_word word,
                                ffd_error *error)
{
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, line, "%s is not a number: \"%s\"", what,
                         ffd_text_shown(word).text);
}

static ffd_status read_numbers(off_document *d, const off_vertex *v, size_t index, ffd_error *error)
{
    static const char *const names[OFF_NUMBERS_MAX] = {
        "coordinate x of a vertex", "coordinate y of a vertex", "coordinate z of a vertex",
        "coordinate x of a normal", "coordinate y of a normal", "coordinate z of a normal"};
    const size_t needed = off_vertex_width(&d->header);
    for (size_t i = 0; i < v->found; i++) {
        double *vectors = i < 3 ? d->file.positions : d->file.directions;
        if (!ffd_text_number(v->numbers[i], &vectors[3 * index + i % 3]))
            return refuse_number(d, v->line, names[i], v->numbers[i], error);
    }
    if (v->found < needed)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, v->line,
                             "a vertex needs %zu numbers, found %zu", needed, v->found);
    return FFD_OK;
}

/* Checks that the rest of a vertex (colour, u v) is numbers; these stay as they are. */
static ffd_status check_rest(const off_document *d, off_walk *walk, ffd_error *error)
{
    const size_t least = ffd_off_header_rest_min(&d->header), most = ffd_off_header_rest_max(&d->header);
    size_t found = 0;
    text_word word;
    for (; ffd_off_walk_rest(walk, &word); found++) {
        double value;
        if (!ffd_text_number(word, &value))
            return refuse_number(d, walk->scan.line, "what follows a vertex", word, error);
    }
    if (found >= least && found <= most)
        return FFD_OK;
    const size_t width = off_vertex_width(&d->header);
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                         "a vertex has %zu numbers at %s, found %zu", width + (found < least ? least : most),
                         found < least ? "least" : "most", width + found);
}

static ffd_status read_vertices(off_document *d, off_walk *walk, ffd_error *error)
{
    d->file.positions = ffd_alloc(d->header.vertices, 3 * sizeof *d->file.positions);
    if (d->header.has_normals)
        d->file.directions = ffd_alloc(d->header.vertices, 3 * sizeof *d->file.directions);
    if (!d->file.positions || (d->header.has_normals && !d->file.directions))
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->header.vertices; i++) {
        off_vertex vertex;
        TRY(ffd_deadline_check_at(i, error));
        if (!ffd_off_walk_vertex(walk, &vertex))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                                 "the file ends after %zu of %zu vertices", i, d->header.vertices);
        TRY(read_numbers(d, &vertex, i, error));
        TRY(check_rest(d, walk, error));
    }
    return FFD_OK;
}

/* More vertices or faces than the header states would stay where they are, or be taken for the others. */
static ffd_status note_behind(off_document *d, const text_scan *scan, ffd_error *error)
{
    const size_t bytes = (size_t)(scan->last - scan->at);
    return bytes == 0 ? FFD_OK
                      : ffd_flaw_line(&d->file.base.flaws, d->file.name, scan->line, error,
                                      "%zu %s behind the faces that the header states: %s as %s", bytes,
                                      ffd_plural(bytes, "byte stands", "bytes stand"),
                                      ffd_plural(bytes, "it stays", "they stay"),
                                      ffd_plural(bytes, "it is", "they are"));
}

static ffd_status read_body(off_document *d, ffd_error *error)
{
    off_walk walk;
    ffd_off_walk_begin(&d->header, &walk);
    TRY(read_vertices(d, &walk, error));
    d->faces_begin = walk;
    TRY(ffd_off_read_faces(d, &walk, error));
    ffd_text_next_line(&walk.scan);
    /* So that empty lines and comments do not count as bytes after the last face. */
    ffd_text_find(&walk.scan);
    d->behind = walk.scan.at;
    return note_behind(d, &walk.scan, error);
}

ffd_status ffd_off_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    off_document *d = ffd_file_document_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    ffd_status status;
    TRY_END(ffd_off_header_read(&d->file.input, d->file.name, &d->header, error));
    TRY_END(
        ffd_file_document_note_mark(&d->file, ffd_text_size(d->file.input.data, d->file.input.size), error));
    TRY_END(read_body(d, error));
    d->file.part.vertex_count = d->header.vertices;
    d->file.part.normal_count = d->file.directions ? d->header.vertices : 0;
    *document = ffd_file_document_ready(&d->file, true, source);
    return FFD_OK;
end:
    ffd_file_document_free(&d->file);
    return status;
}
