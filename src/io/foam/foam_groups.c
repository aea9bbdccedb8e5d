/* foam_groups.c - patches and zones as groups of vertices. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/foam/foam_mesh.h"
#include <inttypes.h>

/* Where the vertices of a list go. */
typedef struct group_filler {
    foam_reader *r;
    size_t group;
    ffd_status status;
} group_filler;

/* A cell_point_visitor: adds a vertex, once for each list. */
static void add_vertex(void *context, uint32_t vertex)
{
    group_filler *const filler = context;
    foam_reader *const r = filler->r;
    if (filler->status || r->stamps[vertex] == r->stamp)
        return;
    r->stamps[vertex] = r->stamp;
    filler->status = ffd_volume_group_add(&r->d->volume, filler->group, vertex, r->error);
}

/* Begins the list of a group of this name. */
static ffd_status begin_group(foam_reader *r, text_word name, group_filler *filler)
{
    volume_document *const d = &r->d->volume;
    *filler = (group_filler){.r = r};
    if (!r->stamps)
        r->stamps = ffd_alloc_zero(d->file.part.vertex_count, sizeof *r->stamps);
    if (!r->stamps)
        return ffd_fail_memory(r->error);
    r->stamp++;
    return ffd_volume_group(d, name.first, (size_t)(name.last - name.first), &filler->group, r->error);
}

static ffd_status add_face(foam_reader *r, group_filler *filler, size_t face)
{
    size_t count;
    const uint32_t *const corners = foam_corners(&r->faces, face, &count);
    for (size_t c = 0; c < count; c++)
        add_vertex(filler, corners[c]);
    return filler->status;
}

/* What an entry of a list says of a patch. */
typedef struct patch {
    uint64_t first, count;
    bool has_first, has_count;
} patch;

/* Takes the entries of a patch, up to the end of its dictionary. */
static ffd_status take_entries(foam_file *f, patch *of)
{
    text_word key;
    while (!ffd_code_mark(&f->scan, '}')) {
        TRY(ffd_foam_name(f, "an entry of a patch", &key));
        if (ffd_text_is(key, "nFaces")) {
            TRY(ffd_foam_whole(f, "a number of faces", &of->count));
            of->has_count = true;
        } else if (ffd_text_is(key, "startFace")) {
            TRY(ffd_foam_whole(f, "the number of a face", &of->first));
            of->has_first = true;
        }
        TRY(ffd_foam_skip(f));
    }
    return FFD_OK;
}

static ffd_status take_patch(foam_reader *r, foam_file *f, text_word name)
{
    group_filler filler;
    patch of = {0};
    const size_t faces = r->faces.count;
    TRY(take_entries(f, &of));
    if (!of.has_first || !of.has_count)
        return FOAM_REFUSE(f, "the patch \"%s\" has no nFaces and startFace", ffd_text_shown(name).text);
    if (of.first > faces || of.count > faces - of.first)
        return FOAM_REFUSE(
            f, "the patch \"%s\" has %" PRIu64 " faces from %" PRIu64 " on, but there are only %zu",
            ffd_text_shown(name).text, of.count, of.first, faces);
    TRY(begin_group(r, name, &filler));
    for (uint64_t i = 0; i < of.count; i++) {
        TRY(ffd_deadline_check_at((size_t)i, r->error));
        TRY(add_face(r, &filler, (size_t)(of.first + i)));
    }
    return filler.status;
}

/* Adds what a zone lists: points, faces or cells. */
static ffd_status add_member(group_filler *filler, foam_side kind, uint32_t label)
{
    foam_reader *const r = filler->r;
    if (kind == FOAM_POINT_ZONES)
        add_vertex(filler, label);
    else if (kind == FOAM_FACE_ZONES)
        return add_face(r, filler, label);
    else
        ffd_cell_visit(&r->d->volume.cells, label, add_vertex, filler);
    return filler->status;
}

/* What the zones of a kind list. */
static size_t count_members(const foam_reader *r, foam_side kind)
{
    return kind == FOAM_POINT_ZONES  ? r->d->volume.file.part.vertex_count
           : kind == FOAM_FACE_ZONES ? r->faces.count
                                     : r->d->volume.cells.count;
}

