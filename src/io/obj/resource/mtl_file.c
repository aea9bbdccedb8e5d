#include "io/obj/resource/mtl_file.h"
#include "base/file/path.h"
#include "io/obj/resource/obj_paths.h"
#include <string.h>

const resource_kind ffd_resource_library = {
    .name = "material library",
    .has_name = ffd_mtl_has_name,
    .has_content = ffd_mtl_has_content,
    .other_name = "does not have the ending of a material library (.mtl)",
    .other_content = "does not have the content of a material library"};

/* Statements that name a map, beside map_*. */
static const char *const map_words[] = {"bump", "disp", "decal", "refl", "norm"};

/* The options of a map: how many words follow. */
typedef struct map_option {
    const char *name;
    int words;
    bool numbers; /* at least one, and as many more as there are numbers */
} map_option;

static const map_option map_options[] = {
    {"-blendu", 1, false}, {"-blendv", 1, false},     {"-bm", 1, false},      {"-boost", 1, false},
    {"-cc", 1, false},     {"-clamp", 1, false},      {"-imfchan", 1, false}, {"-mm", 2, false},
    {"-o", 3, true},       {"-s", 3, true},           {"-t", 3, true},        {"-texres", 1, false},
    {"-type", 1, false},   {"-colorspace", 1, false},
};

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

bool ffd_mtl_has_name(const char *path)
{
    return ffd_path_has_ending(path, ".mtl") || ffd_path_has_ending(path, ".mat");
}

bool ffd_mtl_has_content(const unsigned char *bytes, size_t size)
{
    text_scan scan;
    text_word word;
    const size_t text = ffd_text_size(bytes, size);
    if (memchr(bytes, 0, size))
        return false;
    ffd_text_begin(&scan, bytes, text, true);
    if (!ffd_text_find(&scan))
        return true;
    ffd_text_word(&scan, &word);
    return ffd_text_is_any_case(word, "newmtl");
}

static bool names_map(text_word word)
{
    static const char prefix[] = "map_";
    const size_t size = sizeof prefix - 1;
    if ((size_t)(word.last - word.first) > size &&
        ffd_text_is_any_case((text_word){word.first, word.first + size}, prefix))
        return !ffd_text_is_any_case(word, "map_aat"); /* on or off */
    for (size_t i = 0; i < COUNT_OF(map_words); i++)
        if (ffd_text_is_any_case(word, map_words[i]))
            return true;
    return false;
}

static const map_option *option_of(text_word word)
{
    for (size_t i = 0; i < COUNT_OF(map_options); i++)
        if (ffd_text_is_any_case(word, map_options[i].name))
            return &map_options[i];
    return NULL;
}

/* Reads the words of an option behind its name. Returns whether there is a further word. */
static bool pass_option(text_scan *scan, const map_option *option, text_word *word, double numbers[3])
{
    bool there = ffd_text_word(scan, word);
    for (int i = 0; there && i < option->words; i++) {
        if (option->numbers) {
            double number; /* a name may begin with one: "512.png" */
            if (!ffd_text_number(*word, &number))
                break;
            numbers[i] = number;
        }
        there = ffd_text_word(scan, word);
    }
    return there;
}

/* Moves to the first word that is not an option and belongs to none. */
static bool pass_options(text_scan *scan, text_word *word, mtl_map *map)
{
    const map_option *option;
    bool there = ffd_text_word(scan, word);
    while (there && (option = option_of(*word))) {
        text_scan at = *scan;
        text_word first;
        const bool has_scale = strcmp(option->name, "-s") == 0, has_offset = strcmp(option->name, "-o") == 0;
        /* Of a scale or an offset, the numbers that are left out stay. */
        double numbers[3] = {has_scale ? 1 : 0, has_scale ? 1 : 0, 0};
        if (strcmp(option->name, "-clamp") == 0)
            map->is_clamped = ffd_text_word(&at, &first) && ffd_text_is_any_case(first, "on");
        there = pass_option(scan, option, word, numbers);
        if (has_scale || has_offset)
            memcpy(has_scale ? map->scale : map->offset, numbers, sizeof map->scale);
    }
    return there;
}

bool ffd_mtl_read_map(text_scan *scan, mtl_map *map)
{
    text_word word;
    *map = (mtl_map){.scale = {1, 1}};
    if (!pass_options(scan, &map->name, map))
        return false;
    while (ffd_text_word(scan, &word)) /* the name goes on to the end of the line, blanks included */
        map->name.last = word.last;
    return true;
}

ffd_status ffd_mtl_list_maps(const unsigned char *bytes, size_t size, const char *path, intern_table *names,
                             ffd_error *error)
{
    text_scan scan;
    text_word word;
    mtl_map map;
    ffd_text_begin(&scan, bytes, ffd_text_size(bytes, size), false);
    do {
        if (!ffd_text_word(&scan, &word) || !names_map(word) || !ffd_mtl_read_map(&scan, &map))
            continue;
        TRY(ffd_obj_add_name(names, map.name.first, (size_t)(map.name.last - map.name.first), path, error));
    } while (ffd_text_next_line(&scan));
    return FFD_OK;
}
