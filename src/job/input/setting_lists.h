/* setting_lists.h - the arrays of a job's settings, where this library makes them (ffd_member_read). */
#ifndef FFD_JOB_INPUT_SETTING_LISTS_H
#define FFD_JOB_INPUT_SETTING_LISTS_H

#include <ffd/settings.h>

/* Adds an element of zeros to a list, and counts it. base: the struct. NULL: memory ran out. */
void *ffd_setting_list_add(const ffd_member *member, void *base);
/* Takes the last element away again. */
void ffd_setting_list_drop(const ffd_member *member, void *base);
/* Returns a copy of a name that lives as long as the list, which has an element. *is_new: no call before had
   this name. NULL: memory ran out. */
const char *ffd_setting_list_name(const ffd_member *member, void *base, const char *name, size_t length,
                                  bool *is_new);
/* Frees all lists, which are empty then. Other members stay. */
void ffd_setting_lists_free(ffd_deform_desc *desc);
/* Adds a lattice, which makes no morph target. path is borrowed. Returns false if memory runs out. */
bool ffd_setting_lattice_add(ffd_deform_desc *desc, const char *path);
/* Adds a lattice that makes a morph target, unless another one has that name (*is_new: false). path is
   borrowed, name copied. Returns false if memory runs out. */
bool ffd_setting_morph_add(ffd_deform_desc *desc, const char *name, const char *path, bool *is_new);

#endif
