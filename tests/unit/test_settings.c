/* test_settings.c - the table of settings: every rule is refused, in the words of each front end. */
#include "base/fail.h"
#include "base/spelling.h"
#include "cli/member.h"
#include "job/input/settings.h"
#include <ffd/program.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
/* cmocka.h needs the four above. */
#include <cmocka.h>

static const ffd_member *find(const char *name)
{
    const ffd_member *member = NULL;
    for (size_t i = 0; (member = ffd_deform_member(i)) != NULL; i++)
        if (strcmp(member->name, name) == 0)
            break;
    return member;
}

static void put(ffd_deform_desc *desc, size_t offset, const void *value, size_t size)
{
    memcpy((char *)desc + offset, value, size);
}

/* Sets what a rule speaks of: a member, to the word of a value or to anything. */
static void set(ffd_deform_desc *desc, const char *setting)
{
    static const char *const texts[] = {"a", "b"};
    static const void *const pointer = texts;
    const size_t length = strcspn(setting, "=");
    const char *const word = setting[length] ? setting + length + 1 : NULL;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)length, setting);
    const ffd_member *const member = find(name);
    assert_non_null(member);
    const size_t count = word ? 2 : 1;
    const bool yes = true;
    const double length_of_one = 1;
    int number = 1;
    switch (member->kind) {
    case FFD_MEMBER_FLAG:
        put(desc, member->offset, &yes, sizeof yes);
        return;
    case FFD_MEMBER_LENGTH:
        put(desc, member->offset, &length_of_one, sizeof length_of_one);
        return;
    case FFD_MEMBER_CHOICE:
    case FFD_MEMBER_FORMAT:
        while (word && member->words[number] && strcmp(member->words[number], word) != 0)
            number++;
        assert_non_null(member->words[number]);
        put(desc, member->offset, &number, sizeof number);
        return;
    case FFD_MEMBER_TEXTS:
    case FFD_MEMBER_SELECTORS:
    case FFD_MEMBER_CLIPS:
    case FFD_MEMBER_LATTICES:
    case FFD_MEMBER_MORPHS:
        put(desc, member->second, &count, sizeof count);
        put(desc, member->offset, &pointer, sizeof pointer);
        return;
    case FFD_MEMBER_TEXT:
    case FFD_MEMBER_WEIGHT:
    case FFD_MEMBER_OBJECT:
        put(desc, member->offset, &pointer, sizeof pointer);
        return;
    default:
        fail_msg("no rule has spoken of %s before: the test has to set it", setting);
    }
}

/* A job that breaks one rule, and none before it. */
static void break_rule(const job_rule *rule, ffd_deform_desc *desc)
{
    static const char byte = 0;
    ffd_deform_desc_init(desc, sizeof *desc);
    set(desc, rule->setting);
    if (rule->relation == JOB_EXCLUDES)
        set(desc, rule->other);
    if (rule->relation == JOB_NEEDS_FILES)
        desc->input.bytes = (ffd_bytes){&byte, 1};
}

/* In the order of the rules: in C, and in the program, as its users have read it since 0.1. */
static const char *const messages[][2] = {
    {"falloff needs outside = extend", "--falloff needs --outside extend"},
    {"rig = follow moves the shape itself, which as_morph leaves",
     "--rig follow moves the shape itself, which --as-morph leaves"},
    {"rig = follow moves nodes, which have no place with input.space = mesh",
     "--rig follow moves nodes, which have no place with --space mesh"},
    {"rig = follow cannot be used with weight: joints have no weights, and would leave the mesh",
     "--rig follow cannot be used with --weight: joints have no weights, and would leave the mesh"},
    {"embedding works with one lattice, and not with blocks",
     "--embedding works with one lattice, and not with --blocks"},
    {"embedding works with one lattice, but several morphs are given",
     "--embedding works with one lattice, but several --morph are given"},
    {"embedding works with one lattice, but several lattices are given",
     "--embedding works with one lattice, but several -l are given"},
    {"embedding needs lattices", "--embedding needs -l"},
    {"clips needs morphs", "--clip needs --morph"},
    {"as_morph cannot be used with morphs", "--as-morph cannot be used with --morph"},
    {"rig = follow moves the shape itself, which morphs leaves",
     "--rig follow moves the shape itself, which --morph leaves"},
    {"blocks cannot be used with morphs", "--blocks cannot be used with --morph"},
    {"positions cannot be used with morphs", "--positions cannot be used with --morph"},
    {"rigid cannot be used with morphs", "--rigid cannot be used with --morph"},
    {"uniform cannot be used with morphs", "--uniform cannot be used with --morph"},
    {"in_place needs files: here the mesh is in memory",
     "--in-place needs files: here the mesh is in memory"},
    {"depfile needs files: here the mesh is in memory", "--depfile needs files: here the mesh is in memory"},
    {"resources = reference needs files: here the mesh is in memory",
     "--resources reference needs files: here the mesh is in memory"},
    {"in_place cannot be used with output", "--in-place cannot be used with OUT"},
    {"in_place keeps the format: output_format cannot be used with it",
     "--in-place keeps the format: --output-format cannot be used with it"},
    {"depfile cannot be used with in_place: a file cannot depend on itself",
     "--depfile cannot be used with --in-place: a file cannot depend on itself"},
};

