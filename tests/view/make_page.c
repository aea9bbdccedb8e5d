/* make_page.c - writes a page of ffd view for the test in a browser: make_page KIND OUT [MODEL.obj]. */
#include "../support/view_by_hand.h"
#include "view/page.h"

static double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, fold_amount;

/* A twist and a bulge of what is above the box's floor. */
static void bulge(const double from[3], double to[3])
{
    const double f = (from[1] - low[1]) / (high[1] - low[1]), angle = 0.9 * f;
    const double size = 1 + 0.55 * sin(3.14159265358979 * fmin(fmax(f, 0), 1));
    const double cx = (low[0] + high[0]) / 2, cz = (low[2] + high[2]) / 2, x = from[0] - cx, z = from[2] - cz;
    to[0] = cx + size * (cos(angle) * x + sin(angle) * z);
    to[1] = from[1] + fold_amount * (high[1] - low[1]) * sin(6.28318530717959 * f);
    to[2] = cz + size * (cos(angle) * z - sin(angle) * x);
}

static void shift(const double from[3], double to[3])
{
    const double side = high[1] - low[1];
    to[0] = from[0] + 0.12 * side;
    to[1] = from[1] + 0.1 * side * sin(3 * (from[1] - low[1]) / side);
    to[2] = from[2];
}

static void die(const char *what)
{
    fprintf(stderr, "make_page: %s\n", what);
    exit(1);
}

typedef struct growing {
    void *data;
    size_t count, capacity;
} growing;

static void add(growing *list, const void *element, size_t size)
{
    if (!ffd_grow(&list->data, &list->capacity, list->count + 1, size))
        die("out of memory");
    memcpy((char *)list->data + size * list->count++, element, size);
}

static void read_face(char *line, growing *triangles)
{
    uint32_t corners[3];
    int count = 0;
    for (char *word = strtok(line, " \t\r\n"); word; word = strtok(NULL, " \t\r\n")) {
        corners[count < 2 ? count : 2] = (uint32_t)strtoul(word, NULL, 10) - 1;
        if (++count >= 3) {
            add(triangles, corners, sizeof corners);
            corners[1] = corners[2];
        }
    }
}

/* A colour for each part. */
static void add_materials(view_scene *scene)
{
    scene->materials.count = scene->part_count;
    scene->materials.list = hand_array(scene->part_count, sizeof *scene->materials.list);
    for (size_t i = 0; i < scene->part_count; i++) {
        const double turn = 2.4 * (double)i;
        scene->materials.list[i] = (mesh_material){.name = hand_text("paint"), .base = ffd_texture_none()};
        for (int c = 0; c < 3; c++)
            scene->materials.list[i].color[c] = 0.3 + 0.25 * cos(turn + 2.1 * c);
        scene->materials.list[i].color[3] = 1;
        scene->parts[i].material = (uint32_t)i;
    }
}

