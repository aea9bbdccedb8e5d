#include "mesh/resource/image_file.h"
#include "base/file/path.h"
#include <string.h>

/* Endings of images that glTF, its extensions and OBJ materials use. */
static const char *const endings[] = {".png", ".jpg", ".jpeg", ".webp", ".avif", ".ktx2", ".ktx", ".basis",
                                      ".dds", ".bmp", ".gif",  ".tif",  ".tiff", ".tga",  ".hdr", ".exr"};

/* The signature of an image format: these bytes at an offset. */
typedef struct image_mark {
    size_t offset, size;
    const char *bytes, *media_type;
} image_mark;

static const image_mark marks[] = {
    {0, 8, "\x89PNG\r\n\x1a\n", "image/png"},
    {0, 3, "\xff\xd8\xff", "image/jpeg"}, /* JPEG */
    {8, 4, "WEBP", "image/webp"},         /* in a RIFF file */
    {4, 8, "ftypavif", "image/avif"},
    {4, 8, "ftypavis", "image/avif"},
    {4, 8, "ftypmif1", "image/avif"}, /* AVIF with the general brand */
    {0, 12, "\xabKTX 20\xbb\r\n\x1a\n", "image/ktx2"},
    {0, 12, "\xabKTX 11\xbb\r\n\x1a\n", "image/ktx"},
    {0, 2, "sB", "image/x-basis"}, /* Basis Universal */
    {0, 4, "DDS ", "image/vnd-ms.dds"},
    {0, 2, "BM", "image/bmp"},
    {0, 4, "GIF8", "image/gif"},
    {0, 4, "II*\0", "image/tiff"}, /* TIFF */
    {0, 4, "MM\0*", "image/tiff"},
    {0, 10, "#?RADIANCE", "image/vnd.radiance"},
    {0, 6, "#?RGBE", "image/vnd.radiance"},
    {0, 4, "v/1\x01", "image/x-exr"}, /* OpenEXR */
};

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))
#define TGA_HEADER 18

bool ffd_image_has_name(const char *path)
{
    for (size_t i = 0; i < COUNT_OF(endings); i++)
        if (ffd_path_has_ending(path, endings[i]))
            return true;
    return false;
}

bool ffd_image_is_hidden(const char *path)
{
    return path[0] == '.' || strstr(path, "/.") || strstr(path, "\\.");
}

/* Targa has no signature: checks that the members of its header are plausible (colour map, kind, bits for
   each pixel). */
static bool is_targa(const unsigned char *bytes, size_t size)
{
    if (size < TGA_HEADER || bytes[1] > 1)
        return false;
    const unsigned kind = bytes[2] & ~8u, bits = bytes[16];
    return kind >= 1 && kind <= 3 && (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32);
}

static const image_mark *find_mark(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < COUNT_OF(marks); i++) {
        const image_mark *const mark = &marks[i];
        if (size >= mark->offset + mark->size && memcmp(bytes + mark->offset, mark->bytes, mark->size) == 0)
            return mark;
    }
    return NULL;
}

bool ffd_image_has_content(const unsigned char *bytes, size_t size)
{
    return find_mark(bytes, size) || is_targa(bytes, size);
}

const char *ffd_image_media_type(const unsigned char *bytes, size_t size)
{
    const image_mark *const mark = find_mark(bytes, size);
    return mark ? mark->media_type : "image/x-tga";
}
