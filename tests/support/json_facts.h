/* json_facts.h - parses JSON that the program has written, for tests of single values. */
#ifndef FFD_TESTS_JSON_FACTS_H
#define FFD_TESTS_JSON_FACTS_H

#include "json/json_parse.h"
#include <stdlib.h>
#include <string.h>

typedef struct json_facts {
    char *text;
    json_tree tree;
} json_facts;

/* Parses a copy of a text, which must be JSON. Free it with facts_free. */
static inline json_facts *facts_read(const char *text, size_t size)
{
    json_facts *const facts = calloc(1, sizeof *facts);
    assert_non_null(facts);
    facts->text = malloc(size + 1);
    assert_non_null(facts->text);
    memcpy(facts->text, text, size);
    facts->text[size] = 0;
    ffd_error error;
    if (ffd_json_parse(&(json_input){.text = facts->text, .size = size, .name = "facts"}, &facts->tree,
                       &error))
        fail_msg("%s in %s", error.message, facts->text);
    return facts;
}

static inline void facts_free(json_facts *facts)
{
    ffd_json_tree_free(&facts->tree);
    free(facts->text);
    free(facts);
}

/* Finds a value by member names separated by dots, such as "topology.edges". Returns JSON_NONE if there is
   none. */
static inline uint32_t facts_member(const json_facts *facts, const char *names)
{
    char copy[64];
    uint32_t value = 0;
    assert_true(strlen(names) < sizeof copy);
    strcpy(copy, names);
    for (char *name = copy, *end; value != JSON_NONE && name; name = end) {
        end = strchr(name, '.');
        if (end)
            *end++ = 0;
        value = ffd_json_tree_member(&facts->tree, value, name);
    }
    return value;
}

static inline int facts_is(const json_facts *facts, const char *names, json_kind kind)
{
    const uint32_t value = facts_member(facts, names);
    return value != JSON_NONE && facts->tree.values[value].kind == kind;
}

/* Returns a number; fails if the value is not one. */
static inline double facts_number(const json_facts *facts, uint32_t value)
{
    double number = 0;
    if (!ffd_json_tree_number(&facts->tree, value, &number))
        fail_msg("not a number in %s", facts->text);
    return number;
}

static inline double facts_number_at(const json_facts *facts, const char *names, size_t i)
{
    return facts_number(facts, ffd_json_tree_element(&facts->tree, facts_member(facts, names), i));
}

static inline void assert_text(const json_facts *facts, uint32_t value, const char *expected)
{
    assert_true(value != JSON_NONE && facts->tree.values[value].kind == JSON_STRING);
    if (!ffd_json_tree_string_is(&facts->tree, value, expected))
        fail_msg("%.*s is not \"%s\"", (int)(facts->tree.values[value].end - facts->tree.values[value].begin),
                 facts->text + facts->tree.values[value].begin, expected);
}

#endif