/* Moves past the type of a list, if it is stated: List<label> N(..) */
static void skip_type(foam_file *f)
{
    const text_scan before = f->scan;
    text_word word;
    uint64_t number;
    if (!ffd_code_word(&f->scan, &word) || ffd_text_whole(word, &number))
        f->scan = before;
}

/* Takes the list of a zone. */
static ffd_status take_members(foam_reader *r, foam_file *f, foam_side kind, text_word name)
{
    const uint64_t most = count_members(r, kind);
    foam_labels members = {0};
    group_filler filler;
    ffd_status status;
    skip_type(f);
    TRY_END(ffd_foam_labels(f, "members of a zone", most, &members));
    TRY_END(begin_group(r, name, &filler));
    for (size_t i = 0; i < members.count; i++) {
        TRY_END(ffd_deadline_check_at(i, r->error));
        if (members.values[i] >= most)
            TRY_END(FOAM_REFUSE(f, "the zone \"%s\" has the member %" PRIu32 ", but there are only %" PRIu64,
                                ffd_text_shown(name).text, members.values[i], most));
        TRY_END(add_member(&filler, kind, members.values[i]));
    }
    TRY_END(filler.status);
end:
    ffd_free(members.values);
    return status;
}

/* Moves past the list of whether the faces of a zone are turned: in binary a byte for each. */
static ffd_status skip_flips(foam_file *f)
{
    foam_list list;
    uint64_t count;
    text_word flip;
    skip_type(f);
    TRY(ffd_foam_list(f, "sides of faces", 1, UINT64_MAX, &list, &count));
    if (f->is_binary && list == FOAM_ELEMENTS)
        f->scan.at += count;
    while (list != FOAM_EMPTY && ffd_code_word(&f->scan, &flip))
        ;
    return ffd_foam_list_end(f, "sides of faces", list);
}

static ffd_status take_zone(foam_reader *r, foam_file *f, foam_side kind, text_word name)
{
    static const char *const members[FOAM_SIDES] = {[FOAM_POINT_ZONES] = "pointLabels",
                                                    [FOAM_FACE_ZONES] = "faceLabels",
                                                    [FOAM_CELL_ZONES] = "cellLabels"};
    text_word key;
    while (!ffd_code_mark(&f->scan, '}')) {
        TRY(ffd_foam_name(f, "an entry of a zone", &key));
        if (ffd_text_is(key, members[kind]))
            TRY(take_members(r, f, kind, name));
        else if (ffd_text_is(key, "flipMap"))
            TRY(skip_flips(f));
        TRY(ffd_foam_skip(f));
    }
    return FFD_OK;
}

/* Takes a list of dictionaries with names. */
static ffd_status take_list(foam_reader *r, foam_file *f, foam_side kind)
{
    foam_list list;
    uint64_t count;
    text_word name;
    TRY(ffd_foam_list(f, kind == FOAM_BOUNDARY ? "patches" : "zones", 1, 0, &list, &count));
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_foam_name(f, kind == FOAM_BOUNDARY ? "the name of a patch" : "the name of a zone", &name));
        TRY(ffd_foam_mark(f, '{', "its dictionary"));
        TRY(kind == FOAM_BOUNDARY ? take_patch(r, f, name) : take_zone(r, f, kind, name));
    }
    return ffd_foam_list_end(f, kind == FOAM_BOUNDARY ? "patches" : "zones", list);
}

ffd_status ffd_foam_take_patches(foam_reader *r, foam_file *f)
{
    return take_list(r, f, FOAM_BOUNDARY);
}

ffd_status ffd_foam_take_point_zones(foam_reader *r, foam_file *f)
{
    return take_list(r, f, FOAM_POINT_ZONES);
}

ffd_status ffd_foam_take_face_zones(foam_reader *r, foam_file *f)
{
    return take_list(r, f, FOAM_FACE_ZONES);
}

ffd_status ffd_foam_take_cell_zones(foam_reader *r, foam_file *f)
{
    return take_list(r, f, FOAM_CELL_ZONES);
}
