/* zip.h - the members of a ZIP file, stored or deflated (PKWARE's APPNOTE). */
#ifndef FFD_LATTICE_FORMATS_ZIP_H
#define FFD_LATTICE_FORMATS_ZIP_H

#include "base/file/input.h"
#include "base/text/text_scan.h"

/* The most members of a file. */
#define ZIP_MEMBERS 64

typedef struct zip_member {
    text_word name;
    uint64_t packed, size, header; /* bytes in the file and unpacked; where its own header is */
    uint32_t crc;
    bool is_deflated;
} zip_member;

typedef struct zip_list {
    zip_member members[ZIP_MEMBERS];
    size_t count;
} zip_list;

/* Lists the members. name: of the file, for messages. Errors: FFD_E_INVALID, also for a name that is there
   twice, FFD_E_LIMIT for more members than ZIP_MEMBERS, FFD_E_UNSUPPORTED for encrypted ones, those of
   several disks, and other methods. */
ffd_status ffd_zip_list(const file_input *file, const char *name, zip_list *list, ffd_error *error);
/* Returns a member, or NULL. */
const zip_member *ffd_zip_find(const zip_list *list, const char *name);
/* Unpacks a member of at most `most` bytes into *content, which the caller unloads. Errors: FFD_E_INVALID,
   FFD_E_LIMIT, FFD_E_MEMORY, those of ffd_inflate. */
ffd_status ffd_zip_unpack(const file_input *file, const char *name, const zip_member *member, uint64_t most,
                          file_input *content, ffd_error *error);

#endif