static void each_rule_is_refused_in_the_words_of_each_front_end(void **state)
{
    (void)state;
    ffd_deform_desc desc;
    ffd_error error;
    size_t count = 0;
    for (const job_rule *rule = ffd_job_rules; rule->setting; rule++, count++) {
        assert_true(count < sizeof messages / sizeof *messages);
        break_rule(rule, &desc);
        for (int program = 0; program < 2; program++) {
            ffd_spell_members(program ? cli_spell : NULL);
            error.message[0] = 0;
            assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_E_ARGUMENT);
            assert_string_equal(error.message, messages[count][program]);
        }
        ffd_spell_members(NULL);
    }
    assert_int_equal(count, sizeof messages / sizeof *messages);
}

static void what_a_rule_allows_is_not_refused(void **state)
{
    (void)state;
    ffd_deform_desc desc;
    ffd_error error;
    for (const job_rule *rule = ffd_job_rules; rule->setting; rule++) {
        break_rule(rule, &desc);
        if (rule->relation == JOB_NEEDS)
            set(&desc, rule->other);
        else {
            ffd_deform_desc_init(&desc, sizeof desc);
            set(&desc, rule->setting);
            if (strcmp(rule->setting, "embedding") == 0)
                set(&desc, "lattices");
        }
        assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_OK);
    }
}

static void an_embedding_in_memory_has_the_rules_of_a_file(void **state)
{
    (void)state;
    static const char byte = 0;
    ffd_deform_desc desc;
    ffd_error error;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.embedding.bytes = (ffd_bytes){&byte, 1};
    set(&desc, "lattices");
    assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_OK);
    desc.blocks = true;
    assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, "embedding works with one lattice, and not with blocks");
}

static void a_number_out_of_its_range_is_refused_with_the_member(void **state)
{
    (void)state;
    const struct {
        const char *name;
        int number;
        double value;
        const char *message;
    } cases[] = {
        {"outside", 3, 0, "3 is not a value of outside"},
        {"input.space", -1, 0, "-1 is not a value of input.space"},
        {"output_format", 14, 0, "14 is not a value of output_format"},
        {"falloff", 0, -1, "the falloff -1 is not a length"},
        {"snap", 0, NAN, "the snap nan is not a length"},
        {"timeout", 0, -2, "the timeout -2 is not a time"},
        {"seam", 4, 0, "4 is not a value of seam"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ffd_deform_desc desc;
        ffd_error error;
        ffd_deform_desc_init(&desc, sizeof desc);
        if (find(cases[i].name)->words)
            put(&desc, find(cases[i].name)->offset, &cases[i].number, sizeof cases[i].number);
        else
            put(&desc, find(cases[i].name)->offset, &cases[i].value, sizeof cases[i].value);
        assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_E_ARGUMENT);
        assert_string_equal(error.message, cases[i].message);
    }
}

