/* path_flaw.h - paths that Windows takes for something else than a file of that name. */
#ifndef FFD_BASE_WINDOWS_PATH_FLAW_H
#define FFD_BASE_WINDOWS_PATH_FLAW_H

/* Returns what a path is instead, to follow the name in a message; NULL: nothing else. */
const char *ffd_path_flaw(const char *path);

#endif
