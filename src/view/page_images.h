/* page_images.h - the textures that a page has in it: the files of the model as they are, or smaller copies
   where they are too large together. */
#ifndef FFD_VIEW_PAGE_IMAGES_H
#define FFD_VIEW_PAGE_IMAGES_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "json/json_text.h"

/* The bytes of all images of a page without `full`. */
#define PAGE_IMAGE_BYTES ((uint64_t)24 << 20)

typedef struct page_image {
    uint32_t image;      /* index in the scene's materials */
    const char *type;    /* "image/png" */
    byte_buffer smaller; /* a copy that is smaller; empty: the file itself is shown */
    uint32_t side;       /* the longer side, once the image was decoded; 0 before */
} page_image;

/* All zeros: none. */
typedef struct page_images {
    const mesh_materials *from;
    page_image *list;
    size_t count;
    size_t smaller_count;
    uint64_t bytes, all_bytes; /* of the list, and as the files have them */
} page_images;

/* Lists the images of the parts of a mesh that has texture coordinates. Without `full` the largest are made
   smaller until all together are within PAGE_IMAGE_BYTES; one that cannot be decoded stays. budget: for
   decoding one at a time; NULL: none. Errors: FFD_E_MEMORY. Call ffd_page_images_free in every case. */
ffd_status ffd_page_images_take(const page_mesh *mesh, bool full, const memory_budget *budget,
                                page_images *images, ffd_error *error);
/* Returns the index in the list of an image of the scene's materials; VIEW_NONE: it is not shown. */
uint32_t ffd_page_image_of(const page_images *images, uint32_t of);
/* Writes the blocks of the images. */
void ffd_page_images_write(const page_images *images, page_writer *w);
/* Adds their types, as a member. */
void ffd_page_images_describe(const page_images *images, json_text *json);
/* Frees the list and the copies. */
void ffd_page_images_free(page_images *images);

#endif
