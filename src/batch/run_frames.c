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

/* Finds the group of a look among those of a mesh; NULL: there is none. */
static frame_group *find_group(const run_frames *frames, uint32_t mesh, const hash128 *look)
{
    for (uint32_t at = frames->groups[mesh]; at; at = frames->list[at - 1].next)
        if (ffd_hash_equal(&frames->list[at - 1].look, look))
            return &frames->list[at - 1];
    return NULL;
}

static frame_group *add_group(run_frames *frames, uint32_t mesh, const hash128 *look, uint64_t first)
{
    if (!ffd_grow((void **)&frames->list, &frames->capacity, frames->count + 1, sizeof *frames->list))
        return NULL;
    frame_group *const group = &frames->list[frames->count++];
    *group = (frame_group){
        .look = *look, .first = first, .frame = ffd_view_frame_none(), .next = frames->groups[mesh]};
    frames->groups[mesh] = (uint32_t)frames->count;
    return group;
}

/* Finds the number of a mesh, which may be new. */
static bool find_mesh(run_frames *frames, const hash128 *mesh, uint32_t *index)
{
    const size_t before = frames->meshes.count;
    if (!ffd_intern(&frames->meshes, mesh, sizeof *mesh, index))
        return false;
    if (*index < before)
        return true;
    if (!ffd_grow((void **)&frames->groups, &frames->mesh_capacity, frames->meshes.count,
                  sizeof *frames->groups))
        return false;
    frames->groups[*index] = 0;
    return true;
}

ffd_status ffd_frames_add(run_frames *frames, pool_task *task, const hash128 *mesh, ffd_error *error)
{
    const hash128 look = ffd_task_look_hash(&task->job.look);
    if (!find_mesh(frames, mesh, &task->frame_mesh))
        return ffd_fail_memory(error);
    frame_group *group = find_group(frames, task->frame_mesh, &look);
    if (!group)
        group = add_group(frames, task->frame_mesh, &look, task->index);
    if (!group)
        return ffd_fail_memory(error);
    frames->pictures++;
    group->count++;
    group->first = group->first < task->index ? group->first : task->index;
    if (!is_far(task))
        ffd_view_frame_join(&group->frame, &task->end.frame);
    return FFD_OK;
}

/* Returns the group of a mesh with the most jobs, and of these the first; *jobs: the jobs of the mesh. */
static const frame_group *main_group(const run_frames *frames, uint32_t mesh, uint64_t *jobs)
{
    const frame_group *best = NULL;
    *jobs = 0;
    for (uint32_t at = frames->groups[mesh]; at; at = frames->list[at - 1].next) {
        const frame_group *const group = &frames->list[at - 1];
        *jobs += group->count;
        if (!best || group->count > best->count ||
            (group->count == best->count && group->first < best->first))
            best = group;
    }
    return best;
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
    const hash128 look = ffd_task_look_hash(&task->job.look);
    uint64_t jobs;
    const frame_group *const group = main_group(frames, task->frame_mesh, &jobs);
    const bool is_like_others = ffd_hash_equal(&group->look, &look),
               is_left = is_far(task) || !is_like_others;
    task->order.has_frame = true;
    task->order.frame = is_left ? task->end.frame : group->frame;
    if (!is_left || jobs == 1)
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
    ffd_intern_free(&frames->meshes);
    ffd_free(frames->groups);
    ffd_free(frames->list);
    ffd_records_free(&frames->tasks);
    ffd_buffer_free(&frames->record);
    ffd_buffer_free(&frames->left_names);
    *frames = (run_frames){0};
}
