#include "batch/task_look.h"
#include "base/arithmetic.h"
#include "job/view/view.h"
#include "view/view_picture.h"
#include <string.h>

task_look ffd_task_look(const ffd_view_desc *desc)
{
    return (task_look){.camera = {desc->camera[0], desc->camera[1], desc->camera[2]},
                       .width = desc->width,
                       .height = desc->height,
                       .frames = desc->frames,
                       .color = (int32_t)desc->color,
                       .up = (int32_t)desc->up,
                       .no_cage = desc->no_cage};
}

ffd_view_desc ffd_task_look_desc(const task_look *look, const char *animation)
{
    ffd_view_desc desc;
    ffd_view_desc_init(&desc, sizeof desc);
    memcpy(desc.camera, look->camera, sizeof desc.camera);
    desc.width = look->width;
    desc.height = look->height;
    desc.frames = look->frames;
    desc.color = (ffd_view_color)look->color;
    desc.up = (ffd_up)look->up;
    desc.no_cage = look->no_cage;
    desc.animation = animation;
    return desc;
}

hash128 ffd_task_look_hash(const ffd_view_desc *desc)
{
    const task_look look = ffd_task_look(desc);
    const char *const animation = desc->animation ? desc->animation : "";
    const hash_block blocks[] = {{&look, sizeof look},
                                 {animation, strlen(animation) + (desc->animation != NULL)}};
    return ffd_hash_blocks(blocks, 2);
}

hash128 ffd_task_picture_hash(const ffd_view_desc *desc)
{
    ffd_view_desc look = *desc;
    double greatest = 0;
    for (int a = 0; a < 3; a++)
        greatest = larger_of(greatest, fabs(look.camera[a]));
    for (int a = 0; a < 3 && greatest > 0; a++)
        look.camera[a] /= greatest;
    look.width = look.width ? look.width : VIEW_PICTURE_WIDTH;
    look.height = look.height ? look.height : VIEW_PICTURE_HEIGHT;
    look.frames = look.animation && !look.frames ? VIEW_POSES : look.frames;
    look.color = look.color == FFD_VIEW_AUTO ? FFD_VIEW_DISPLACEMENT : look.color;
    return ffd_task_look_hash(&look);
}
