/* page.h - the page of `ffd view`: one HTML file, which a browser opens without a network. */
#ifndef FFD_VIEW_PAGE_H
#define FFD_VIEW_PAGE_H

#include "base/file/output.h"
#include "view/page_options.h"
#include "view/view_scene.h"

/* Writes a page into the file that output began last, up to its last byte; the commit is the caller's. What
   is too much for a browser is reduced; the page and the log say so. Errors: FFD_E_ARGUMENT (a scene whose
   indices are beyond its arrays), FFD_E_LIMIT, FFD_E_IO, FFD_E_MEMORY, FFD_E_UNSUPPORTED (a mesh that has to
   be reduced, without meshoptimizer). */
ffd_status ffd_view_page_write(const view_scene *scene, const view_page_options *options, file_output *output,
                               ffd_error *error);

#endif
