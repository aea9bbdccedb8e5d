/* msh_reader.h - reads a mesh of Gmsh, versions 2 and 4.1, in text or in binary. Declares msh_reader.c,
   msh_nodes.c, msh_elements.c, msh_groups.c. */
#ifndef FFD_IO_MSH_MSH_READER_H
#define FFD_IO_MSH_MSH_READER_H

#include "io/volume/volume_document.h"

/* A node by its tag. */
typedef struct msh_tag {
    uint64_t tag;
    uint32_t vertex;
} msh_tag;

/* A group of a dimension, as the file names it. */
typedef struct msh_name {
    uint64_t dimension, tag;
    text_word name;
} msh_name;

/* An entity of the geometry, and one physical group that it is in; sorted by dimension and tag. An entity in
   several is there several times. */
typedef struct msh_entity {
    uint64_t dimension;
    int64_t tag, physical;
} msh_entity;

typedef struct msh_reader {
    volume_document *d;
    text_scan scan;                 /* in binary only its place */
    bool is_binary, is_big, is_new; /* is_new: version 4.1 */
    bool has_format, has_nodes;
    size_t word; /* bytes of a number of things, version 4.1 in binary */
    msh_tag *tags;
    size_t tag_count;
    msh_name *names;
    size_t name_count, name_capacity;
    msh_entity *entities;
    size_t entity_count, entity_capacity;
    ffd_error *error;
} msh_reader;

/* The line for a message; 0: the file is binary. */
static inline size_t msh_line(const msh_reader *r)
{
    return r->is_binary ? 0 : r->scan.line;
}

#define MSH_REFUSE(r, ...)                                                                                   \
    ffd_fail_line((r)->error, FFD_E_INVALID, (r)->d->file.name, msh_line(r), __VA_ARGS__)

/* Takes a word of the text, in this line or a later one. */
ffd_status ffd_msh_word(msh_reader *r, const char *what, text_word *word);
/* Takes a whole number, in binary of 32 bits. */
ffd_status ffd_msh_int(msh_reader *r, const char *what, int64_t *number);
/* Takes a number of things or a tag, in binary of version 4.1 of `word` bytes, of older ones of 32 bits. */
ffd_status ffd_msh_size(msh_reader *r, const char *what, uint64_t *number);
/* The same for a number of things of which each takes at least so many bytes of the file. */
ffd_status ffd_msh_count(msh_reader *r, const char *what, size_t least, uint64_t *number);
/* Skips coordinates. */
ffd_status ffd_msh_skip(msh_reader *r, size_t count);

/* Takes the content of $Nodes; is_parametric: of $ParametricNodes. */
ffd_status ffd_msh_nodes(msh_reader *r, bool is_parametric);
/* Takes the content of $Elements. */
ffd_status ffd_msh_elements(msh_reader *r);
/* Takes the content of $PhysicalNames. */
ffd_status ffd_msh_names(msh_reader *r);
/* Takes the content of $Entities. */
ffd_status ffd_msh_entities(msh_reader *r);

/* Returns the first row of an entity, by its dimension and tag; or that behind them, if it is not there. */
size_t ffd_msh_find_entity(const msh_reader *r, const msh_entity *wanted);
/* Returns whether a row is of that entity. */
bool ffd_msh_is_entity(const msh_reader *r, size_t row, const msh_entity *wanted);
/* Finds a node. Errors: FFD_E_INVALID. */
ffd_status ffd_msh_vertex(msh_reader *r, uint64_t tag, uint32_t *vertex);
/* Finds or adds the group of a physical tag. */
ffd_status ffd_msh_physical(msh_reader *r, uint64_t dimension, int64_t physical, size_t *group);

#endif
