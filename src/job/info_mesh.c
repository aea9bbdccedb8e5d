/* info_mesh.c - describes a mesh for `ffd info`. */
#include "io/openmesh/half_edges.h"
#include "io/openmesh/topology.h"
#include "job/info.h"
#include "job/input/source.h"
#include "mesh/bounds.h"
#include <stdio.h>

typedef struct vertex_facts {
    size_t vertices, normals, tangents;
    size_t not_finite; /* vertices with a coordinate that is not finite, excluded from the bounds */
    ffd_bounds bounds;
} vertex_facts;

static void write_vertices(const mesh_document *document, json_text *json)
{
    vertex_facts facts = {.bounds = ffd_bounds_empty()};
    ffd_bounds hidden = ffd_bounds_empty(); /* of vertices that are not visible */
    for (size_t part = 0; part < document->part_count; part++) {
        const mesh_part *p = &document->parts[part];
        if (!p->repeats_positions) {
            facts.not_finite +=
                ffd_source_widen(document, MESH_SHOWN, part, p->hidden ? &hidden : &facts.bounds);
            facts.vertices += p->vertex_count;
        }
        facts.normals += p->normal_count;
        facts.tangents += p->has_tangents ? p->vertex_count : 0;
    }
    ffd_json_count(json, "parts", document->part_count);
    ffd_json_count(json, "vertices", facts.vertices);
    ffd_json_count(json, "not_finite", facts.not_finite);
    ffd_json_count(json, "normals", facts.normals);
    ffd_json_count(json, "tangents", facts.tangents);
    ffd_info_bounds(json, "bounds", &facts.bounds);
}

/* Says why positions are missing, or not where they are shown: what the file needs is not supported, or wrong
   at the place that is named. */
static ffd_status write_reason(const mesh_document *document, json_text *json, ffd_error *error)
{
    ffd_error reason = {0};
    const ffd_status status = document->format->check ? document->format->check(document, &reason) : FFD_OK;
    if (status == FFD_E_UNSUPPORTED) {
        ffd_json_string(json, "positions_unknown", reason.message);
    } else if (status == FFD_E_INVALID) {
        char text[sizeof reason.pointer + sizeof reason.message + 2];
        snprintf(text, sizeof text, "%s%s%s", reason.pointer, *reason.pointer ? ": " : "", reason.message);
        ffd_json_string(json, "positions_unknown", text);
    }
    return status == FFD_E_MEMORY ? ffd_fail_memory(error) : FFD_OK;
}

static void write_topology(const mesh_faces *faces, const mesh_topology *topology, json_text *json)
{
    ffd_json_object(json, "topology", false);
    ffd_json_count(json, "vertices", topology->vertices);
    ffd_json_count(json, "faces", topology->faces);
    ffd_json_count(json, "edges", topology->edges);
    ffd_json_count(json, "lines", faces->lines);
    ffd_json_count(json, "points", faces->points);
    ffd_json_count(json, "isolated_vertices", topology->isolated_vertices);
    ffd_json_count(json, "degenerate_faces", topology->degenerate_faces);
    ffd_json_count(json, "components", topology->components);
    ffd_json_count(json, "boundary_loops", topology->boundary_loops);
    ffd_json_count(json, "boundary_edges", topology->boundary_edges);
    ffd_json_count(json, "non_manifold_edges", topology->non_manifold_edges);
    ffd_json_count(json, "non_manifold_vertices", topology->non_manifold_vertices);
    ffd_json_number(json, "euler", (double)topology->euler);
    ffd_json_number(json, "area", topology->area);
    ffd_json_end(json, '}');
}

static ffd_status check_memory(const mesh_document *document, const mesh_faces *faces, ffd_error *error)
{
    memory_budget budget = document->budget;
    const size_t corners = faces->start[faces->face_count];
    TRY(ffd_mesh_faces_take(faces, corners, &budget, error));
    return ffd_budget_check(&budget, ffd_half_edge_bytes(faces), 1, error);
}

/* Faces that this build cannot read do not keep the rest from being described. */
static ffd_status survey_faces(const mesh_document *document, json_text *json, ffd_error *error)
{
    mesh_faces faces = {0};
    mesh_topology topology;
    ffd_error reason = {0};
    ffd_status status;
    TRY_END(document->format->faces(document, MESH_SHOWN, &faces, &reason));
    TRY_END(check_memory(document, &faces, &reason));
    TRY_END(ffd_topology_compute(&faces, &topology, &reason));
    write_topology(&faces, &topology, json);
end:
    if (status == FFD_E_UNSUPPORTED || status == FFD_E_LIMIT) {
        ffd_json_null(json, "topology");
        ffd_json_string(json, "topology_unknown", reason.message);
        status = FFD_OK;
    } else if (status && error)
        *error = reason;
    ffd_mesh_faces_free(&faces);
    return status;
}

/* Writes the names that options and messages need; of a format that has none, empty lists. */
static ffd_status write_names(const mesh_document *document, json_text *json, ffd_error *error)
{
    static const char *const keys[] = {"animations", "morph_targets", "joints", "cameras", "scenes"};
    if (document->format->list_names)
        return document->format->list_names(document, json, error);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        ffd_json_array(json, keys[i], true);
        ffd_json_end(json, ']');
    }
    return FFD_OK;
}

ffd_status ffd_info_document(const mesh_document *document, json_text *json, ffd_error *error)
{
    ffd_json_string(json, "mesh_format", document->format->name);
    write_vertices(document, json);
    TRY(write_reason(document, json, error));
    ffd_json_object(json, "contents", false);
    ffd_status status = document->format->describe(document, json, error);
    ffd_json_end(json, '}');
    TRY(status);
    TRY(write_names(document, json, error));
    return survey_faces(document, json, error);
}

ffd_status ffd_info_mesh(const ffd_info_desc *desc, json_text *json, ffd_error *error)
{
    const mesh_log log = {desc->log, desc->log_user};
    mesh_document *document;
    TRY(ffd_source_open(&desc->file, 0, &document, error));
    ffd_status status;
    TRY_END(ffd_info_document(document, json, error));
    if (desc->parts)
        TRY_END(ffd_info_parts(document, json, error));
    ffd_flaws_warn(&document->flaws, ffd_source_name(&desc->file), &log);
end:
    ffd_source_close(&document);
    return status;
}
