#include "batch/run_frames.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "batch/task_record.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* A mesh that lies farther than this many diagonals from where it was would make all others too small. */
#define FARTHEST 10

hash128 ffd_frame_hash(const hash128 *shown, const view_frame *frame)
{
    const hash_block blocks[] = {{shown, sizeof *shown}, {frame, sizeof *frame}};
    return ffd_hash_blocks(blocks, 2);
}

static bool is_far(const pool_task *task)
{
    return task->end.frame.away > FARTHEST;
}

/* What a group has in common, without padding. */
typedef struct group_key {
    hash128 look;
    uint64_t mesh;
} group_key;

static group_key key_of(const pool_task *task)
{
    return (group_key){ffd_task_picture_hash(&task->job.look), task->frame_mesh};
}

/* Finds the number of a key, and makes room for its entry in a list, which has one for each key. *is_new: the
   entry is not filled. The room comes first: a key that is known has an entry. */
static bool number_of(intern_table *keys, const void *key, size_t key_size, void **entries, size_t *capacity,
                      size_t size, uint32_t *number, bool *is_new)
{
    const size_t before = keys->count;
    if (!ffd_grow(entries, capacity, before + 1, size) || !ffd_intern(keys, key, key_size, number))
        return false;
    *is_new = *number == before;
    return true;
}

/* Finds the mesh of a task, which may be new. */
static bool find_mesh(run_frames *frames, const hash128 *place, pool_task *task)
{
    bool is_new;
    if (!number_of(&frames->mesh_keys, place, sizeof *place, (void **)&frames->meshes, &frames->mesh_capacity,
                   sizeof *frames->meshes, &task->frame_mesh, &is_new))
        return false;
    if (is_new)
        frames->meshes[task->frame_mesh] = (frame_mesh){0};
    return true;
}

/* Finds the group of a task that has its mesh, which may be new. */
static bool find_group(run_frames *frames, const pool_task *task, uint32_t *group)
{
    const group_key key = key_of(task);
    bool is_new;
    if (!number_of(&frames->group_keys, &key, sizeof key, (void **)&frames->groups, &frames->group_capacity,
                   sizeof *frames->groups, group, &is_new))
        return false;
    if (is_new)
        frames->groups[*group] = (frame_group){.first = task->index, .frame = ffd_view_frame_none()};
    return true;
}

static bool has_more(const frame_group *a, const frame_group *b)
{
    return a->count > b->count || (a->count == b->count && a->first < b->first);
}

ffd_status ffd_frames_add(run_frames *frames, pool_task *task, const hash128 *mesh, ffd_error *error)
{
    uint32_t number;
    if (!find_mesh(frames, mesh, task) || !find_group(frames, task, &number))
        return ffd_fail_memory(error);
    frame_group *const group = &frames->groups[number];
    frame_mesh *const of = &frames->meshes[task->frame_mesh];
    frames->pictures++;
    of->jobs++;
    group->count++;
    group->first = group->first < task->index ? group->first : task->index;
    if (of->jobs == 1 || has_more(group, &frames->groups[of->most]))
        of->most = number;
    if (!is_far(task))
        ffd_view_frame_join(&group->frame, &task->end.frame);
    return FFD_OK;
}

/* Notes a picture for the warning. */
static void note_left(run_frames *frames, const pool_task *task, bool has_other_look)
{
    byte_buffer *const names = &frames->left_names;
    const char *const output = ffd_job_output_name(&task->job);
    char name[120];
    if (frames->left++ >= FRAMES_NAMED)
        return;
    ffd_name_shown(output ? output : task->picture_name, name, sizeof name);
    ffd_buffer_format(names, "%s%s (line %" PRIu64 ")", names->size ? ", " : "", name, task->job.line);
    if (has_other_look)
        ffd_buffer_text(names, " has other options of \"view\"");
    else
        ffd_buffer_format(names, " lies %s diagonals of the mesh away",
                          ffd_number_digits(task->end.frame.away, 3).text);
}

void ffd_frames_choose(run_frames *frames, pool_task *task)
{
    const frame_mesh *const mesh = &frames->meshes[task->frame_mesh];
    const group_key key = key_of(task);
    uint32_t number;
    const bool is_like_others =
                   ffd_intern_find(&frames->group_keys, &key, sizeof key, &number) && number == mesh->most,
               is_left = is_far(task) || !is_like_others;
    task->order.has_frame = true;
    task->order.frame = is_left ? task->end.frame : frames->groups[mesh->most].frame;
    if (!is_left || mesh->jobs == 1)
        return;
    task->own_frame = is_like_others ? "far" : "options";
    note_left(frames, task, !is_like_others);
}

ffd_status ffd_frames_put(run_frames *frames, const pool_task *task, ffd_error *error)
{
    TRY(ffd_task_write(task, &frames->record, error));
    return ffd_records_put(&frames->tasks, &frames->record, error);
}

ffd_status ffd_frames_take(run_frames *frames, pool_task *task, bool *found, ffd_error *error)
{
    TRY(ffd_records_take(&frames->tasks, &frames->record, found, error));
    return *found ? ffd_task_read(&frames->record, task, error) : FFD_OK;
}

bool ffd_frames_warn(const run_frames *frames, const char *name, ffd_error *note)
{
    if (frames->left == 0 || frames->left_names.failed)
        return false;
    const uint64_t more = frames->left > FRAMES_NAMED ? frames->left - FRAMES_NAMED : 0;
    char others[40] = "";
    if (more)
        snprintf(others, sizeof others, " and %" PRIu64 " more", more);
    ffd_fail_file(note, FFD_E_INVALID, name,
                  "%" PRIu64 " of %" PRIu64 " pictures %s in the common frame, but %s own: %.*s%s",
                  frames->left, frames->pictures, ffd_plural(frames->left, "is not", "are not"),
                  ffd_plural(frames->left, "has its", "have their"), (int)frames->left_names.size,
                  frames->left_names.data, others);
    return true;
}

void ffd_frames_free(run_frames *frames)
{
    ffd_intern_free(&frames->mesh_keys);
    ffd_intern_free(&frames->group_keys);
    ffd_free(frames->meshes);
    ffd_free(frames->groups);
    ffd_records_free(&frames->tasks);
    ffd_buffer_free(&frames->record);
    ffd_buffer_free(&frames->left_names);
    *frames = (run_frames){0};
}
