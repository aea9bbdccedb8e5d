#include "job/input/settings.h"
#include "base/fail.h"
#include "base/spelling.h"
#include "job/input/deform_desc.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* In the order of the enums, all of each: a number behind the last word is refused as out of range. */
static const char *const outside_words[] = {"keep", "extend", "error", NULL};
static const char *const normals_words[] = {"transform", "keep", "recompute", NULL};
static const char *const space_words[] = {"scene", "mesh", NULL};
static const char *const rig_words[] = {"keep", "follow", NULL};
static const char *const resources_words[] = {"copy", "reference", "refresh", NULL};
static const char *const isa_words[] = {"auto", "scalar", "sse2", "avx2", "avx512", "neon", NULL};
static const char *const format_words[] = {"auto", "obj", "gltf", "glb", "ply", "off",  "stl", "vtk",
                                           "su2",  "vtu", "vtp",  "vts", "msh", "foam", NULL};

static const char *const seam_words[] = {"none", "C0", "C1", "C2", NULL};
static const char *const gate_words[] = {"folds",    "outside",   "multiple", "singular", "invalid",
                                         "tear",     "tear=",     "flipped",  "flipped=", "edges=",
                                         "inverted", "inverted=", "quality=", NULL};

#define AT(member) offsetof(ffd_deform_desc, member)
static const ffd_member members[] = {
    {"input.format", "input-format", FFD_MEMBER_FORMAT, AT(input.format), 0, format_words, 0},
    {"input.space", "space", FFD_MEMBER_CHOICE, AT(input.space), 0, space_words, 0},
    {"input.memory", "memory", FFD_MEMBER_BYTES, AT(input.memory), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"input.strict", "strict", FFD_MEMBER_FLAG, AT(input.strict), 0, NULL, 0},
    {"input.allow_extensions", "allow-extension", FFD_MEMBER_TEXTS, AT(input.allow_extensions),
     AT(input.allow_extension_count), NULL, 0},
    {"output", NULL, FFD_MEMBER_TEXT, AT(output), 0, NULL, FFD_MEMBER_IS_PATH},
    {"output_format", "output-format", FFD_MEMBER_FORMAT, AT(output_format), 0, format_words, 0},
    {"lattices", "lattice", FFD_MEMBER_LATTICES, AT(lattices), AT(lattice_count), NULL, 0},
    {"blocks", "blocks", FFD_MEMBER_FLAG, AT(blocks), 0, NULL, 0},
    {"set", "set", FFD_MEMBER_VALUES, AT(set), AT(set_count), NULL, 0},
    {"outside", "outside", FFD_MEMBER_CHOICE, AT(outside), 0, outside_words, 0},
    {"falloff", "falloff", FFD_MEMBER_LENGTH, AT(falloff), 0, NULL, 0},
    {"snap", "snap", FFD_MEMBER_DISTANCE, AT(snap), AT(snap_relative), NULL, 0},
    {"embedding", "embedding", FFD_MEMBER_TEXT, AT(embedding.path), 0, NULL, FFD_MEMBER_IS_PATH},
    {"fail_on", "fail-on", FFD_MEMBER_GATES, AT(fail_on), 0, gate_words, 0},
    {"quality", NULL, FFD_MEMBER_FLAG, AT(quality), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"normals", "normals", FFD_MEMBER_CHOICE, AT(normals), 0, normals_words, 0},
    {"rig", "rig", FFD_MEMBER_CHOICE, AT(rig), 0, rig_words, 0},
    {"as_morph", "as-morph", FFD_MEMBER_TEXT, AT(as_morph), 0, NULL, 0},
    {"morphs", "morph", FFD_MEMBER_MORPHS, AT(morphs), AT(lattice_count), NULL, 0},
    {"clips", "clip", FFD_MEMBER_CLIPS, AT(clips), AT(clip_count), NULL, 0},
    {"only", "only", FFD_MEMBER_SELECTORS, AT(only), AT(only_count), NULL, 0},
    {"resources", "resources", FFD_MEMBER_CHOICE, AT(resources), 0, resources_words, 0},
    {"threads", "threads", FFD_MEMBER_COUNT, AT(threads), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"isa", "isa", FFD_MEMBER_CHOICE, AT(isa), 0, isa_words, FFD_MEMBER_IS_IDLE},
    {"force", "force", FFD_MEMBER_FLAG, AT(force), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"if_changed", "if-changed", FFD_MEMBER_FLAG, AT(if_changed), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"in_place", "in-place", FFD_MEMBER_FLAG, AT(in_place), 0, NULL, 0},
    {"dry_run", NULL, FFD_MEMBER_FLAG, AT(dry_run), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"make_folders", NULL, FFD_MEMBER_FLAG, AT(make_folders), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"output_list", NULL, FFD_MEMBER_OBJECT, AT(output_list), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"progress", NULL, FFD_MEMBER_OBJECT, AT(progress), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"cancel", NULL, FFD_MEMBER_OBJECT, AT(cancel), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"depfile", NULL, FFD_MEMBER_OBJECT, AT(depfile), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"positions", NULL, FFD_MEMBER_OBJECT, AT(positions), 0, NULL, 0},
    {"timeout", "timeout", FFD_MEMBER_TIME, AT(timeout), 0, NULL, FFD_MEMBER_IS_IDLE},
    {"time", "time", FFD_MEMBER_MOMENT, AT(time), AT(has_time), NULL, 0},
    {"weight", "weight", FFD_MEMBER_WEIGHT, AT(weight.source), 0, NULL, 0},
    {"seam", "seam", FFD_MEMBER_SEAM, AT(seam), AT(seam_faces), seam_words, 0},
    {"rigid", "rigid", FFD_MEMBER_SELECTORS, AT(rigid), AT(rigid_count), NULL, 0},
    {"uniform", "uniform", FFD_MEMBER_SELECTORS, AT(uniform), AT(uniform_count), NULL, 0},
};
enum { MEMBERS = sizeof members / sizeof *members };

