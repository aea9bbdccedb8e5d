#include "job/input/deform_desc.h"
#include "base/struct_size.h"

void ffd_deform_desc_init(ffd_deform_desc *desc, size_t size)
{
    const ffd_deform_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

ffd_status ffd_deform_desc_take(const ffd_deform_desc *callers, ffd_deform_desc *own, ffd_error *error)
{
    ffd_deform_desc_init(own, sizeof *own);
    return ffd_struct_take(own, sizeof *own, callers, "ffd_deform_desc", error);
}

bool ffd_deform_desc_writes(const ffd_deform_desc *desc)
{
    return desc->in_place || desc->output || !desc->positions;
}

bool ffd_desc_has_texts(const char *const *texts, size_t count)
{
    size_t there = 0;
    while (texts && there < count && texts[there])
        there++;
    return there == count;
}

bool ffd_desc_has_settings(const ffd_setting *set, size_t count)
{
    size_t there = 0;
    while (set && there < count && set[there].name && set[there].value)
        there++;
    return there == count;
}
