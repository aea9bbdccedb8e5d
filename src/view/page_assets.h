/* page_assets.h - the HTML, styles and scripts of the pages, in the order in which they are written. embed.py
   makes page_assets.c, edit_assets.c and index_assets.c from the files in page/. */
#ifndef FFD_VIEW_PAGE_ASSETS_H
#define FFD_VIEW_PAGE_ASSETS_H

#include <stddef.h>

/* The page of ffd view in three pieces: the title goes between the first two, the data between the last
   two. */
extern const unsigned char ffd_page_start[], ffd_page_middle[], ffd_page_end[];
extern const size_t ffd_page_start_size, ffd_page_middle_size, ffd_page_end_size;
/* The same three pieces of the page of ffd edit, which has tools beside. */
extern const unsigned char ffd_edit_start[], ffd_edit_middle[], ffd_edit_end[];
extern const size_t ffd_edit_start_size, ffd_edit_middle_size, ffd_edit_end_size;
/* The same three pieces of the page that compares jobs. */
extern const unsigned char ffd_compare_start[], ffd_compare_middle[], ffd_compare_end[];
extern const size_t ffd_compare_start_size, ffd_compare_middle_size, ffd_compare_end_size;

#endif
