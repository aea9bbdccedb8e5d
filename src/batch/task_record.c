#include "batch/task_record.h"
#include "base/file/path.h"
#include "job/input/settings.h"
#include <string.h>

/* What a record begins with; texts follow. */
typedef struct record_head {
    uint64_t line, row, index;
    hash128 content, target, picture_target, drawn_as, mesh;
    task_look look;
    task_order order;
    task_end end;
    task_state state;
    ffd_error failure; /* if has_failure */
    uint64_t name;     /* offset of the picture's name in its path */
    uint64_t told;
    uint32_t frame_mesh;
    uint64_t sizes[ANSWER_TEXTS];
    bool has_input, has_output, has_target, has_path, has_picture, has_page, has_animation, has_failure;
    bool is_large, is_made, is_refused, noted;
} record_head;

static void append(byte_buffer *record, const char *text)
{
    if (text)
        ffd_buffer_append(record, text, strlen(text) + 1);
}

/* For a list of the texts of a task, in the order of an answer. */
#define TEXT_OF_TASK(name) &task->name,

static void fill_head(const pool_task *task, record_head *head)
{
    const batch_job *const job = &task->job;
    const byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_TASK)};
    memset(head, 0, sizeof *head); /* also clears padding, which is written */
    head->line = job->line;
    head->row = job->row;
    head->index = task->index;
    head->content = job->content;
    head->target = task->target;
    head->picture_target = task->picture_target;
    head->drawn_as = task->drawn_as;
    head->mesh = task->mesh;
    head->look = ffd_task_look(&job->look);
    head->order = task->order;
    head->end = task->end;
    head->state = task->state;
    head->has_failure = task->failure.status;
    if (head->has_failure)
        head->failure = task->failure;
    head->name = task->picture ? (uint64_t)(task->picture_name - task->picture) : 0;
    for (int i = 0; i < ANSWER_TEXTS; i++)
        head->sizes[i] = texts[i]->size;
    head->has_input = job->input;
    head->has_output = job->output;
    head->has_target = job->target;
    head->has_path = job->desc.input.path;
    head->has_picture = task->picture;
    head->has_page = task->page;
    head->has_animation = job->look.animation;
    head->is_large = task->is_large;
    head->is_made = task->is_made;
    head->is_refused = task->is_refused;
    head->told = task->told;
    head->frame_mesh = task->frame_mesh;
    head->noted = task->noted;
}

ffd_status ffd_task_write(const pool_task *task, byte_buffer *record, ffd_error *error)
{
    const batch_job *const job = &task->job;
    const byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_TASK)};
    record_head head;
    fill_head(task, &head);
    record->size = 0;
    ffd_buffer_append(record, &head, sizeof head);
    ffd_settings_write(&job->desc, SETTINGS_ALL, record);
    append(record, job->desc.input.path);
    append(record, job->look.animation);
    append(record, job->input);
    append(record, job->output);
    append(record, task->picture);
    append(record, task->page);
    for (int i = 0; i < ANSWER_TEXTS; i++)
        ffd_buffer_append(record, texts[i]->data, texts[i]->size);
    return record->failed ? ffd_fail_memory(error) : FFD_OK;
}

/* Takes the next text, which stays where it is; NULL: it is not there. */
static const char *next(const char **at, bool is_there)
{
    const char *const text = is_there ? *at : NULL;
    *at += text ? strlen(text) + 1 : 0;
    return text;
}

/* Copies the next text. */
static char *copy_next(const char **at, bool is_there, bool *failed)
{
    const char *const text = next(at, is_there);
    char *const copy = text ? ffd_text_copy(text) : NULL;
    *failed = *failed || (text && !copy);
    return copy;
}

static void take_head(const record_head *head, pool_task *task)
{
    task->job.line = head->line;
    task->job.row = head->row;
    task->job.content = head->content;
    task->index = head->index;
    task->target = head->target;
    task->picture_target = head->picture_target;
    task->drawn_as = head->drawn_as;
    task->mesh = head->mesh;
    task->order = head->order;
    task->end = head->end;
    task->state = head->state;
    task->is_large = head->is_large;
    task->is_made = head->is_made;
    task->is_refused = head->is_refused;
    task->told = (size_t)head->told;
    task->frame_mesh = head->frame_mesh;
    task->noted = head->noted;
    if (head->has_failure)
        task->failure = head->failure;
}

ffd_status ffd_task_read(byte_buffer *record, pool_task *task, ffd_error *error)
{
    byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_TASK)};
    batch_job *const job = &task->job;
    record_head head;
    bool failed = false;
    memcpy(&head, record->data, sizeof head);
    job->texts = *record; /* of desc and look */
    *record = (byte_buffer){0};
    take_head(&head, task);
    const char *at = job->texts.data + sizeof head;
    ffd_deform_desc_init(&job->desc, sizeof job->desc);
    TRY(ffd_settings_take(&at, &job->desc, error));
    job->desc.input.path = next(&at, head.has_path);
    job->look = ffd_task_look_desc(&head.look, next(&at, head.has_animation));
    job->input = copy_next(&at, head.has_input, &failed);
    job->output = copy_next(&at, head.has_output, &failed);
    job->target = head.has_target ? job->desc.output : NULL; /* none is in place */
    task->picture = copy_next(&at, head.has_picture, &failed);
    task->page = copy_next(&at, head.has_page, &failed);
    task->picture_name = task->picture ? task->picture + head.name : NULL;
    for (int i = 0; i < ANSWER_TEXTS; i++) {
        ffd_buffer_append(texts[i], at, (size_t)head.sizes[i]);
        at += head.sizes[i];
        failed = failed || texts[i]->failed;
    }
    return failed ? ffd_fail_memory(error) : FFD_OK;
}
