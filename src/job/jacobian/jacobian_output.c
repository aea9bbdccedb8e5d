/* jacobian_output.c - writes the matrix. */
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/text/buffer.h"
#include "io/npy/npy.h"
#include "io/npy/zip_stored.h"
#include "job/jacobian/jacobian.h"
#include <stdio.h>
#include <string.h>

/* Vertices per tile. */
#define ROWS_TILE ((size_t)256)

/* The bytes of a tile's rows, kept until all earlier tiles are written. */
typedef struct rows_slot {
    jacobian_rows rows;
    byte_buffer bytes;
    ffd_status status;
} rows_slot;

/* A pass over all rows. put appends one row's share of the output to bytes. */
typedef struct rows_pass {
    const jacobian *j;
    rows_slot *slots;
    int slot_count;
    void (*put)(const struct rows_pass *pass, const jacobian_entry *entries, size_t count, uint64_t row,
                byte_buffer *bytes);
    bool is_wide;              /* indices have 64 bits */
    uint64_t *starts, *moving; /* filled by a pass that only counts */
    zip_writer *zip;           /* otherwise one of these is written: */
    file_output *output;
    ffd_status status;
    ffd_error *error;
} rows_pass;

static void make_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    rows_pass *const pass = context;
    const jacobian *const j = pass->j;
    rows_slot *const slot = &pass->slots[worker];
    const size_t each = j->blocks ? 3 : 1;
    (void)tile;
    if (ffd_deadline_passed()) /* which the pass fails for, when the tile is finished */
        return;
    ffd_jacobian_rows_begin(j, first, &slot->rows);
    for (size_t i = first; i < last; i++) {
        ffd_jacobian_rows_fill(j, i, &slot->rows);
        for (size_t a = 0; a < each; a++) {
            const uint64_t row = each * i + a;
            if (pass->starts)
                pass->starts[row + 1] = slot->rows.counts[a];
            else
                pass->put(pass, slot->rows.entries[a], slot->rows.counts[a], row, &slot->bytes);
        }
    }
}

static void finish_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    rows_pass *const pass = context;
    byte_buffer *const bytes = &pass->slots[worker].bytes;
    (void)tile, (void)first, (void)last;
    if (!pass->status)
        pass->status = ffd_deadline_check(pass->error);
    if (!pass->status && bytes->failed)
        pass->status = ffd_fail_memory(pass->error);
    else if (!pass->status && pass->zip)
        pass->status = ffd_zip_write(pass->zip, bytes->data, bytes->size, pass->error);
    else if (!pass->status && pass->output)
        pass->status = ffd_output_write(pass->output, bytes->data, bytes->size, pass->error);
    bytes->size = 0;
}

static void free_slots(rows_pass *pass)
{
    for (int i = 0; pass->slots && i < pass->slot_count; i++) {
        ffd_jacobian_rows_free(&pass->slots[i].rows);
        ffd_buffer_free(&pass->slots[i].bytes);
    }
    ffd_free(pass->slots);
}

static ffd_status run_pass(rows_pass *pass, ffd_error *error)
{
    pass->error = error;
    pass->slot_count = ffd_ordered_slots(pass->j->job.threads);
    pass->slots = ffd_alloc_zero((size_t)pass->slot_count, sizeof *pass->slots);
    ffd_status status;
    TRY_END(pass->slots ? FFD_OK : ffd_fail_memory(error));
    for (int i = 0; i < pass->slot_count; i++)
        TRY_END(ffd_jacobian_rows_make(pass->j, &pass->slots[i].rows, error));
    if (!ffd_parallel_in_order(pass->j->count, ROWS_TILE, pass->j->job.threads, make_tile, finish_tile, pass))
        TRY_END(ffd_fail_memory(error));
    status = pass->status;
end:
    free_slots(pass);
    return status;
}

ffd_status ffd_jacobian_count(const jacobian *j, uint64_t *starts, uint64_t *moving, ffd_error *error)
{
    rows_pass pass = {.j = j, .starts = starts};
    const size_t each = j->blocks ? 3 : 1;
    starts[0] = 0;
    TRY(run_pass(&pass, error));
    *moving = 0;
    for (size_t i = 0; i < j->count; i++) {
        uint64_t entries = 0;
        for (size_t a = 0; a < each; a++)
            entries += starts[each * i + a + 1];
        *moving += entries > 0;
    }
    for (size_t row = 0; row < j->rows; row++)
        starts[row + 1] += starts[row];
    return FFD_OK;
}