/* Vertices, faces and groups, and no more. */
static view_scene read_obj(const char *path)
{
    growing positions = {0}, triangles = {0};
    view_scene scene = {0};
    char line[4096], part[200] = "";
    size_t first = 0;
    FILE *const file = fopen(path, "r");
    if (!file)
        die("cannot open the model");
    while (fgets(line, sizeof line, file)) {
        double p[3];
        if (sscanf(line, "v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3)
            add(&positions, p, sizeof p);
        else if (line[0] == 'f')
            read_face(line + 1, &triangles);
        else if (strncmp(line, "usemtl ", 7) == 0 || strncmp(line, "o ", 2) == 0) {
            if (triangles.count > first)
                hand_part(&scene, part, first, triangles.count - first);
            first = triangles.count;
            snprintf(part, sizeof part, "%.*s", (int)strcspn(line, "\r\n"), line);
        }
    }
    fclose(file);
    hand_part(&scene, part, first, triangles.count - first);
    for (size_t i = 0; i < 3 * triangles.count; i++)
        if (((uint32_t *)triangles.data)[i] >= positions.count)
            die("the model has indices that this program does not read");
    add_materials(&scene);
    scene.name = hand_text(strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
    scene.vertex_count = scene.vertices_all = positions.count;
    scene.before = positions.data;
    scene.after = hand_array(positions.count, 3 * sizeof(double));
    scene.triangle_count = triangles.count;
    scene.triangles = triangles.data;
    return scene;
}

static void measure(const view_scene *scene)
{
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
    }
    for (size_t i = 0; i < 3 * scene->vertex_count; i++) {
        low[i % 3] = fmin(low[i % 3], scene->before[i]);
        high[i % 3] = fmax(high[i % 3], scene->before[i]);
    }
    for (int a = 0; a < 3; a++) {
        const double margin = 0.02 * (high[1] - low[1]);
        low[a] -= margin;
        high[a] += margin;
    }
}

static void add_report(view_scene *scene)
{
    char text[2000];
    size_t inside = 0;
    for (size_t v = 0; v < scene->vertex_count; v++)
        inside += scene->statuses[v] == 0;
    snprintf(
        text, sizeof text,
        "{\"format\": \"ffd-report\", \"version\": 1, \"jobs\": [{\"input\": \"a </script><b>\", \"output\": "
        "null,"
        " \"status\": \"ok\", \"exit\": 0, \"error\": null, \"vertices\": %zu, \"inside\": %zu, \"outside\": "
        "%zu,"
        " \"multiple\": 0, \"singular\": 0, \"invalid\": 0, \"unused\": 0, \"hidden\": 0, \"moved\": %zu,"
        " \"residual\": {\"max\": 2.1e-16, \"rms\": 8e-17}, \"folds\": {\"verdict\": \"%s\", \"cells\": 27,"
        " \"min_det\": %g, \"folded_cells\": %d, \"unknown_cells\": 0, \"witness\": null}, "
        "\"flipped_faces\": %llu,"
        " \"tear\": {\"edges\": %llu, \"largest\": %g, \"vertex\": 3, \"part\": \"material:skin\"},"
        " \"det\": {\"min\": %g, \"max\": 2.4, \"outside\": null}, \"edges\": {\"count\": 100, \"deviation\":"
        " {\"max\": 0.0021, \"mean\": 0.0003}}, \"bounds\": {\"before\": {\"min\": [%g, %g, %g], \"max\": "
        "[%g, %g,"
        " %g]}, \"after\": {\"min\": [%g, %g, %g], \"max\": [%g, %g, %g]}}, \"displacement\": {\"max\": %g,"
        " \"rms\": %g}, \"behind\": [{\"kind\": \"camera\", \"count\": 2, \"names\": [\"a\", \"b\"]}]}]}",
        scene->vertex_count, inside, scene->vertex_count - inside, inside,
        scene->witness.is_there ? "some" : "none", scene->witness.is_there ? -0.4 : 0.31,
        scene->witness.is_there ? 6 : 0, (unsigned long long)scene->flipped_faces,
        (unsigned long long)scene->tear_edges, scene->tear_count ? scene->tears[0].step : 0,
        scene->witness.is_there ? -0.4 : 0.31, low[0], low[1], low[2], high[0], high[1], high[2], low[0],
        low[1], low[2], high[0], high[1], high[2], scene->displacement_max, scene->displacement_max / 3);
    scene->report = hand_text(text);
}

static void add_witness(view_scene *scene)
{
    scene->witness.is_there = true;
    for (int a = 0; a < 3; a++) {
        scene->witness.uvw[a] = 0.5;
        scene->witness.rest[a] = (low[a] + high[a]) / 2;
    }
    bulge(scene->witness.rest, scene->witness.xyz);
    scene->witness.det = hand_det(bulge, scene->witness.rest);
}

static view_scene make_model(const char *kind, const char *model)
{
    view_scene scene = model ? read_obj(model) : hand_grid(60);
    double box_low[3], box_high[3];
    measure(&scene);
    memcpy(box_low, low, sizeof low);
    memcpy(box_high, high, sizeof high);
    const bool is_torn = strcmp(kind, "torn") == 0;
    if (is_torn)
        box_low[1] = low[1] = (low[1] + high[1]) / 2;
    fold_amount = strcmp(kind, "fold") == 0 ? 0.3 : 0;
    hand_map const map = is_torn ? shift : bulge;
    hand_cage(&scene, is_torn ? "upper half.json" : "bulge.json", 4, 5, 4, box_low, box_high, map);
    hand_deform(&scene, box_low, box_high, map);
    hand_judge(&scene, 100, 1e-3);
    if (fold_amount > 0)
        add_witness(&scene);
    add_report(&scene);
    return scene;
}

static void rename_part(view_scene *scene, size_t part, const char *name)
{
    ffd_free(scene->parts[part].name);
    scene->parts[part].name = hand_text(name);
}

/* Two parts and a cage whose names try to be more than text; a long one, and one that is not UTF-8. */
static view_scene make_hostile(void)
{
    static char long_name[100001];
    view_scene scene = make_model("fold", NULL);
    const size_t half = scene.triangle_count / 2;
    hand_part(&scene, "", 0, half);
    hand_part(&scene, "", half, scene.triangle_count - half - 2);
    hand_part(&scene, "\"'><script>alert(3)</script>", scene.triangle_count - 2, 1);
    hand_part(&scene, "\x01\x7f\xff\xfe broken \xe2\x80", scene.triangle_count - 1, 1);
    rename_part(&scene, 0, "</script><img src=x onerror=alert(1)>\n<b>bold</b>");
    memset(long_name, 'x', sizeof long_name - 1);
    rename_part(&scene, 1, long_name);
    ffd_free(scene.name);
    scene.name = hand_text("</title><script>document.title='taken'</script>&amp; \xe2\x80\xaegpj.exe");
    scene.output = hand_text("<!--<script>");
    ffd_free(scene.cages[0].name);
    scene.cages[0].name = hand_text("\xe2\x80\xae"
                                    "cage\xe2\x80\xa8&lt;");
    return scene;
}

static view_scene make_scene(const char *kind, const char *model)
{
    if (strcmp(kind, "hostile") == 0)
        return make_hostile();
    if (strcmp(kind, "large") == 0)
        return hand_grid(520);
    if (strcmp(kind, "huge") == 0)
        return hand_grid(3162);
    if (strcmp(kind, "empty") == 0)
        return hand_scene(0, 0);
    return make_model(kind, model);
}

static void print_line(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    (void)level;
    puts(line);
}

int main(int argc, char **argv)
{
    if (argc < 3)
        die("make_page KIND OUT [MODEL.obj]");
    view_scene scene = make_scene(argv[1], argc > 3 ? argv[3] : NULL);
    const mesh_log log = {print_line, NULL};
    const view_page_options options = {.log = &log};
    file_output *output = NULL;
    ffd_error error;
    ffd_status status = ffd_output_create(&output, &error);
    if (!status)
        status = ffd_output_begin(output, argv[2], true, &error);
    if (!status)
        status = ffd_view_page_write(&scene, &options, output, &error);
    if (!status)
        status = ffd_output_commit(output, &error);
    ffd_output_destroy(&output);
    ffd_view_scene_free(&scene);
    if (status)
        die(error.message);
    return 0;
}
