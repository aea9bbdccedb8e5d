/* page.h - the page of `ffd view`: one HTML file, which a browser opens without a network. */
#ifndef FFD_VIEW_PAGE_H
#define FFD_VIEW_PAGE_H

#include "base/file/output.h"
#include "view/page_options.h"
#include "view/view_scene.h"

/* Writes a page into the file that output began last; the caller commits it. A mesh that is too large for a
   browser is simplified; the page and the log say so. Errors: FFD_E_ARGUMENT (an index of the scene is out of
   range), FFD_E_LIMIT, FFD_E_IO, FFD_E_MEMORY, FFD_E_UNSUPPORTED (a mesh must be simplified, and
   meshoptimizer is missing). */
ffd_status ffd_view_page_write(const view_scene *scene, const view_page_options *options, file_output *output,
                               ffd_error *error);

#endif