const job_rule ffd_job_rules[] = {
    {"falloff", JOB_NEEDS, "outside=extend", NULL},
    {"rig=follow", JOB_EXCLUDES, "as_morph", "{rig=follow} moves the shape itself, which {as_morph} leaves"},
    {"rig=follow", JOB_EXCLUDES, "input.space=mesh",
     "{rig=follow} moves nodes, which have no place with {input.space=mesh}"},
    {"rig=follow", JOB_EXCLUDES, "weight",
     "{rig=follow} cannot be used with {weight}: joints have no weights, and would leave the mesh"},
    {"embedding", JOB_EXCLUDES, "blocks", "{embedding} works with one lattice, and not with {blocks}"},
    {"embedding", JOB_EXCLUDES, "morphs=several",
     "{embedding} works with one lattice, but several {morphs} are given"},
    {"embedding", JOB_EXCLUDES, "lattices=several",
     "{embedding} works with one lattice, but several {lattices} are given"},
    {"embedding", JOB_NEEDS, "lattices", NULL},
    {"clips", JOB_NEEDS, "morphs", NULL},
    {"as_morph", JOB_EXCLUDES, "morphs", NULL},
    {"rig=follow", JOB_EXCLUDES, "morphs", "{rig=follow} moves the shape itself, which {morphs} leaves"},
    {"blocks", JOB_EXCLUDES, "morphs", NULL},
    {"positions", JOB_EXCLUDES, "morphs", NULL},
    {"rigid", JOB_EXCLUDES, "morphs", NULL},
    {"uniform", JOB_EXCLUDES, "morphs", NULL},
    {"in_place", JOB_NEEDS_FILES, NULL, NULL},
    {"depfile", JOB_NEEDS_FILES, NULL, NULL},
    {"resources=reference", JOB_NEEDS_FILES, NULL, NULL},
    {"in_place", JOB_EXCLUDES, "output", NULL},
    {"in_place", JOB_EXCLUDES, "output_format",
     "{in_place} keeps the format: {output_format} cannot be used with it"},
    {"depfile", JOB_EXCLUDES, "in_place",
     "{depfile} cannot be used with {in_place}: a file cannot depend on itself"},
    {NULL, JOB_NEEDS, NULL, NULL},
};

const ffd_member *ffd_deform_member(size_t index)
{
    return index < MEMBERS ? &members[index] : NULL;
}

const ffd_member *ffd_deform_member_of(const char *option)
{
    size_t m = 0;
    while (m < MEMBERS && !(members[m].option && strcmp(members[m].option, option) == 0))
        m++;
    return m < MEMBERS ? &members[m] : NULL;
}

const char *ffd_seam_name(ffd_seam seam)
{
    return (int)seam >= 0 && seam <= FFD_SEAM_C2 ? seam_words[seam] : NULL;
}

bool ffd_member_is_list(const ffd_member *member)
{
    return member->kind >= FFD_MEMBER_TEXTS && member->kind <= FFD_MEMBER_MORPHS;
}

