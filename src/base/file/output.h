/* output.h - writing files that are complete or absent. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_OUTPUT_H
#define FFD_BASE_FILE_OUTPUT_H

#include "base/fail.h"
#include "base/file/written_files.h"
#include <stdbool.h>
#include <stddef.h>

/* A set of files that appear together. Each is written under a temporary name beside its target
   (".NAME.ffd-tmp"; the same for the same target, locked against other runs) and renamed by the commit in the
   order of begin. */
typedef struct file_output file_output;

/* An empty set, for ffd_output_destroy. Errors: FFD_E_MEMORY. */
ffd_status ffd_output_create(file_output **output, ffd_error *error);
/* From now on the set refuses targets that written holds (FFD_E_EXISTS), and its commit adds what it wrote.
   written may be NULL and must outlive the set. */
void ffd_output_record(file_output *output, written_files *written);
/* Whether path names an open stream of this process: "-" (standard output), /dev/stdout, /dev/stderr,
   /dev/fd/N. */
bool ffd_output_is_stream(const char *path);
/* Starts the next file. To a stream bytes go at the commit's time or before, after what it holds. An
   existing target is refused with FFD_E_EXISTS unless force. Permission bits of an existing target are kept.
   Targets that are neither file nor link (/dev/null) are written straight. */
ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error);
/* Makes a folder for the next file, and those above it. They go again if the set is not committed. */
ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error);
/* Appends to the file begun last. */
ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error);
/* Removes the old target of the file begun last before the commit renames anything (a .gltf whose buffers are
   replaced). */
void ffd_output_remove_first(file_output *output);
/* From now on, where all files of the set have targets of the very same bytes, its commit leaves these as
   they are, with their times. */
void ffd_output_keep_equal(file_output *output);
/* Makes all files appear. After a failure none that was not yet renamed does. */
ffd_status ffd_output_commit(file_output *output, ffd_error *error);
/* Whether ffd_output_begin has just failed because another run is writing the target. */
bool ffd_output_was_busy(const file_output *output);
/* Frees; removes the temporary files of what was not committed. NULL and pointers to NULL are allowed. */
void ffd_output_destroy(file_output **output);
/* The refusals of ffd_output_begin, before any work is done. */
ffd_status ffd_output_check(const char *path, bool force, ffd_error *error);

#endif
