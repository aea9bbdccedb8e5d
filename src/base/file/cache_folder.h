/* cache_folder.h - the user's folder for what saves time and may be lost: journals, notes of copies. */
#ifndef FFD_BASE_FILE_CACHE_FOLDER_H
#define FFD_BASE_FILE_CACHE_FOLDER_H

/* Returns the path of ours (XDG_CACHE_HOME or ~/.cache; LOCALAPPDATA), which ffd_folder_make makes; freed
   with ffd_free. NULL: there is none, as without a home folder, which is not made, or memory runs out. */
char *ffd_cache_folder(void);
/* Removes a file of it, if it can. */
void ffd_cache_remove(const char *path);

#endif
