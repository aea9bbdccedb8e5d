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
    case FFD_MEMBER_LIST:
        put(desc, member->count, &count, sizeof count);
        put(desc, member->offset, &pointer, sizeof pointer);
        return;
    case FFD_MEMBER_TEXT:
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
        {"output_format", 7, 0, "7 is not a value of output_format"},
        {"falloff", 0, -1, "the falloff -1 is not a length"},
        {"snap", 0, NAN, "the snap nan is not a length"},
        {"timeout", 0, -2, "the timeout -2 is not a time"},
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
        cmocka_unit_test(only_the_text_of_a_message_names_members),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