/* Texts that set all members which have an option, some twice. */
static const char *const texts[][2] = {
    {"input.format", "obj"},
    {"input.space", "mesh"},
    {"input.memory", "4G"},
    {"input.strict", NULL},
    {"output_format", ".glb"},
    {"input.allow_extensions", "A"},
    {"input.allow_extensions", "B"},
    {"set", "A=1"},
    {"set", "B=x=y"},
    {"outside", "extend"},
    {"falloff", "0.5"},
    {"snap", "0.25r"},
    {"embedding", "e.npy"},
    {"fail_on", "tear=2,folds"},
    {"fail_on", "flipped=3,tear=1,edges=4"},
    {"fail_on", "inverted=7,quality=-0.5,quality=0.25"},
    {"normals", "keep"},
    {"rig", "follow"},
    {"as_morph", "a"},
    {"lattices", "l"},
    {"morphs", "'it''s'=m"},
    {"morphs", "n=k"},
    {"clips", "c: 0 n=1, 1 n=0"},
    {"only", "node:a"},
    {"only", "mesh:b"},
    {"resources", "reference"},
    {"threads", "2"},
    {"isa", "scalar"},
    {"blocks", NULL},
    {"force", NULL},
    {"if_changed", NULL},
    {"in_place", NULL},
    {"timeout", "1.5"},
    {"time", "-0.25"},
    {"weight", "1-w.npy"},
    {"seam", "C2:all"},
    {"seam", "C1:u+,w-"},
    {"rigid", "node:wheel"},
    {"rigid", "component"},
    {"uniform", "joint:eye"},
};

static void check_read(const ffd_deform_desc *desc)
{
    assert_int_equal(desc->input.format, FFD_FORMAT_OBJ);
    assert_int_equal(desc->output_format, FFD_FORMAT_GLB);
    assert_true(desc->input.memory == 4000000000u && desc->input.strict && desc->blocks && desc->in_place);
    assert_int_equal(desc->input.allow_extension_count, 2);
    assert_string_equal(desc->input.allow_extensions[1], "B");
    assert_int_equal(desc->set_count, 2);
    assert_string_equal(desc->set[1].name, "B");
    assert_string_equal(desc->set[1].value, "x=y");
    assert_true(desc->snap > 0.2 && desc->snap < 0.3 && desc->snap_relative && desc->timeout > 1);
    assert_true(desc->has_time && desc->time < -0.2);
    assert_int_equal(desc->fail_on, FFD_GATE_TEAR | FFD_GATE_FOLDS | FFD_GATE_FLIPPED | FFD_GATE_EDGES |
                                        FFD_GATE_INVERTED | FFD_GATE_QUALITY);
    assert_true(desc->inverted_most == 7 && desc->quality_least > 0.2 && desc->quality_least < 0.3);
    assert_true(desc->tear_most < 1.5 && desc->flipped_most == 3 && desc->edges_most > 3);
    assert_int_equal(desc->seam, FFD_SEAM_C1);
    assert_int_equal(desc->seam_faces, 1U << 1 | 1U << 4);
    assert_int_equal(desc->lattice_count, 3);
    assert_string_equal(desc->lattices[0].path, "l");
    assert_string_equal(desc->lattices[2].path, "k");
    assert_string_equal(desc->morphs[1], "it's");
    assert_string_equal(desc->clips[0], "c: 0 n=1, 1 n=0");
    assert_string_equal(desc->only[1], "mesh:b");
    assert_string_equal(desc->as_morph, "a");
    assert_string_equal(desc->weight.source, "1-w.npy");
}

/* A job that texts describe is the same after it was bytes, where its content leaves out what cannot change
   the output. */
static void settings_come_from_texts_and_go_through_bytes(void **state)
{
    (void)state;
    ffd_deform_desc desc, other;
    byte_buffer bytes = {0}, again = {0}, content = {0}, idle = {0};
    ffd_deform_desc_init(&desc, sizeof desc);
    ffd_deform_desc_init(&other, sizeof other);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_int_equal(ffd_member_read(find(texts[i][0]), &desc, texts[i][1], NULL), FFD_OK);
    for (size_t m = 0; ffd_deform_member(m); m++)
        assert_int_equal(ffd_member_is_set(&desc, ffd_deform_member(m)),
                         ffd_deform_member(m)->option != NULL);
    check_read(&desc);
    assert_null(desc.morphs[0]);
    ffd_settings_write(&desc, SETTINGS_ALL, &bytes);
    const char *at = bytes.data;
    assert_int_equal(ffd_settings_take(&at, &other, NULL), FFD_OK);
    assert_ptr_equal(at, bytes.data + bytes.size);
    check_read(&other);
    ffd_settings_write(&other, SETTINGS_ALL, &again);
    assert_int_equal(bytes.size, again.size);
    assert_memory_equal(bytes.data, again.data, bytes.size);
    ffd_settings_write(&desc, SETTINGS_CONTENT, &content);
    other.threads = 1;
    other.input.memory = 0;
    other.force = other.if_changed = false;
    other.embedding.path = "f.npy"; /* its bytes count, not its name */
    other.weight.source = "1-v.npy";
    ffd_settings_write(&other, SETTINGS_CONTENT, &idle);
    assert_int_equal(content.size, idle.size);
    assert_memory_equal(content.data, idle.data, content.size);
    other.weight.source = "w.npy"; /* but whether it is inverted counts, */
    idle.size = 0;
    ffd_settings_write(&other, SETTINGS_CONTENT, &idle);
    assert_true(content.size != idle.size);
    other.weight.source = "1-joint:A"; /* and what is not a file */
    idle.size = 0;
    ffd_settings_write(&other, SETTINGS_CONTENT, &idle);
    assert_true(content.size != idle.size);
    other.weight.source = "1-w.npy";
    other.falloff = 0.75;
    idle.size = 0;
    ffd_settings_write(&other, SETTINGS_CONTENT, &idle);
    assert_memory_not_equal(content.data, idle.data, content.size);
    ffd_deform_desc_clear(&desc);
    ffd_deform_desc_clear(&other);
    for (size_t m = 0; ffd_deform_member(m); m++)
        assert_false(ffd_member_is_set(&desc, ffd_deform_member(m)));
    ffd_buffer_free(&bytes);
    ffd_buffer_free(&again);
    ffd_buffer_free(&content);
    ffd_buffer_free(&idle);
}

