/* build.h - what the library was built from. Each program and library has its own: build.c.in, which changes
   with each commit, or unversioned.c. */
#ifndef FFD_BASE_BUILD_H
#define FFD_BASE_BUILD_H

/* The version, and the commit where it is known: "0.3.0 (0123456789ab)". */
extern const char ffd_build_text[];

#endif
