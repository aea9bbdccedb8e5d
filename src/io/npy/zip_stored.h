/* zip_stored.h - writes a ZIP archive of uncompressed members, like NumPy's .npz (PKWARE APPNOTE 6.3.10). The
   size of a member is known before its bytes, the checksum follows them (data descriptor), so that the output
   may be a stream. Archives and members of 4 GB and more are ZIP64.

   A library for ZIP would write files itself; this code uses the program's outputs, which are complete or
   absent. */
#ifndef FFD_IO_NPY_ZIP_STORED_H
#define FFD_IO_NPY_ZIP_STORED_H

#include "base/file/output.h"
#include <stdint.h>

#define ZIP_MEMBERS 8
#define ZIP_NAME 32 /* with the final 0 */

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

/* Begins an archive at the current end of output. */
void ffd_zip_begin(zip_writer *zip, file_output *output);
/* Begins a member of this size; ffd_zip_write then writes its bytes. */
ffd_status ffd_zip_member(zip_writer *zip, const char *name, uint64_t size, ffd_error *error);
/* Appends bytes to the current member. */
ffd_status ffd_zip_write(zip_writer *zip, const void *bytes, size_t size, ffd_error *error);
/* Ends the current member, once all its bytes are written. */
ffd_status ffd_zip_member_end(zip_writer *zip, ffd_error *error);
/* Ends the archive. */
ffd_status ffd_zip_end(zip_writer *zip, ffd_error *error);

#endif