/* The choice, or the count of the elements of a list. */
static size_t choice_or_count(const ffd_deform_desc *desc, const ffd_member *member)
{
    const char *const base = (const char *)desc;
    size_t count;
    int choice;
    if (!ffd_member_is_list(member)) {
        memcpy(&choice, base + member->offset, sizeof choice);
        return (size_t)choice;
    }
    memcpy(&count, base + member->second, sizeof count);
    return count;
}

static double value_of(const ffd_deform_desc *desc, const ffd_member *member)
{
    double value;
    memcpy(&value, (const char *)desc + member->offset, sizeof value);
    return value;
}

static bool is_number(const ffd_member *member)
{
    return member->kind == FFD_MEMBER_LENGTH || member->kind == FFD_MEMBER_DISTANCE ||
           member->kind == FFD_MEMBER_TIME;
}

/* By kind. */
static const size_t sizes[] = {
    [FFD_MEMBER_FLAG] = sizeof(bool),           [FFD_MEMBER_CHOICE] = sizeof(int),
    [FFD_MEMBER_FORMAT] = sizeof(int),          [FFD_MEMBER_COUNT] = sizeof(int),
    [FFD_MEMBER_LENGTH] = sizeof(double),       [FFD_MEMBER_DISTANCE] = sizeof(double),
    [FFD_MEMBER_TIME] = sizeof(double),         [FFD_MEMBER_MOMENT] = sizeof(double),
    [FFD_MEMBER_BYTES] = sizeof(uint64_t),      [FFD_MEMBER_GATES] = sizeof(unsigned),
    [FFD_MEMBER_TEXT] = sizeof(const char *),   [FFD_MEMBER_OBJECT] = sizeof(const void *),
    [FFD_MEMBER_WEIGHT] = sizeof(const char *), [FFD_MEMBER_SEAM] = sizeof(int)};

#define PIECE(member) ((member_piece){AT(member), sizeof((ffd_deform_desc *)0)->member})

size_t ffd_member_pieces(const ffd_member *member, member_piece pieces[MEMBER_PIECES])
{
    size_t count = 0;
    pieces[count++] = (member_piece){member->offset, sizes[member->kind]};
    if (member->kind == FFD_MEMBER_DISTANCE || member->kind == FFD_MEMBER_MOMENT)
        pieces[count++] = (member_piece){member->second, sizeof(bool)};
    if (member->kind == FFD_MEMBER_SEAM)
        pieces[count++] = (member_piece){member->second, sizeof(unsigned)};
    if (member->kind == FFD_MEMBER_GATES) {
        pieces[count++] = PIECE(tear_most);
        pieces[count++] = PIECE(flipped_most);
        pieces[count++] = PIECE(edges_most);
        pieces[count++] = PIECE(inverted_most);
        pieces[count++] = PIECE(quality_least);
    }
    return count;
}

void ffd_member_copy(const ffd_member *member, const ffd_deform_desc *from, ffd_deform_desc *to)
{
    member_piece pieces[MEMBER_PIECES];
    const size_t count = ffd_member_pieces(member, pieces);
    for (size_t i = 0; i < count; i++)
        memcpy((char *)to + pieces[i].offset, (const char *)from + pieces[i].offset, pieces[i].size);
}

static bool is_zero(const char *bytes, size_t size)
{
    char any = 0;
    for (size_t i = 0; i < size; i++)
        any |= bytes[i];
    return !any;
}

bool ffd_member_is_set(const ffd_deform_desc *desc, const ffd_member *member)
{
    const char *const at = (const char *)desc + member->offset;
    if (is_number(member))
        return value_of(desc, member) > 0;
    if (member->kind == FFD_MEMBER_MOMENT)
        return *((const bool *)desc + member->second);
    if (ffd_member_is_list(member))
        return choice_or_count(desc, member) > 0 && !is_zero(at, sizeof(const void *));
    return !is_zero(at, sizes[member->kind]);
}

/* The members that are set: few, in which the rules look for settings. */
typedef struct set_members {
    const ffd_member *list[MEMBERS];
    size_t count;
} set_members;

static void find_set(const ffd_deform_desc *desc, set_members *set)
{
    set->count = 0;
    for (size_t m = 0; m < MEMBERS; m++)
        if (ffd_member_is_set(desc, &members[m]))
            set->list[set->count++] = &members[m];
}

