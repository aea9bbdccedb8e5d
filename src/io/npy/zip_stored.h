/* zip_stored.h - a ZIP archive of members that are stored as they are, as NumPy's .npz has them (PKWARE
   APPNOTE 6.3.10). The sizes of members are known before their bytes; checksums follow these (data
   descriptors), so that a stream will do. Archives and members of 4 GB and more are ZIP64. Libraries for ZIP
   write files of their own; this one goes through the program's outputs, which are complete or absent. */
#ifndef FFD_IO_NPY_ZIP_STORED_H
#define FFD_IO_NPY_ZIP_STORED_H

#include "base/file/output.h"
#include <stdint.h>

#define ZIP_MEMBERS 8
#define ZIP_NAME 32 /* with its final 0 */

typedef struct zip_member {
    char name[ZIP_NAME];
    uint64_t size, offset;
    uint32_t crc;
} zip_member;

typedef struct zip_writer {
    file_output *output;
    uint64_t offset;
    zip_member members[ZIP_MEMBERS];
    size_t count;
} zip_writer;

/* Begins an archive at the end of what output has, which is where it begins. */
void ffd_zip_begin(zip_writer *zip, file_output *output);
/* Begins a member of so many bytes, which follow by ffd_zip_write. */
ffd_status ffd_zip_member(zip_writer *zip, const char *name, uint64_t size, ffd_error *error);
/* Appends bytes to the member begun last. */
ffd_status ffd_zip_write(zip_writer *zip, const void *bytes, size_t size, ffd_error *error);
/* Ends the member begun last, whose bytes are all there. */
ffd_status ffd_zip_member_end(zip_writer *zip, ffd_error *error);
/* Ends the archive. */
ffd_status ffd_zip_end(zip_writer *zip, ffd_error *error);

#endif
