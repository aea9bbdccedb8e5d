#include "mesh/resource/resource_bring.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/words.h"

/* Whether a relative path leads from the output's folder to a file, and if it leads out of the mesh's folder,
   to that one. */
static bool is_reached(const resource_copier *c, const char *path)
{
    char *const from = ffd_path_join(c->from, path), *const to = ffd_path_join(c->to, path);
    const bool reached =
        from && to && (ffd_path_leads_out(path) ? ffd_file_same(from, to) : ffd_file_exists(to));
    ffd_free(from);
    ffd_free(to);
    return reached;
}

static ffd_status copy(const resource_copier *c, const mesh_resource *resource, ffd_error *error)
{
    ffd_error refused;
    char shown[RESOURCE_SHOWN];
    if (ffd_path_leads_out(resource->path) && is_reached(c, resource->path))
        return FFD_OK;
    const ffd_status status = ffd_resource_copy(c, resource, &refused, error);
    ffd_name_shown(resource->path, shown, sizeof shown);
    if (!status && refused.status)
        ffd_log_line(c->log, FFD_LOG_WARNING, "the %s \"%s\" cannot be copied: %s", resource->kind->name,
                     shown, refused.message);
    return status;
}

static void say_unreached(const resource_copier *c, const mesh_resource *resource)
{
    char shown[RESOURCE_SHOWN];
    ffd_name_shown(resource->path, shown, sizeof shown);
    if (!is_reached(c, resource->path))
        ffd_log_line(c->log, FFD_LOG_WARNING,
                     "the output does not reach the %s \"%s\" ({resources=copy} copies it)",
                     resource->kind->name, shown);
}

ffd_status ffd_resources_bring(const resource_copier *c, const resource_list *list, bool copies, bool is_stay,
                               const char *target, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < list->count && !status; i++)
        status = ffd_resource_check_target(c, &list->resources[i], copies || is_stay, target, error);
    for (size_t i = 0; i < list->count && !status && !is_stay; i++) {
        if (copies)
            status = copy(c, &list->resources[i], error);
        else
            say_unreached(c, &list->resources[i]);
    }
    return status;
}
