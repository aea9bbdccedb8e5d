#include "view/view_edit.h"
#include "base/memory/memory.h"

void ffd_view_edit_free(view_edit *edit)
{
    if (!edit)
        return;
    edit_points *const points = &edit->points;
    void *const blocks[] = {edit->knots[0],   edit->knots[1],         edit->knots[2],
                            edit->offsets,    edit->weights,          edit->file,
                            edit->name,       edit->comment,          points->start,
                            points->uvw,      edit->deformed_weights, points->kinds,
                            points->ways,     points->factors,        points->owners,
                            points->gradients};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    ffd_free(edit);
}
