/* task_look.h - how the picture of a job is drawn, as it is sent to workers. */
#ifndef FFD_BATCH_TASK_LOOK_H
#define FFD_BATCH_TASK_LOOK_H

#include "base/memory/hash.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stdint.h>

/* Without its animation, which is a text. */
typedef struct task_look {
    double camera[3];
    uint32_t width, height, frames;
    int32_t color, up, no_cage;
} task_look;

_Static_assert(sizeof(task_look) == 48, "no padding, so that its bytes can be hashed");

/* Returns the look of a description. */
task_look ffd_task_look(const ffd_view_desc *desc);
/* Returns the description of a look. animation: as in ffd_view_desc. */
ffd_view_desc ffd_task_look_desc(const task_look *look, const char *animation);
/* Returns a hash of the look of a description, with its animation. */
hash128 ffd_task_look_hash(const ffd_view_desc *desc);
/* The same for a picture alone, which descriptions that say the same in other words share: where they name a
   default, or give a direction by another length. */
hash128 ffd_task_picture_hash(const ffd_view_desc *desc);

#endif
