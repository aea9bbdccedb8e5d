/* file_content.h - checks the content of files. Includes come after cmocka.h. */
#ifndef FFD_TESTS_FILE_CONTENT_H
#define FFD_TESTS_FILE_CONTENT_H

#include "base/file/input.h"
#include "test_folder.h"

/* Checks the text of a file in the test's folder. */
static inline void check_content(const char *name, const char *text)
{
    file_input input;
    assert_int_equal(ffd_file_load(in_folder(name), &input, NULL), FFD_OK);
    assert_int_equal(input.size, strlen(text));
    assert_memory_equal(input.data, text, input.size);
    ffd_file_unload(&input);
}

#endif
