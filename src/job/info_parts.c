/* info_parts.c - lists the names of a mesh that `--only` accepts. */
#include "base/memory/memory.h"
#include "job/info.h"
#include "mesh/listing.h"
#include <stdio.h>
#include <string.h>

static void write_drawing(const mesh_thing *thing, json_text *json)
{
    ffd_json_count(json, "vertices", thing->vertices);
    ffd_json_count(json, "faces", thing->faces);
    ffd_info_bounds(json, "bounds", &thing->bounds);
    ffd_json_end(json, '}');
}

static ffd_status write_named(const mesh_thing *thing, json_text *json, ffd_error *error)
{
    const char *const kind = ffd_selector_kind_name(thing->kind);
    const size_t size = strlen(kind) + strlen(thing->name) + 2;
    char *const selector = ffd_alloc(size, 1);
    if (!selector)
        return ffd_fail_memory(error);
    snprintf(selector, size, "%s:%s", kind, thing->name);
    ffd_json_object(json, NULL, false);
    ffd_json_string(json, "selector", selector);
    ffd_json_string(json, "kind", kind);
    ffd_json_string(json, "name", thing->name);
    write_drawing(thing, json);
    ffd_free(selector);
    return FFD_OK;
}

/* Whether to list an unnamed thing: it draws something, and others of its kind have names. */
static bool is_worth_telling(const mesh_thing *thing, unsigned named)
{
    return !thing->name && thing->vertices > 0 && named & SELECTOR_BIT(thing->kind);
}

static ffd_status write_things(const mesh_listing *listing, json_text *json, ffd_error *error)
{
    unsigned named = 0;
    ffd_json_array(json, "named_parts", false);
    for (size_t i = 0; i < listing->count; i++)
        if (listing->things[i].name) {
            named |= SELECTOR_BIT(listing->things[i].kind);
            TRY(write_named(&listing->things[i], json, error));
        }
    ffd_json_end(json, ']');
    ffd_json_array(json, "unnamed_parts", false);
    for (size_t i = 0; i < listing->count; i++)
        if (is_worth_telling(&listing->things[i], named)) {
            ffd_json_object(json, NULL, false);
            ffd_json_string(json, "kind", ffd_selector_kind_name(listing->things[i].kind));
            ffd_json_count(json, "number", listing->things[i].index);
            write_drawing(&listing->things[i], json);
        }
    ffd_json_end(json, ']');
    return FFD_OK;
}

ffd_status ffd_info_parts(const mesh_document *document, json_text *json, ffd_error *error)
{
    const mesh_selector_calls *const calls = document->format->selectors;
    mesh_listing listing = {0};
    ffd_error reason = {0};
    ffd_status status = FFD_OK;
    if (calls) {
        TRY_END(ffd_listing_begin(document, &listing, &reason));
        TRY_END(calls->list(document, &listing, &reason));
    }
    TRY_END(write_things(&listing, json, &reason));
end:
    if (status == FFD_E_UNSUPPORTED || status == FFD_E_LIMIT) {
        ffd_json_null(json, "named_parts");
        ffd_json_string(json, "parts_unknown", reason.message);
        status = FFD_OK;
    }
    if (status && error)
        *error = reason;
    ffd_listing_free(&listing);
    return status;
}
