/* page_scene.h - the JSON that describes a page's scene beside its arrays. */
#ifndef FFD_VIEW_PAGE_SCENE_H
#define FFD_VIEW_PAGE_SCENE_H

#include "view/page_data.h"
#include "view/page_edit.h"
#include "view/page_images.h"
#include "view/page_options.h"
#include "view/page_rig.h"
#include "view/page_targets.h"
#include "view/page_texcoords.h"

/* The most notices of what a page leaves out; one sentence each. */
#define PAGE_NOTICES 8

typedef struct page_description {
    const page_data *data;
    const page_texcoords *texcoords;
    const page_images *images;
    const page_rig *rig;
    const page_targets *targets;
    const page_edit *edit;
    const view_page_options *options;
    const bool *has_cage; /* of each cage: whether the page has its points */
    char notices[PAGE_NOTICES][160];
    size_t notice_count;
} page_description;

/* Appends the JSON of a scene, escaped for a script element. Names are made fit to be shown (page_text.h). */
void ffd_page_describe(const page_description *page, byte_buffer *out);

#endif
