/* obj_reader.h - an independent, simple reader of OBJ files, to check files that ffd has written: splits
   lines, then words, and uses strtod and strtol. For valid files only; a failed allocation ends the
   program. */
#ifndef FFD_TESTS_OBJ_READER_H
#define FFD_TESTS_OBJ_READER_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct plain_corner {
    size_t vertex;
    long normal; /* index from 0; -1: none */
} plain_corner;

typedef struct plain_statement {
    char keyword[8]; /* truncated; "" if there is none */
    char *text;      /* its lines, joined by '\n' */
    size_t first_corner, corners;
} plain_statement;

typedef struct plain_obj {
    double (*vertices)[3];
    double (*normals)[3];
    plain_corner *corners;
    plain_statement *statements;
    size_t vertex_count, normal_count, corner_count, statement_count;
} plain_obj;

static inline void *plain_grow(void *block, size_t count, size_t size)
{
    /* grow at powers of two only */
    if (count & (count - 1))
        return block;
    void *grown = realloc(block, (count ? 2 * count : 1) * size);
    if (!grown)
        abort();
    return grown;
}

static inline char *plain_join(char *text, const char *line, const char *between)
{
    const size_t size = text ? strlen(text) : 0;
    char *joined = realloc(text, size + strlen(between) + strlen(line) + 1);
    if (!joined)
        abort();
    if (!size)
        joined[0] = 0;
    strcat(joined, text ? between : "");
    return strcat(joined, line);
}

/* Takes the next line off *rest. The caller frees it; NULL: the end. */
static inline char *plain_line(const char **rest, const char *end)
{
    const char *first = *rest, *at = first;
    if (first == end)
        return NULL;
    while (at < end && *at != '\n' && *at != '\r')
        at++;
    char *line = calloc((size_t)(at - first) + 1, 1);
    if (!line)
        abort();
    memcpy(line, first, (size_t)(at - first));
    if (at < end)
        at += *at == '\r' && at + 1 < end && at[1] == '\n' ? 2 : 1;
    *rest = at;
    return line;
}

/* Removes a comment and a final backslash. Returns whether the line continues. names: # does not begin a
   comment. */
static inline bool plain_strip(char *line, bool names)
{
    char *comment = names ? NULL : strchr(line, '#');
    if (comment) {
        *comment = 0;
        return false;
    }
    const size_t size = strlen(line);
    if (!size || line[size - 1] != '\\')
        return false;
    line[size - 1] = 0;
    return true;
}

static inline bool plain_takes_names(const char *words)
{
    char keyword[8] = "";
    sscanf(words, "%7s", keyword);
    return !strcmp(keyword, "g") || !strcmp(keyword, "o") || !strcmp(keyword, "usemtl") ||
           !strcmp(keyword, "mtllib");
}

static inline size_t plain_index(long index, size_t count)
{
    return index < 0 ? count - (size_t)-index : (size_t)index - 1;
}

static inline void plain_add_corner(plain_obj *file, const char *word)
{
    char *end;
    plain_corner corner = {plain_index(strtol(word, &end, 10), file->vertex_count), -1};
    const char *slash = *end == '/' ? strchr(end + 1, '/') : NULL;
    if (slash && slash[1])
        corner.normal = (long)plain_index(strtol(slash + 1, NULL, 10), file->normal_count);
    file->corners = plain_grow(file->corners, file->corner_count, sizeof *file->corners);
    file->corners[file->corner_count++] = corner;
}

static inline void plain_read_vector(double xyz[3])
{
    for (int a = 0; a < 3; a++) {
        const char *word = strtok(NULL, " \t\v\f");
        xyz[a] = strtod(word ? word : "0", NULL);
    }
}

/* Takes ownership of both. words: the statement on one line, without comment. text: as in the file. */
static inline void plain_add_statement(plain_obj *file, char *words, char *text)
{
    plain_statement statement = {.text = text, .first_corner = file->corner_count};
    const char *keyword = strtok(words, " \t\v\f");
    snprintf(statement.keyword, sizeof statement.keyword, "%s", keyword ? keyword : "");
    if (!strcmp(statement.keyword, "v")) {
        file->vertices = plain_grow(file->vertices, file->vertex_count, sizeof *file->vertices);
        plain_read_vector(file->vertices[file->vertex_count++]);
    } else if (!strcmp(statement.keyword, "vn")) {
        file->normals = plain_grow(file->normals, file->normal_count, sizeof *file->normals);
        plain_read_vector(file->normals[file->normal_count++]);
    } else if (!strcmp(statement.keyword, "f")) {
        for (const char *word; (word = strtok(NULL, " \t\v\f"));)
            plain_add_corner(file, word);
        statement.corners = file->corner_count - statement.first_corner;
    }
    file->statements = plain_grow(file->statements, file->statement_count, sizeof *file->statements);
    file->statements[file->statement_count++] = statement;
    free(words);
}

static inline plain_obj plain_read(const void *bytes, size_t size)
{
    plain_obj file = {0};
    const char *rest = bytes, *end = rest + size;
    if (size >= 3 && memcmp(rest, "\xEF\xBB\xBF", 3) == 0)
        rest += 3;
    char *line;
    while ((line = plain_line(&rest, end))) {
        char *text = plain_join(NULL, line, ""), *words = NULL;
        bool goes_on = plain_strip(line, plain_takes_names(line));
        words = plain_join(NULL, line, "");
        free(line);
        while (goes_on && (line = plain_line(&rest, end))) {
            text = plain_join(text, line, "\n");
            goes_on = plain_strip(line, plain_takes_names(words));
            words = plain_join(words, line, " ");
            free(line);
        }
        plain_add_statement(&file, words, text);
    }
    return file;
}

static inline void plain_free(plain_obj *file)
{
    for (size_t i = 0; i < file->statement_count; i++)
        free(file->statements[i].text);
    free(file->statements);
    free(file->corners);
    free(file->vertices);
    free(file->normals);
}

#endif
