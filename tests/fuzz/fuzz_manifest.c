/* fuzz_manifest.c - lines of a manifest, and the same text as a table: what comes of a line is a job, or
   one line that says what is wrong. */
#include "batch/manifest/manifest.h"
#include "fuzz_target.h"
#include "io/csv/csv.h"
#include "job/input/settings.h"
#include "mutate_text.h"
#include "promise.h"
#include "json/json_parse.h"
#include <stdlib.h>
#include <string.h>

/* A job has files, and its settings are the same after they were bytes. */
static void check_job(const batch_job *job)
{
    ffd_deform_desc taken;
    byte_buffer bytes = {0}, again = {0};
    PROMISE(job->input && *job->input && job->desc.input.path && job->target && *job->target &&
                job->desc.lattice_count > 0,
            "a job without files");
    ffd_settings_write(&job->desc, SETTINGS_ALL, &bytes);
    const char *at = bytes.data;
    ffd_deform_desc_init(&taken, sizeof taken);
    PROMISE(!bytes.failed && !ffd_settings_take(&at, &taken, NULL), "no memory");
    PROMISE(at == bytes.data + bytes.size, "the settings end %td bytes early", bytes.data + bytes.size - at);
    ffd_settings_write(&taken, SETTINGS_ALL, &again);
    PROMISE(again.size == bytes.size && memcmp(again.data, bytes.data, bytes.size) == 0,
            "the settings are others after they were bytes");
    ffd_deform_desc_clear(&taken);
    ffd_buffer_free(&bytes);
    ffd_buffer_free(&again);
}

static void check_line(const char *text, size_t size)
{
    static const ffd_setting set = {"A", "1"};
    const ffd_deform_desc defaults = {.struct_size = sizeof defaults,
                                      .input = {.format = FFD_FORMAT_OBJ},
                                      .normals = FFD_NORMALS_KEEP,
                                      .force = true,
                                      .set = &set,
                                      .set_count = 1};
    const batch_frame frame = {.name = "m", .folder = "folder", .defaults = &defaults};
    batch_job job = {.line = 1};
    PROMISE(ffd_job_parse(&frame, text, size, &job) == FFD_OK, "no memory");
    if (job.error.status == FFD_OK)
        check_job(&job);
    else
        PROMISE(job.error.status == FFD_E_INVALID && job.error.line == 1 && job.error.message[0] &&
                    !strpbrk(job.error.message, "\r\n"),
                "status %d says '%s'", job.error.status, job.error.message);
    ffd_job_free(&job);
}

/* A cell that is read as a number is that number for the C library too, and JSON. */
static void check_number(const char *cell, bool decimal_comma)
{
    byte_buffer json = {0}, plain = {0};
    json_tree tree = {0};
    if (ffd_csv_number(cell, decimal_comma, &json)) {
        const json_input input = {.text = json.data, .size = json.size, .name = "number"};
        PROMISE(ffd_json_parse(&input, &tree, NULL) == FFD_OK && tree.values[0].kind == JSON_NUMBER,
                "%s becomes what is no JSON", cell);
        for (const char *c = cell; *c; c++)
            ffd_buffer_append(&plain, decimal_comma && *c == ',' ? "." : c, 1);
        ffd_buffer_append(&plain, "", 1);
        ffd_buffer_append(&json, "", 1);
        PROMISE(strtod(json.data, NULL) == strtod(plain.data, NULL), "%s becomes %s", cell, json.data);
    }
    ffd_json_tree_free(&tree);
    ffd_buffer_free(&json);
    ffd_buffer_free(&plain);
}

/* A row's cells, written again within quotes, are the same row. */
static void check_row(char separator, const char *text, size_t size)
{
    const char separators[] = {separator, 0};
    csv_row row = {0}, again = {0};
    byte_buffer quoted = {0};
    if (memchr(text, 0, size) || !ffd_csv_split(separator, text, size, &row)) {
        ffd_csv_free(&row);
        return;
    }
    PROMISE(!ffd_csv_is_open(&(csv_scan){0}, separators, text, size), "a whole row is said to go on");
    const char *cell = NULL;
    for (size_t i = 0; i < row.count; i++) {
        cell = ffd_csv_next(&row, cell);
        check_number(cell, separator == ';');
        ffd_buffer_text(&quoted, i ? separators : "");
        ffd_buffer_text(&quoted, "\"");
        for (const char *c = cell; *c; c++)
            ffd_buffer_append(&quoted, *c == '"' ? "\"\"" : c, *c == '"' ? 2 : 1);
        ffd_buffer_text(&quoted, "\"");
    }
    PROMISE(ffd_csv_split(separator, quoted.data, quoted.size, &again), "a row that was written is refused");
    PROMISE(row.count < 2 || ffd_csv_separator(quoted.data, quoted.size) == separator,
            "a row that was written has another separator");
    PROMISE(again.count == row.count && again.text.size == row.text.size &&
                memcmp(again.text.data, row.text.data, row.text.size) == 0,
            "a row that was written is another");
    ffd_buffer_free(&quoted);
    ffd_csv_free(&again);
    ffd_csv_free(&row);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data, *const end = text + size;
    check_row(',', text, size);
    check_row(';', text, size);
    while (text < end) {
        const char *line = memchr(text, '\n', (size_t)(end - text));
        line = line ? line : end;
        check_line(text, (size_t)(line - text));
        text = line + 1;
    }
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .text = size, .random = {seed}};
    if (size == 0)
        return 0;
    mutant_change_piece(&m, "{}[]\",;:\\ 01-+e.nt=\n\r\xff");
    return m.size;
}
