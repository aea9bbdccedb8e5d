/* mtl_file.h - material libraries of OBJ files (.mtl): which files are such, and the maps that they name. */
#ifndef FFD_IO_OBJ_RESOURCE_MTL_FILE_H
#define FFD_IO_OBJ_RESOURCE_MTL_FILE_H

#include "base/fail.h"
#include "base/memory/intern.h"
#include "base/text/text_scan.h"
#include "mesh/resource/resource_list.h"

extern const resource_kind ffd_resource_library;

/* Whether the name ends as those of libraries do: .mtl or .mat, letters in any case. */
bool ffd_mtl_has_name(const char *path);
/* Whether the bytes are text whose first statement is newmtl, or that has none. */
bool ffd_mtl_has_content(const unsigned char *bytes, size_t size);
/* A map that a statement names. */
typedef struct mtl_map {
    text_word name;             /* may hold blanks */
    bool is_clamped;            /* -clamp on */
    double scale[2], offset[2]; /* -s and -o */
} mtl_map;
/* Takes the map of a statement from behind its keyword on. False: it names none. */
bool ffd_mtl_read_map(text_scan *scan, mtl_map *map);
/* Lists the names of the maps of a library, as they are written. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_mtl_list_maps(const unsigned char *bytes, size_t size, const char *path, intern_table *names,
                             ffd_error *error);

#endif
