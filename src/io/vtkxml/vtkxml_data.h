/* vtkxml_data.h - the data of an array that is not text: decoded from base64, and decompressed. */
#ifndef FFD_IO_VTKXML_VTKXML_DATA_H
#define FFD_IO_VTKXML_VTKXML_DATA_H

#include "io/vtkxml/vtkxml_document.h"

/* The size of data that may have any. */
#define VTKXML_ANY_SIZE UINT64_MAX

typedef struct vtkxml_data {
    const unsigned char *bytes; /* size */
    size_t size;
    const char *first, *last;    /* what stands for them in the file, with the header */
    bool is_raw, has_own_header; /* has_own_header: in base64, the header is a text of its own */
    uint64_t *head;              /* compressed: 3 numbers, and the compressed sizes of head[0] blocks */
    unsigned char *packed;       /* compressed: the blocks; or what was base64 */
    unsigned char *block;        /* allocated: the bytes; NULL: they are in the file */
} vtkxml_data;

/* Decodes the data of an array, which must be `size` bytes. Free them in every case. Errors: FFD_E_INVALID,
   FFD_E_MEMORY, FFD_E_LIMIT (budget of the document). */
ffd_status ffd_vtkxml_decode(const vtkxml_document *document, const vtkxml_array *array, uint64_t size,
                             vtkxml_data *data, ffd_error *error);
/* Frees the data and empties the struct. */
void ffd_vtkxml_data_free(vtkxml_data *data);
/* Appends what stands for changed bytes of the same size. Blocks that did not change stay as they are.
   Errors: FFD_E_MEMORY, those of ffd_deflate. */
ffd_status ffd_vtkxml_encode(const vtkxml_document *document, const vtkxml_data *data,
                             const unsigned char *bytes, byte_buffer *text, ffd_error *error);

/* Returns the run of an array of this many tuples: in the text, or in the decoded data. */
number_run ffd_vtkxml_run(const vtkxml_document *document, const vtkxml_array *array, size_t tuples,
                          const vtkxml_data *data);
/* Reads an array of tuples of `width` numbers. what: names one in messages. *first, *last: what stands for it
   in the file. Errors: those of ffd_vtkxml_decode. */
ffd_status ffd_vtkxml_read(const vtkxml_document *document, const vtkxml_array *array, uint64_t tuples,
                           const char *what, double *values, const char **first, const char **last,
                           ffd_error *error);
/* Reads whole numbers; those below 0 are UINT64_MAX. count: how many there must be, at least; or
   VTKXML_ANY_SIZE. *found: how many there are. The caller frees *values. Errors: those of ffd_vtkxml_decode.
 */
ffd_status ffd_vtkxml_wholes(const vtkxml_document *document, const vtkxml_array *array, uint64_t count,
                             uint64_t **values, uint64_t *found, ffd_error *error);

#endif