#define WEIGHT_FORMS                                                                                         \
    " (FILE.npy, attribute:NAME, color:r|g|b|a, joint:NAME or property:NAME, perhaps after 1-)"
#define SEAM_FORM "is not C0, C1, C2 or none, alone or with faces (u-,v+,.. or all or cut), like C1:u-,v+"

static void a_text_that_does_not_fit_is_refused_with_the_member(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        {"falloff", "0", "falloff: \"0\" is not a number above 0"},
        {"snap", "-1r", "snap: \"-1r\" is not a number of at least 0, alone or followed by r"},
        {"threads", "1025", "threads: \"1025\" is not a whole number from 1 to 1024"},
        {"input.memory", "4Q", "input.memory: \"4Q\" is not a size in bytes, as 700M or 4G"},
        {"outside", "exten", "outside: \"exten\" is not one of keep, extend, error (nearest: extend)"},
        {"fail_on", "flipped=1.5", "fail_on: \"1.5\" is not a number of the gate flipped"},
        {"fail_on", "folds,tear=2,quick",
         "fail_on: unknown gate \"quick\" (known: folds, outside, multiple, singular, invalid, tear, "
         "flipped, edges, inverted, quality)"},
        {"fail_on", "quality=-1.5", "fail_on: \"-1.5\" is not a scaled Jacobian of the gate quality"},
        {"fail_on", "inverted=1.5", "fail_on: \"1.5\" is not a number of the gate inverted"},
        {"fail_on", "outsid", "fail_on: unknown gate \"outsid\" (nearest: outside)"},
        {"as_morph", "b", "as_morph is given twice: \"a\" and \"b\""},
        {"set", "A=2", "set: \"A\" is set twice"},
        {"set", "=2", "set: \"=2\" is not NAME=VALUE"},
        {"morphs", "n=j", "morphs: \"n=j\" has the name of another morph target"},
        {"blocks", "yes", "blocks takes no value"},
        {"seam", "C3", "seam: \"C3\" " SEAM_FORM},
        {"seam", "C1:", "seam: \"C1:\" " SEAM_FORM},
        {"seam", "C1:u", "seam: \"C1:u\" " SEAM_FORM},
        {"seam", "C1:u+,", "seam: \"C1:u+,\" " SEAM_FORM},
        {"seam", "C1:u+v+", "seam: \"C1:u+v+\" " SEAM_FORM},
        {"seam", "none:x-", "seam: \"none:x-\" " SEAM_FORM},
        {"snap", NULL, "snap needs a value"},
        {"weight", "joint:B", "weight is given twice: \"1-w.npy\" and \"joint:B\""},
        {"weight", "", "weight: the value is empty"},
        {"weight", "mask", "weight: \"mask\" is no source of weights" WEIGHT_FORMS},
        {"weight", "-", "weight: \"-\" is no source of weights" WEIGHT_FORMS},
        {"weight", "1-", "weight: \"1-\" is no source of weights" WEIGHT_FORMS},
        {"weight", "group:arm", "weight: \"group:arm\" is no source of weights" WEIGHT_FORMS},
        {"weight", "attribute:", "weight: \"attribute:\" names nothing" WEIGHT_FORMS},
        {"weight", "1-joint:", "weight: \"1-joint:\" names nothing" WEIGHT_FORMS},
        {"weight", "color:x", "weight: \"color:x\" names no channel" WEIGHT_FORMS},
        {"weight", "color:rg", "weight: \"color:rg\" names no channel" WEIGHT_FORMS},
    };
    ffd_deform_desc desc;
    ffd_error error;
    ffd_deform_desc_init(&desc, sizeof desc);
    assert_int_equal(ffd_member_read(find("as_morph"), &desc, "a", NULL), FFD_OK);
    assert_int_equal(ffd_member_read(find("set"), &desc, "A=1", NULL), FFD_OK);
    assert_int_equal(ffd_member_read(find("morphs"), &desc, "n=k", NULL), FFD_OK);
    assert_int_equal(ffd_member_read(find("weight"), &desc, "1-w.npy", NULL), FFD_OK);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(ffd_member_read(find(cases[i][0]), &desc, cases[i][1], &error), FFD_E_ARGUMENT);
        assert_string_equal(error.message, cases[i][2]);
    }
    assert_int_equal(desc.fail_on, 0);
    assert_int_equal(desc.set_count, 1);
    assert_int_equal(desc.lattice_count, 1);
    ffd_deform_desc_clear(&desc);
}