static bool is_among(const set_members *set, const ffd_deform_desc *desc, const char *setting)
{
    const size_t length = strcspn(setting, "=");
    const char *const word = setting[length] ? setting + length + 1 : NULL;
    size_t m = 0;
    while (m < set->count &&
           (strncmp(set->list[m]->name, setting, length) != 0 || set->list[m]->name[length]))
        m++;
    if (m == set->count || !word)
        return m < set->count;
    const size_t index = choice_or_count(desc, set->list[m]);
    return ffd_member_is_list(set->list[m]) ? index > 1 : strcmp(set->list[m]->words[index], word) == 0;
}

bool ffd_setting_is_set(const ffd_deform_desc *desc, const char *setting)
{
    set_members set;
    find_set(desc, &set);
    return is_among(&set, desc, setting);
}

static ffd_status check_range(const ffd_deform_desc *desc, const ffd_member *member, ffd_error *error)
{
    size_t words = 0;
    while (member->kind != FFD_MEMBER_GATES && member->words && member->words[words])
        words++;
    if (words > 0 && choice_or_count(desc, member) >= words)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of %s", (int)choice_or_count(desc, member),
                        member->name);
    if (member->kind == FFD_MEMBER_MOMENT && ffd_member_is_set(desc, member) &&
        !isfinite(value_of(desc, member)))
        return ffd_fail(error, FFD_E_ARGUMENT, "the %s %g is not finite", member->name,
                        value_of(desc, member));
    if (!is_number(member))
        return FFD_OK;
    const double value = value_of(desc, member);
    const bool is_time = member->kind == FFD_MEMBER_TIME;
    return value >= 0 && (is_time || isfinite(value))
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "the %s %g is not a %s", member->name, value,
                          is_time ? "time" : "length");
}

/* A limit of NaN would never be exceeded. */
static ffd_status check_gates(const ffd_deform_desc *desc, ffd_error *error)
{
    if (desc->fail_on & FFD_GATE_TEAR && isnan(desc->tear_most))
        return ffd_fail(error, FFD_E_ARGUMENT, "the largest step of the gate tear is not a number");
    if (desc->fail_on & FFD_GATE_EDGES && !(desc->edges_most >= 0))
        return ffd_fail(error, FFD_E_ARGUMENT, "the gate edges has no length, but %g", desc->edges_most);
    if (desc->fail_on & FFD_GATE_QUALITY && isnan(desc->quality_least))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the least scaled Jacobian of the gate quality is not a number");
    return FFD_OK;
}

static ffd_status check_rule(const set_members *set, const ffd_deform_desc *desc, const job_rule *rule,
                             ffd_error *error)
{
    char text[200];
    if (!is_among(set, desc, rule->setting))
        return FFD_OK;
    if (rule->relation == JOB_NEEDS_FILES) {
        if (!desc->sink && !desc->input.bytes.data)
            return FFD_OK;
        snprintf(text, sizeof text, "{%s} needs files: here %s in memory", rule->setting,
                 desc->sink ? "the output is" : "the mesh is");
    } else {
        if (is_among(set, desc, rule->other) == (rule->relation == JOB_NEEDS))
            return FFD_OK;
        snprintf(text, sizeof text, "{%s} %s {%s}", rule->setting,
                 rule->relation == JOB_NEEDS ? "needs" : "cannot be used with", rule->other);
    }
    return ffd_fail(error, FFD_E_ARGUMENT, "%s", SPELLED(rule->why ? rule->why : text));
}

static ffd_status check_weight(const ffd_weight_source *weight, ffd_error *error)
{
    TRY(weight->source ? ffd_weight_check(weight->source, error) : FFD_OK);
    return !weight->bytes.data || ffd_weight_file(weight->source)
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "{weight}: bytes are those of a FILE.npy, not of \"%s\"",
                          weight->source);
}

ffd_status ffd_deform_desc_check(const ffd_deform_desc *callers, ffd_error *error)
{
    ffd_deform_desc desc;
    TRY(ffd_deform_desc_take(callers, &desc, error));
    if (desc.embedding.bytes.data && !desc.embedding.path)
        desc.embedding.path = "embedding";
    if (desc.weight.bytes.data && !desc.weight.source)
        desc.weight.source = "weight.npy";
    for (size_t m = 0; m < MEMBERS; m++)
        TRY(check_range(&desc, &members[m], error));
    TRY(check_gates(&desc, error));
    if (desc.seam_faces > FFD_FACES_ALL)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no faces 0x%x", desc.seam_faces);
    set_members set;
    find_set(&desc, &set);
    for (const job_rule *rule = ffd_job_rules; rule->setting; rule++)
        TRY(check_rule(&set, &desc, rule, error));
    return check_weight(&desc.weight, error);
}
