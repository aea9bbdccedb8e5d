/* fuzz_foam.c - the fuzz target of meshes of OpenFOAM: the points, and each file beside them behind a line
   with its name, "@faces". */
#define _GNU_SOURCE /* memmem */
#include "fuzz_mesh.h"
#include "fuzz_target.h"
#include "work_folder.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *const names[] = {"faces",      "owner",     "neighbour", "boundary",
                                    "pointZones", "faceZones", "cellZones"};
#define NAMES (sizeof names / sizeof *names)

/* Finds the line with a name. Returns where the file before it ends, or NULL; *first: where its own begins.
 */
static const uint8_t *find(const uint8_t *data, size_t size, const char *name, const uint8_t **first)
{
    char line[32];
    const size_t length = (size_t)snprintf(line, sizeof line, "\n@%s\n", name);
    const uint8_t *const found = memmem(data, size, line, length);
    *first = found ? found + length : NULL;
    return found;
}

/* Where the file that begins at first ends: before the next line with a name. */
static const uint8_t *end_of(const uint8_t *first, const uint8_t *last)
{
    const uint8_t *end = last, *next;
    for (size_t n = 0; n < NAMES; n++) {
        const uint8_t *const found = find(first, (size_t)(end - first), names[n], &next);
        end = found ? found : end;
    }
    return end;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t none;
    const uint8_t *const begin = data ? data : &none, *const last = begin + size, *first;
    for (size_t n = 0; n < NAMES; n++) {
        char path[WORK_PATH];
        work_path(names[n], path);
        unlink(path);
        if (find(begin, size, names[n], &first))
            work_write(names[n], first, (size_t)(end_of(first, last) - first));
    }
    fuzz_mesh(FFD_FORMAT_FOAM, begin, (size_t)(end_of(begin, last) - begin));
    return 0;
}
