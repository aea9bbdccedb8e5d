/* export.h - the macro that exports a public function from the library. */
#ifndef FFD_EXPORT_H
#define FFD_EXPORT_H

#if defined(_WIN32) && !defined(FFD_STATIC)
#ifdef FFD_BUILDING
#define FFD_API __declspec(dllexport)
#else
#define FFD_API __declspec(dllimport)
#endif
#elif defined(_WIN32)
#define FFD_API
#elif defined(__GNUC__)
#define FFD_API __attribute__((visibility("default")))
#else
#define FFD_API
#endif

#endif