static void put_index(const rows_pass *pass, uint64_t value, byte_buffer *bytes)
{
    unsigned char stored[8];
    store_u64(stored, value);
    ffd_buffer_append(bytes, (const char *)stored, pass->is_wide ? 8 : 4);
}

static void put_double(double value, byte_buffer *bytes)
{
    unsigned char stored[8];
    store_double(stored, value);
    ffd_buffer_append(bytes, (const char *)stored, sizeof stored);
}

static void put_indices(const rows_pass *pass, const jacobian_entry *entries, size_t count, uint64_t row,
                        byte_buffer *bytes)
{
    (void)row;
    for (size_t e = 0; e < count; e++)
        put_index(pass, entries[e].column, bytes);
}

static void put_values(const rows_pass *pass, const jacobian_entry *entries, size_t count, uint64_t row,
                       byte_buffer *bytes)
{
    (void)row, (void)pass;
    for (size_t e = 0; e < count; e++)
        put_double(entries[e].value, bytes);
}

/* Writes entries as lines of Matrix Market: row and column counted from 1, and the shortest text of the
   value. */
static void put_lines(const rows_pass *pass, const jacobian_entry *entries, size_t count, uint64_t row,
                      byte_buffer *bytes)
{
    (void)pass;
    for (size_t e = 0; e < count; e++) {
        ffd_buffer_format(bytes, "%llu %llu ", (unsigned long long)row + 1,
                          (unsigned long long)entries[e].column + 1);
        ffd_buffer_number(bytes, entries[e].value);
        ffd_buffer_text(bytes, "\n");
    }
}

static void put_dense(const rows_pass *pass, const jacobian_entry *entries, size_t count, uint64_t row,
                      byte_buffer *bytes)
{
    size_t e = 0;
    (void)row;
    for (uint64_t column = 0; column < pass->j->columns; column++) {
        const bool is_there = e < count && entries[e].column == column;
        put_double(is_there ? entries[e].value : 0, bytes);
        e += is_there;
    }
}

/* Begins a member of the archive: a one-dimensional array. */
static ffd_status begin_array(zip_writer *zip, const char *name, const char *descr, uint64_t size,
                              size_t each, ffd_error *error)
{
    char header[NPY_HEADER_CAPACITY];
    const size_t length = ffd_npy_header(descr, size, 0, header);
    TRY(ffd_zip_member(zip, name, length + size * each, error));
    return ffd_zip_write(zip, header, length, error);
}

static ffd_status write_rows(const jacobian *j, zip_writer *zip, const char *name, uint64_t entries,
                             bool is_wide, bool values, ffd_error *error)
{
    rows_pass pass = {.j = j, .zip = zip, .put = values ? put_values : put_indices, .is_wide = is_wide};
    const char *const descr = values ? "<f8" : is_wide ? "<i8" : "<i4";
    TRY(begin_array(zip, name, descr, entries, values || is_wide ? 8 : 4, error));
    TRY(run_pass(&pass, error));
    return ffd_zip_member_end(zip, error);
}

static ffd_status write_starts(const jacobian *j, zip_writer *zip, const uint64_t *starts, bool is_wide,
                               ffd_error *error)
{
    const size_t each = is_wide ? 8 : 4;
    TRY(begin_array(zip, "indptr.npy", is_wide ? "<i8" : "<i4", j->rows + 1, each, error));
    for (size_t row = 0; row <= j->rows; row++) {
        unsigned char stored[8];
        store_u64(stored, starts[row]);
        TRY(ffd_zip_write(zip, stored, each, error));
    }
    return ffd_zip_member_end(zip, error);
}

/* Writes the word "csr" as a 0-dimensional array of three bytes. */
static ffd_status write_format(zip_writer *zip, ffd_error *error)
{
    char header[NPY_HEADER_CAPACITY];
    const size_t length = ffd_npy_header_of("|S3", "()", header);
    TRY(ffd_zip_member(zip, "format.npy", length + 3, error));
    TRY(ffd_zip_write(zip, header, length, error));
    TRY(ffd_zip_write(zip, "csr", 3, error));
    return ffd_zip_member_end(zip, error);
}