static void a_seam_has_a_continuity_and_faces(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        ffd_seam seam;
        unsigned faces;
    } cases[] = {
        {"C0", FFD_SEAM_C0, FFD_FACES_CUT},       {"C1:cut", FFD_SEAM_C1, FFD_FACES_CUT},
        {"C2:all", FFD_SEAM_C2, FFD_FACES_ALL},   {"C1:u-", FFD_SEAM_C1, 1},
        {"C0:w+,u-,w+", FFD_SEAM_C0, 1 | 1 << 5}, {"none", FFD_SEAM_NONE, FFD_FACES_CUT},
        {"none:v+", FFD_SEAM_NONE, 1 << 3},
    };
    ffd_deform_desc desc;
    ffd_error error;
    ffd_deform_desc_init(&desc, sizeof desc);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(ffd_member_read(find("seam"), &desc, cases[i].text, NULL), FFD_OK);
        assert_int_equal(desc.seam, cases[i].seam);
        assert_int_equal(desc.seam_faces, cases[i].faces);
        assert_int_equal(ffd_member_is_set(&desc, find("seam")), desc.seam != FFD_SEAM_NONE);
        assert_int_equal(ffd_deform_desc_check(&desc, NULL), FFD_OK);
    }
    desc.seam_faces = FFD_FACES_ALL + 1;
    assert_int_equal(ffd_deform_desc_check(&desc, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, "there are no faces 0x41");
    assert_string_equal(ffd_seam_name(FFD_SEAM_C2), "C2");
    assert_null(ffd_seam_name((ffd_seam)4));
}

static void only_the_text_of_a_message_names_members(void **state)
{
    (void)state;
    char buffer[40];
    assert_string_equal(ffd_spelled("no member", buffer, sizeof buffer), "no member");
    assert_string_equal(ffd_spelled("{\"$\": {A} {} { } {a b} {only", buffer, sizeof buffer),
                        "{\"$\": {A} {} { } {a b} {only");
    assert_string_equal(ffd_spelled("{only=%s}: {set}", buffer, sizeof buffer), "only = %s: set");
    assert_string_equal(ffd_spelled("{outside=extend}, {outside=extend}, {outside=extend}", buffer, 20),
                        "outside = extend, o");
    ffd_error error;
    ffd_fail(&error, FFD_E_ARGUMENT, "{only} \"%s\"", "{set}");
    assert_string_equal(error.message, "only \"{set}\"");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_rule_is_refused_in_the_words_of_each_front_end),
        cmocka_unit_test(what_a_rule_allows_is_not_refused),
        cmocka_unit_test(an_embedding_in_memory_has_the_rules_of_a_file),
        cmocka_unit_test(a_number_out_of_its_range_is_refused_with_the_member),
        cmocka_unit_test(settings_come_from_texts_and_go_through_bytes),
        cmocka_unit_test(a_text_that_does_not_fit_is_refused_with_the_member),
        cmocka_unit_test(a_seam_has_a_continuity_and_faces),
        cmocka_unit_test(only_the_text_of_a_message_names_members),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
