/* page_scene.h - what a page says of its scene beside the arrays, as JSON. */
#ifndef FFD_VIEW_PAGE_SCENE_H
#define FFD_VIEW_PAGE_SCENE_H

#include "view/page_data.h"
#include "view/page_options.h"
#include "view/page_rig.h"

/* Where a page shows less than its scene has, in sentences. */
#define PAGE_NOTICES 6

typedef struct page_description {
    const page_data *data;
    const page_rig *rig;
    const view_page_options *options;
    const bool *has_cage; /* one a cage: the page has its points */
    char notices[PAGE_NOTICES][160];
    size_t notice_count;
} page_description;

/* Appends the JSON of a scene, for a script element. Names are made fit to be shown (page_text.h). */
void ffd_page_describe(const page_description *page, byte_buffer *out);

#endif