static ffd_status write_shape(const jacobian *j, zip_writer *zip, ffd_error *error)
{
    unsigned char shape[16];
    store_u64(shape, j->rows);
    store_u64(shape + 8, j->columns);
    TRY(begin_array(zip, "shape.npy", "<i8", 2, 8, error));
    TRY(ffd_zip_write(zip, shape, sizeof shape, error));
    return ffd_zip_member_end(zip, error);
}

/* Writes an archive that scipy.sparse.load_npz reads. */
static ffd_status write_npz(const jacobian *j, const uint64_t *starts, file_output *output, ffd_error *error)
{
    const uint64_t entries = starts[j->rows], most = INT32_MAX;
    const bool is_wide = entries > most || j->rows > most || j->columns > most;
    zip_writer zip;
    ffd_zip_begin(&zip, output);
    TRY(write_rows(j, &zip, "indices.npy", entries, is_wide, false, error));
    TRY(write_starts(j, &zip, starts, is_wide, error));
    TRY(write_format(&zip, error));
    TRY(write_shape(j, &zip, error));
    TRY(write_rows(j, &zip, "data.npy", entries, is_wide, true, error));
    return ffd_zip_end(&zip, error);
}

static ffd_status write_mtx(const jacobian *j, const uint64_t *starts, file_output *output, ffd_error *error)
{
    rows_pass pass = {.j = j, .output = output, .put = put_lines};
    byte_buffer head = {0};
    ffd_buffer_format(
        &head,
        "%%%%MatrixMarket matrix coordinate real general\n%% ffd jacobian: d positions / d %s%s\n"
        "%llu %llu %llu\n",
        j->desc->by == FFD_BY_POINTS ? "control points" : "parameters", j->blocks ? ", 3 rows a vertex" : "",
        (unsigned long long)j->rows, (unsigned long long)j->columns, (unsigned long long)starts[j->rows]);
    ffd_status status =
        head.failed ? ffd_fail_memory(error) : ffd_output_write(output, head.data, head.size, error);
    ffd_buffer_free(&head);
    return status ? status : run_pass(&pass, error);
}

/* Writes an array of shape (N, 3, m). */
static ffd_status write_npy(const jacobian *j, file_output *output, ffd_error *error)
{
    rows_pass pass = {.j = j, .output = output, .put = put_dense};
    char shape[80], header[NPY_HEADER_CAPACITY];
    snprintf(shape, sizeof shape, "(%zu, 3, %zu)", j->count, j->columns);
    TRY(ffd_output_write(output, header, ffd_npy_header_of("<f8", shape, header), error));
    return run_pass(&pass, error);
}

/* Writes the names of the columns, one a line. */
static ffd_status write_names(const jacobian *j, file_output *output, ffd_error *error)
{
    const char *const path = j->desc->output;
    byte_buffer text = {0};
    ffd_buffer_append(&text, path, (size_t)(ffd_path_ending(path) - path));
    ffd_buffer_text(&text, ".columns.txt");
    char *const name = ffd_buffer_finish(&text);
    ffd_status status;
    TRY_END(name ? ffd_output_begin(output, name, j->desc->job->force, error) : ffd_fail_memory(error));
    for (size_t c = 0; c < j->columns; c++) {
        TRY_END(ffd_output_write(output, j->names[c], strlen(j->names[c]), error));
        TRY_END(ffd_output_write(output, "\n", 1, error));
    }
end:
    ffd_free(name);
    return status;
}

ffd_status ffd_jacobian_write(const jacobian *j, const uint64_t *starts, ffd_error *error)
{
    const char *const path = j->desc->output;
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_redirect(output, j->desc->job->sink, j->desc->job->sink_user);
    ffd_status status = FFD_OK;
    if (j->desc->by == FFD_BY_PARAMETERS)
        TRY_END(write_names(j, output, error));
    TRY_END(ffd_output_begin(output, path, j->desc->job->force, error));
    TRY_END(ffd_path_has_ending(path, ".npz")   ? write_npz(j, starts, output, error)
            : ffd_path_has_ending(path, ".mtx") ? write_mtx(j, starts, output, error)
                                                : write_npy(j, output, error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}
