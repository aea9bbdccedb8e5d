/* ffd-0.3.h - the public headers that programs of this ABI were built with (test_abi.py --keep). */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
typedef enum ffd_status {
    FFD_OK = 0,
    FFD_E_GATE = -1,
    FFD_E_UNMET = -2,
    FFD_E_ARGUMENT = -10,
    FFD_E_IO = -20,
    FFD_E_EXISTS = -21,
    FFD_E_INVALID = -30,
    FFD_E_EMBEDDING = -40,
    FFD_E_UNSUPPORTED = -50,
    FFD_E_MEMORY = -60,
    FFD_E_LIMIT = -61,
    FFD_E_CANCELLED = -70
} ffd_status;
typedef struct ffd_error {
    ffd_status status;
    char file[1024];
    size_t line;
    char pointer[256];
    char message[512];
} ffd_error;
size_t ffd_error_format(const ffd_error *error, char *text, size_t capacity);
int ffd_status_exit_code(ffd_status status);
typedef struct ffd_lattice ffd_lattice;
typedef struct ffd_bytes {
    const void *data;
    size_t size;
} ffd_bytes;
typedef struct ffd_lattice_source {
    const char *path;
    ffd_bytes text;
    const ffd_lattice *object;
} ffd_lattice_source;
typedef enum ffd_volume { FFD_VOLUME_REST = 0, FFD_VOLUME_DEFORMED = 1 } ffd_volume;
typedef enum ffd_knots {
    FFD_KNOTS_DEFAULT = 0,
    FFD_KNOTS_CLAMPED,
    FFD_KNOTS_OPEN,
    FFD_KNOTS_UNIFORM,
    FFD_KNOTS_CLOSED
} ffd_knots;
typedef enum ffd_lattice_shape { FFD_SHAPE_BOX = 0, FFD_SHAPE_CYLINDER } ffd_lattice_shape;
typedef enum ffd_spacing { FFD_SPACING_GREVILLE = 0, FFD_SPACING_UNIFORM } ffd_spacing;
typedef struct ffd_lattice_desc {
    size_t struct_size;
    ffd_lattice_shape shape;
    size_t size[3];
    int degree[3];
    ffd_knots knots[3];
    double margin[3];
    ffd_spacing spacing;
    double axis[3];
    bool principal;
} ffd_lattice_desc;
void ffd_lattice_desc_init(ffd_lattice_desc *desc, size_t size);
ffd_status ffd_lattice_load(const char *path, ffd_lattice **lattice, ffd_error *error);
void ffd_lattice_destroy(ffd_lattice **lattice);
typedef struct ffd_setting {
    const char *name, *value;
} ffd_setting;
ffd_status ffd_lattice_load_set(const char *path, const ffd_setting *values, size_t count, bool *used,
                                ffd_lattice **lattice, ffd_error *error);
ffd_status ffd_lattice_load_rest(const char *path, const ffd_setting *values, size_t count, bool *used,
                                 ffd_lattice **lattice, ffd_error *error);
ffd_status ffd_lattice_parse(const char *text, size_t size, const char *name, ffd_lattice **lattice,
                             ffd_error *error);
ffd_status ffd_lattice_parse_set(const char *text, size_t size, const char *name, const ffd_setting *values,
                                 size_t count, bool *used, ffd_lattice **lattice, ffd_error *error);
size_t ffd_lattice_get_column_count(const ffd_lattice *lattice);
ffd_status ffd_lattice_get_column(const ffd_lattice *lattice, size_t column, char **name, ffd_error *error);
typedef struct ffd_parameter {
    size_t struct_size;
    const char *name;
    const char *default_value;
    const char *unit, *comment;
    double min, max;
} ffd_parameter;
typedef bool (*ffd_parameter_function)(void *user, const ffd_parameter *parameter);
ffd_status ffd_lattice_list_parameters(const char *text, size_t size, const char *name,
                                       ffd_parameter_function function, void *user, ffd_error *error);
ffd_status ffd_lattice_create(const ffd_lattice_desc *desc, const double *xyz, size_t count,
                              ffd_lattice **lattice, ffd_error *error);
typedef struct ffd_lattice_arrays {
    size_t struct_size;
    size_t size[3];
    int degree[3];
    ffd_knots knots[3];
    const double *knot_values[3];
    size_t knot_count[3];
    const double *rest;
    double box_min[3], box_max[3];
    double axes[9];
    const double *rest_weights;
} ffd_lattice_arrays;
void ffd_lattice_arrays_init(ffd_lattice_arrays *arrays, size_t size);
ffd_status ffd_lattice_from_arrays(const ffd_lattice_arrays *arrays, ffd_lattice **lattice, ffd_error *error);
ffd_status ffd_lattice_copy(const ffd_lattice *lattice, ffd_lattice **copy, ffd_error *error);
ffd_status ffd_lattice_set_points(ffd_lattice *lattice, const size_t *index, size_t count, const double *xyz,
                                  ffd_error *error);
ffd_status ffd_lattice_set_offsets(ffd_lattice *lattice, const size_t *index, size_t count, const double *xyz,
                                   ffd_error *error);
ffd_status ffd_lattice_set_weights(ffd_lattice *lattice, const size_t *index, size_t count,
                                   const double *weights, ffd_error *error);
const double *ffd_lattice_get_offsets(const ffd_lattice *lattice);
size_t ffd_lattice_get_knots(const ffd_lattice *lattice, int direction, const double **knots);
size_t ffd_lattice_get_keys(const ffd_lattice *lattice, double *times);
ffd_status ffd_lattice_set_time(ffd_lattice *lattice, double time, ffd_error *error);
ffd_status ffd_lattice_text(const ffd_lattice *lattice, char **text, size_t *size, ffd_error *error);
void ffd_free(void *block);
ffd_status ffd_lattice_save(const ffd_lattice *lattice, const char *path, bool force, ffd_error *error);
bool ffd_lattice_needs_bounds(const ffd_lattice *lattice);
size_t ffd_lattice_get_mesh_count(const ffd_lattice *lattice);
ffd_status ffd_lattice_get_mesh(const ffd_lattice *lattice, size_t i, char **path, ffd_error *error);
ffd_status ffd_lattice_fit(ffd_lattice *lattice, const double min[3], const double max[3], ffd_error *error);
void ffd_lattice_get_size(const ffd_lattice *lattice, size_t size[3]);
void ffd_lattice_get_degree(const ffd_lattice *lattice, int degree[3]);
void ffd_lattice_get_domain(const ffd_lattice *lattice, double lo[3], double hi[3]);
const double *ffd_lattice_get_points(const ffd_lattice *lattice, ffd_volume volume);
const double *ffd_lattice_get_weights(const ffd_lattice *lattice, ffd_volume volume);
void ffd_lattice_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3], double point[3],
                          double jacobian[9]);
typedef struct ffd_refine_desc {
    size_t struct_size;
    int degree[3];
    const double *insert[3];
    size_t insert_count[3];
    size_t size[3];
} ffd_refine_desc;
void ffd_refine_desc_init(ffd_refine_desc *desc, size_t size);
ffd_status ffd_lattice_refine(const ffd_lattice *lattice, const ffd_refine_desc *desc, ffd_lattice **refined,
                              ffd_error *error);
ffd_status ffd_lattice_strength(const ffd_lattice *lattice, double strength, ffd_lattice **result,
                                ffd_error *error);
ffd_status ffd_lattice_blend(const ffd_lattice *lattice, const ffd_lattice *other, double t,
                             ffd_lattice **result, ffd_error *error);
ffd_status ffd_lattice_add(const ffd_lattice *lattice, const ffd_lattice *other, ffd_lattice **result,
                           ffd_error *error);
ffd_status ffd_lattice_mirror(const ffd_lattice *lattice, int direction, ffd_lattice **result,
                              ffd_error *error);
ffd_status ffd_lattice_symmetrize(const ffd_lattice *lattice, int direction, bool keep_last,
                                  ffd_lattice **result, ffd_error *error);
ffd_status ffd_lattice_transform(const ffd_lattice *lattice, const double matrix[16], ffd_lattice **result,
                                 ffd_error *error);
ffd_status ffd_lattice_seal(const ffd_lattice *lattice, int k, unsigned faces, ffd_lattice **result,
                            ffd_error *error);
ffd_status ffd_lattice_invert(const ffd_lattice *lattice, int threads, ffd_lattice **result,
                              ffd_error *error);
ffd_status ffd_lattice_jitter(const ffd_lattice *lattice, const double sigma[3], uint64_t seed,
                              ffd_lattice **result, ffd_error *error);
typedef enum ffd_vertex_status {
    FFD_VERTEX_INSIDE = 0,
    FFD_VERTEX_OUTSIDE = 1,
    FFD_VERTEX_MULTIPLE = 2,
    FFD_VERTEX_SINGULAR = 3,
    FFD_VERTEX_INVALID = 4
} ffd_vertex_status;
const char *ffd_vertex_status_name(ffd_vertex_status status);
typedef enum ffd_outside { FFD_OUTSIDE_KEEP = 0, FFD_OUTSIDE_EXTEND, FFD_OUTSIDE_ERROR } ffd_outside;
typedef struct ffd_locator ffd_locator;
typedef struct ffd_location {
    double uvw[3];
    double residual;
    uint8_t status;
    bool unresolved;
    uint32_t evaluations;
    uint32_t leaves;
} ffd_location;
ffd_status ffd_locator_create(const ffd_lattice *lattice, ffd_locator **locator, ffd_error *error);
void ffd_locator_destroy(ffd_locator **locator);
const char *ffd_locator_get_method(const ffd_locator *locator);
typedef struct ffd_border_allowance {
    size_t struct_size;
    const double *rounding;
    double snap;
} ffd_border_allowance;
ffd_status ffd_locator_locate(const ffd_locator *locator, const double *xyz, size_t count,
                              const ffd_border_allowance *allowance, ffd_location *locations,
                              size_t location_size, ffd_error *error);
typedef enum ffd_isa {
    FFD_ISA_AUTO,
    FFD_ISA_SCALAR,
    FFD_ISA_SSE2,
    FFD_ISA_AVX2,
    FFD_ISA_AVX512,
    FFD_ISA_NEON
} ffd_isa;
bool ffd_isa_available(ffd_isa isa);
typedef enum ffd_fold_verdict {
    FFD_FOLDS_NONE = 0,
    FFD_FOLDS_SOME = 1,
    FFD_FOLDS_UNKNOWN = 2
} ffd_fold_verdict;
const char *ffd_fold_verdict_name(ffd_fold_verdict verdict);
typedef enum ffd_fold_reference {
    FFD_FOLDS_TO_MEAN = 0,
    FFD_FOLDS_TO_BOUNDS = 1,
    FFD_FOLDS_TO_PLACE = 2
} ffd_fold_reference;
const char *ffd_fold_reference_name(ffd_fold_reference reference);
typedef struct ffd_fold_witness {
    bool is_there;
    uint64_t lattice;
    double uvw[3];
    double xyz[3];
    double rest[3];
    double det;
} ffd_fold_witness;
typedef struct ffd_folds {
    size_t struct_size;
    bool is_known;
    ffd_fold_verdict verdict;
    uint64_t cells;
    uint64_t folded_cells;
    uint64_t unknown_cells;
    double min_det;
    ffd_fold_reference relative_to;
    ffd_fold_witness witness;
} ffd_folds;
ffd_status ffd_folds_find(const ffd_lattice *lattice, int threads, ffd_folds *folds, ffd_error *error);
typedef struct ffd_barrier {
    size_t struct_size;
    double least;
    double value;
} ffd_barrier;
ffd_status ffd_folds_barrier(const ffd_lattice *lattice, const double *deformed, double floor,
                             const double *uvw, size_t count, int threads, ffd_barrier *barrier,
                             double *gradient, ffd_error *error);
typedef struct ffd_bounds {
    double min[3], max[3];
} ffd_bounds;
typedef struct ffd_max_rms {
    double max, rms;
} ffd_max_rms;
typedef struct ffd_before_after {
    double before, after;
} ffd_before_after;
typedef struct ffd_morph_target_figures {
    uint64_t outside;
    uint64_t shown_outside, base_outside;
    uint64_t invalid;
    uint64_t room[2];
} ffd_morph_target_figures;
typedef struct ffd_shared_face_figures {
    uint64_t moved_twice;
    uint64_t disagreeing;
    double largest;
    uint64_t room[2];
} ffd_shared_face_figures;
typedef struct ffd_iteration_figures {
    double mean;
    uint64_t max;
} ffd_iteration_figures;
typedef enum ffd_tear_cause {
    FFD_TEAR_NONE = 0,
    FFD_TEAR_STAYS,
    FFD_TEAR_UNSELECTED,
    FFD_TEAR_LATTICES,
    FFD_TEAR_BLOCKS,
    FFD_TEAR_SEAM,
    FFD_TEAR_AXIS,
    FFD_TEAR_BORDER,
    FFD_TEAR_OVERLAP,
    FFD_TEAR_WEIGHTS,
    FFD_TEAR_RIGID
} ffd_tear_cause;
typedef struct ffd_tear_figures {
    bool is_known;
    uint64_t edges;
    double largest;
    uint64_t vertex;
    char part[256];
    uint64_t stays;
    ffd_tear_cause cause;
    uint64_t room[4];
} ffd_tear_figures;
typedef struct ffd_det_figures {
    bool is_known;
    double min, max;
    double outside;
    uint64_t outside_vertex;
    uint64_t room[2];
} ffd_det_figures;
typedef struct ffd_deviation {
    double max, mean;
} ffd_deviation;
typedef struct ffd_edge_figures {
    bool is_known;
    uint64_t count;
    ffd_deviation deviation;
    uint64_t room[2];
} ffd_edge_figures;
typedef struct ffd_skin_weight_figures {
    uint64_t off;
    double farthest;
    uint64_t none;
    uint64_t room[2];
} ffd_skin_weight_figures;
typedef struct ffd_precision_figures {
    double error;
    double side;
    uint64_t room[2];
} ffd_precision_figures;
typedef struct ffd_splat_figures {
    uint64_t carried;
    uint64_t flattened;
    uint64_t broken;
    uint64_t room[2];
} ffd_splat_figures;
typedef struct ffd_bounds_figures {
    ffd_bounds before, after;
} ffd_bounds_figures;
typedef enum ffd_behind_kind {
    FFD_BEHIND_SOCKET = 0,
    FFD_BEHIND_CAMERA,
    FFD_BEHIND_LIGHT,
    FFD_BEHIND_JOINT,
    FFD_BEHIND_PIVOT,
    FFD_BEHIND_PHYSICS_SHAPE,
    FFD_BEHIND_SPLAT,
    FFD_BEHIND_KIND_COUNT
} ffd_behind_kind;
const char *ffd_behind_kind_name(ffd_behind_kind kind);
typedef struct ffd_behind {
    uint64_t count;
    char names[3][80];
} ffd_behind;
typedef struct ffd_rig_figures {
    bool is_there;
    uint64_t joints;
    uint64_t moved;
    uint64_t sheared;
    uint64_t singular;
    uint64_t partial;
    uint64_t unscaled;
    double largest_lag;
    char worst[80];
    uint64_t lagging_skins, lagging_pivots, lagging_sockets;
    uint64_t lagging_joints;
    uint64_t unselected;
    double unselected_by;
    uint64_t room[4];
} ffd_rig_figures;
typedef struct ffd_flaw {
    char message[256];
    char pointer[128];
    uint64_t line;
    uint64_t count;
} ffd_flaw;
typedef struct ffd_morph_results {
    size_t count;
    const char *const *names;
    const ffd_lattice_source *lattices;
    const struct ffd_job_result *results;
} ffd_morph_results;
typedef enum ffd_seam { FFD_SEAM_NONE = 0, FFD_SEAM_C0, FFD_SEAM_C1, FFD_SEAM_C2 } ffd_seam;
const char *ffd_seam_name(ffd_seam seam);
typedef struct ffd_seam_figures {
    bool is_there;
    ffd_seam continuity;
    uint64_t count;
    uint8_t faces[1024];
} ffd_seam_figures;
typedef struct ffd_seconds {
    double read, embed, deform, judge, write;
    uint64_t room[2];
} ffd_seconds;
typedef struct ffd_weight_figures {
    bool is_there;
    uint64_t zero, one;
    uint64_t clamped;
    double mean;
    uint64_t room[2];
} ffd_weight_figures;
typedef struct ffd_rigid_part {
    char part[128];
    uint64_t pieces;
    double rotation;
    double scale;
    double distance;
} ffd_rigid_part;
typedef struct ffd_rigid_figures {
    uint64_t count;
    ffd_rigid_part parts[64];
} ffd_rigid_figures;
typedef struct ffd_count_before_after {
    uint64_t before, after;
} ffd_count_before_after;
typedef struct ffd_cell_figures {
    bool is_there;
    uint64_t count;
    ffd_count_before_after inverted;
    uint64_t by_deformation;
    uint64_t unknown;
    ffd_before_after scaled_jacobian;
    bool has_worst;
    uint64_t worst;
    uint64_t room[4];
} ffd_cell_figures;
typedef struct ffd_output_list ffd_output_list;
typedef struct ffd_job_result {
    size_t struct_size;
    ffd_status status;
    ffd_error error;
    uint64_t vertices;
    uint64_t counts[5];
    uint64_t unused, hidden;
    ffd_morph_target_figures morph_targets;
    uint64_t moved;
    ffd_shared_face_figures shared_faces;
    ffd_max_rms residual;
    ffd_iteration_figures iterations;
    ffd_folds folds;
    uint64_t folds_room[8];
    bool has_flipped;
    uint64_t faces, flipped_faces;
    ffd_tear_figures tear;
    ffd_before_after volume;
    ffd_before_after area;
    ffd_det_figures det;
    ffd_edge_figures edges;
    ffd_skin_weight_figures skin_weights;
    ffd_precision_figures precision;
    ffd_splat_figures splats;
    ffd_bounds_figures bounds;
    ffd_max_rms displacement;
    ffd_behind behind[FFD_BEHIND_KIND_COUNT];
    ffd_behind behind_room[5];
    ffd_rig_figures rig;
    ffd_morph_results morphs;
    uint64_t indices_left;
    uint64_t bytes_left;
    uint64_t bounds_left;
    ffd_flaw flaws[8];
    uint64_t flaw_count;
    ffd_seconds seconds;
    const char *picture;
    bool own_box;
    uint64_t normals_collapsed;
    uint64_t normals_carried;
    uint64_t transforms_singular;
    const ffd_output_list *outputs;
    const char *page;
    const char *own_frame;
    ffd_weight_figures weight;
    ffd_seam_figures seam;
    ffd_rigid_figures rigid;
    ffd_cell_figures cells;
} ffd_job_result;
typedef enum ffd_format {
    FFD_FORMAT_AUTO = 0,
    FFD_FORMAT_OBJ,
    FFD_FORMAT_GLTF,
    FFD_FORMAT_GLB,
    FFD_FORMAT_PLY,
    FFD_FORMAT_OFF,
    FFD_FORMAT_STL,
    FFD_FORMAT_VTK,
    FFD_FORMAT_SU2,
    FFD_FORMAT_VTU,
    FFD_FORMAT_VTP,
    FFD_FORMAT_VTS,
    FFD_FORMAT_MSH,
    FFD_FORMAT_FOAM
} ffd_format;
ffd_format ffd_format_from_name(const char *name);
ffd_status ffd_format_check_name(const char *name, ffd_error *error);
typedef enum ffd_normals { FFD_NORMALS_TRANSFORM = 0, FFD_NORMALS_KEEP, FFD_NORMALS_RECOMPUTE } ffd_normals;
typedef enum ffd_space { FFD_SPACE_SCENE = 0, FFD_SPACE_MESH } ffd_space;
typedef enum ffd_rig { FFD_RIG_KEEP = 0, FFD_RIG_FOLLOW } ffd_rig;
typedef enum ffd_resources {
    FFD_RESOURCES_COPY = 0,
    FFD_RESOURCES_REFERENCE,
    FFD_RESOURCES_REFRESH
} ffd_resources;
typedef enum ffd_gate {
    FFD_GATE_FOLDS = 1,
    FFD_GATE_OUTSIDE = 2,
    FFD_GATE_MULTIPLE = 4,
    FFD_GATE_SINGULAR = 8,
    FFD_GATE_INVALID = 16,
    FFD_GATE_TEAR = 32,
    FFD_GATE_FLIPPED = 64,
    FFD_GATE_EDGES = 128,
    FFD_GATE_INVERTED = 256,
    FFD_GATE_QUALITY = 512
} ffd_gate;
typedef enum ffd_log_level { FFD_LOG_WARNING = 0, FFD_LOG_INFO, FFD_LOG_DETAIL } ffd_log_level;
typedef void (*ffd_log_function)(void *user, ffd_log_level level, const char *line);
ffd_status ffd_restore_output(const char *path, ffd_error *error);
typedef ffd_status (*ffd_resolve_function)(void *user, const char *name, ffd_bytes *bytes);
typedef ffd_status (*ffd_sink_function)(void *user, const char *name, const void *bytes, size_t size);
typedef ffd_status (*ffd_positions_function)(void *user, const double *positions, size_t count);
typedef struct ffd_source {
    const char *path;
    ffd_format format;
    ffd_space space;
    uint64_t memory;
    int threads;
    bool only_positions;
    bool strict;
    const char *const *allow_extensions;
    size_t allow_extension_count;
    ffd_bytes bytes;
    ffd_resolve_function resolve;
    void *resolve_user;
    uint64_t source_room[4];
} ffd_source;
ffd_status ffd_selector_check(const char *text, ffd_error *error);
ffd_status ffd_clip_check(const char *text, ffd_error *error);
typedef struct ffd_output_set ffd_output_set;
ffd_status ffd_output_set_create(ffd_output_set **output_set, ffd_error *error);
void ffd_output_set_destroy(ffd_output_set **output_set);
typedef struct ffd_job_cache ffd_job_cache;
ffd_status ffd_job_cache_create(ffd_job_cache **cache, ffd_error *error);
ffd_status ffd_job_cache_create_for_lattices(ffd_job_cache **cache, ffd_error *error);
void ffd_job_cache_destroy(ffd_job_cache **cache);
typedef struct ffd_shared_box ffd_shared_box;
ffd_status ffd_shared_box_create(ffd_shared_box **box, ffd_error *error);
void ffd_shared_box_destroy(ffd_shared_box **box);
typedef struct ffd_depfile ffd_depfile;
ffd_status ffd_depfile_create(const char *path, ffd_depfile **depfile, ffd_error *error);
void ffd_depfile_destroy(ffd_depfile **depfile);
ffd_status ffd_depfile_write(ffd_depfile *depfile, ffd_error *error);
ffd_status ffd_output_list_create(ffd_output_list **list, ffd_error *error);
void ffd_output_list_destroy(ffd_output_list **list);
size_t ffd_output_list_count(const ffd_output_list *list);
const char *ffd_output_list_name(const ffd_output_list *list, size_t index);
typedef struct ffd_embedding_source {
    const char *path;
    ffd_bytes bytes;
} ffd_embedding_source;
typedef struct ffd_weight_source {
    const char *source;
    ffd_bytes bytes;
} ffd_weight_source;
ffd_status ffd_weight_check(const char *text, ffd_error *error);
const char *ffd_weight_file(const char *text);
typedef struct ffd_deform_desc {
    size_t struct_size;
    ffd_source input;
    const char *output;
    ffd_format output_format;
    const ffd_lattice_source *lattices;
    size_t lattice_count;
    bool blocks;
    const ffd_setting *set;
    size_t set_count;
    ffd_outside outside;
    double falloff;
    double snap;
    bool snap_relative;
    ffd_embedding_source embedding;
    unsigned fail_on;
    double tear_most;
    uint64_t flipped_most;
    double edges_most;
    bool quality;
    ffd_normals normals;
    ffd_rig rig;
    const char *as_morph;
    const char *const *morphs;
    const char *const *clips;
    size_t clip_count;
    struct ffd_job_result *morph_results;
    const char *const *only;
    size_t only_count;
    ffd_resources resources;
    int threads;
    ffd_isa isa;
    bool force;
    bool if_changed;
    bool in_place;
    bool dry_run;
    ffd_output_set *output_set;
    ffd_job_cache *cache;
    const ffd_shared_box *shared_box;
    ffd_depfile *depfile;
    ffd_log_function log;
    void *log_user;
    ffd_sink_function sink;
    void *sink_user;
    ffd_positions_function positions;
    void *positions_user;
    double timeout;
    bool make_folders;
    ffd_output_list *output_list;
    bool (*progress)(void *user, double done);
    void *progress_user;
    const int *cancel;
    double time;
    bool has_time;
    ffd_weight_source weight;
    ffd_seam seam;
    unsigned seam_faces;
    const char *const *rigid;
    size_t rigid_count;
    const char *const *uniform;
    size_t uniform_count;
    uint64_t inverted_most;
    double quality_least;
} ffd_deform_desc;
void ffd_deform_desc_init(ffd_deform_desc *desc, size_t size);
ffd_status ffd_shared_box_add(ffd_shared_box *box, const ffd_deform_desc *desc, ffd_error *error);
ffd_status ffd_deform_check_many(const ffd_deform_desc *job, const char *const *inputs,
                                 const char *const *outputs, size_t count, ffd_error *error);
ffd_status ffd_deform_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);
ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error);
typedef enum ffd_view_color {
    FFD_VIEW_DISPLACEMENT = 0,
    FFD_VIEW_STATUS,
    FFD_VIEW_DET,
    FFD_VIEW_PLAIN,
    FFD_VIEW_AUTO
} ffd_view_color;
const char *ffd_view_color_name(ffd_view_color color);
typedef enum ffd_up { FFD_UP_Y = 0, FFD_UP_Z, FFD_UP_X } ffd_up;
ffd_status ffd_view_camera(const char *name, ffd_up up, double direction[3]);
typedef struct ffd_view_desc {
    size_t struct_size;
    const ffd_deform_desc *job;
    const ffd_source *deformed;
    const char *output;
    bool force;
    double camera[3];
    ffd_view_color color;
    bool full;
    uint32_t width, height;
    uint32_t frames;
    const char *animation;
    bool as_stored;
    ffd_sink_function sink;
    void *sink_user;
    ffd_up up;
    bool no_cage;
} ffd_view_desc;
void ffd_view_desc_init(ffd_view_desc *desc, size_t size);
ffd_status ffd_view_run(const ffd_view_desc *desc, ffd_job_result *result, ffd_error *error);
typedef struct ffd_edit_desc {
    size_t struct_size;
    const ffd_deform_desc *job;
    const ffd_lattice_desc *lattice;
    const char *output;
    bool force;
    bool full;
    ffd_up up;
    ffd_sink_function sink;
    void *sink_user;
} ffd_edit_desc;
void ffd_edit_desc_init(ffd_edit_desc *desc, size_t size);
ffd_status ffd_edit_run(const ffd_edit_desc *desc, ffd_job_result *result, ffd_error *error);
typedef struct ffd_embed_desc {
    size_t struct_size;
    ffd_source input;
    ffd_lattice_source lattice;
    const char *output;
    const char *status_output;
    double snap;
    bool snap_relative;
    int threads;
    bool force;
    ffd_log_function log;
    void *log_user;
    const ffd_setting *set;
    size_t set_count;
    ffd_sink_function sink;
    void *sink_user;
} ffd_embed_desc;
void ffd_embed_desc_init(ffd_embed_desc *desc, size_t size);
ffd_status ffd_embed_run(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error);
typedef enum ffd_difference_kind {
    FFD_DIFFERENCE_POSITION = 0,
    FFD_DIFFERENCE_NORMAL,
    FFD_DIFFERENCE_TANGENT,
    FFD_DIFFERENCE_TEXCOORD,
    FFD_DIFFERENCE_TOPOLOGY,
    FFD_DIFFERENCE_OTHER,
    FFD_DIFFERENCE_KIND_COUNT
} ffd_difference_kind;
const char *ffd_difference_kind_name(ffd_difference_kind kind);
typedef struct ffd_difference {
    ffd_difference_kind kind;
    bool measured;
    double a, b;
    double amount;
    char text[512];
} ffd_difference;
typedef struct ffd_comparison {
    size_t struct_size;
    bool equal;
    bool complete;
    uint64_t differences;
    uint64_t counts[FFD_DIFFERENCE_KIND_COUNT];
    ffd_difference first;
    ffd_difference worst;
    uint64_t positions_compared;
    double position_difference_max;
    double direction_difference_max;
    double tolerance;
    double direction_tolerance;
    double diagonal;
} ffd_comparison;
typedef struct ffd_compare_desc {
    size_t struct_size;
    ffd_source a, b;
    double tolerance;
    bool relative;
    double direction_tolerance;
    ffd_log_function log;
    void *log_user;
} ffd_compare_desc;
void ffd_compare_desc_init(ffd_compare_desc *desc, size_t size);
ffd_status ffd_compare_run(const ffd_compare_desc *desc, ffd_comparison *comparison, ffd_error *error);
ffd_status ffd_comparison_json(const ffd_comparison *comparison, const char *a, const char *b, char **text,
                               ffd_error *error);
typedef struct ffd_compared_file {
    const char *name;
    bool in_a, in_b;
    const ffd_comparison *comparison;
    const ffd_error *error;
} ffd_compared_file;
typedef ffd_status (*ffd_compared_function)(void *user, const ffd_compared_file *file);
typedef struct ffd_folder_comparison {
    size_t struct_size;
    bool equal;
    uint64_t same, different, failed, only_a, only_b;
} ffd_folder_comparison;
ffd_status ffd_compare_folders(const ffd_compare_desc *desc, ffd_compared_function file, void *user,
                               ffd_folder_comparison *result, ffd_error *error);
ffd_status ffd_compare_folders_json(const ffd_compare_desc *desc, ffd_folder_comparison *result, char **text,
                                    ffd_error *error);
typedef struct ffd_info_desc {
    size_t struct_size;
    ffd_source file;
    bool json;
    bool parts;
    const ffd_setting *set;
    size_t set_count;
    ffd_log_function log;
    void *log_user;
} ffd_info_desc;
void ffd_info_desc_init(ffd_info_desc *desc, size_t size);
ffd_status ffd_info_run(const ffd_info_desc *desc, char **text, ffd_error *error);
typedef struct ffd_lattice_new_desc {
    size_t struct_size;
    const ffd_source *meshes;
    size_t mesh_count;
    const char *const *only;
    size_t only_count;
    const ffd_lattice_desc *lattice;
    const char *output;
    bool force;
    ffd_log_function log;
    void *log_user;
    ffd_sink_function sink;
    void *sink_user;
} ffd_lattice_new_desc;
void ffd_lattice_new_desc_init(ffd_lattice_new_desc *desc, size_t size);
ffd_status ffd_lattice_new_run(const ffd_lattice_new_desc *desc, ffd_error *error);
typedef struct ffd_author_desc {
    size_t struct_size;
    ffd_lattice_source lattice;
    const ffd_setting *set;
    size_t set_count;
    double time;
    bool has_time;
    const ffd_source *meshes;
    size_t mesh_count;
    const char *const *only;
    size_t only_count;
    ffd_source reading;
    int threads;
    const char *output;
    bool force;
    ffd_output_set *output_set;
    ffd_log_function log;
    void *log_user;
    ffd_sink_function sink;
    void *sink_user;
} ffd_author_desc;
void ffd_author_desc_init(ffd_author_desc *desc, size_t size);
typedef struct ffd_refine_seconds {
    double read, refine, write;
} ffd_refine_seconds;
typedef struct ffd_refine_result {
    size_t struct_size;
    ffd_status status;
    ffd_error error;
    ffd_refine_seconds seconds;
    size_t size_before[3], size[3];
    int degree_before[3], degree[3];
    double largest_difference;
} ffd_refine_result;
ffd_status ffd_lattice_refine_run(const ffd_author_desc *job, const ffd_refine_desc *refine,
                                  ffd_refine_result *result, ffd_error *error);
typedef enum ffd_lattice_part {
    FFD_PART_DEFAULT,
    FFD_PART_BOTH,
    FFD_PART_REST,
    FFD_PART_DEFORMED
} ffd_lattice_part;
typedef enum ffd_point_order { FFD_ORDER_UVW, FFD_ORDER_AUTO, FFD_ORDER_DEFAULT } ffd_point_order;
typedef struct ffd_convert_desc {
    size_t struct_size;
    size_t size[3];
    int degree[3];
    ffd_lattice_part part;
    ffd_point_order order;
    const char *block;
} ffd_convert_desc;
void ffd_convert_desc_init(ffd_convert_desc *desc, size_t size);
bool ffd_lattice_converts(const char *name);
ffd_status ffd_lattice_convert_run(const ffd_author_desc *job, const ffd_convert_desc *convert,
                                   ffd_error *error);
typedef enum ffd_operation_kind {
    FFD_OPERATION_STRENGTH,
    FFD_OPERATION_BLEND,
    FFD_OPERATION_ADD,
    FFD_OPERATION_MIRROR,
    FFD_OPERATION_SYMMETRIZE,
    FFD_OPERATION_TRANSFORM,
    FFD_OPERATION_MOVE,
    FFD_OPERATION_ROTATE,
    FFD_OPERATION_SCALE,
    FFD_OPERATION_INVERT,
    FFD_OPERATION_SEAL,
    FFD_OPERATION_DEFORMED,
    FFD_OPERATION_DEFORMED_OFFSETS
} ffd_operation_kind;
typedef struct ffd_operation {
    ffd_operation_kind kind;
    double number;
    int direction;
    bool keep_last;
    double place[3], matrix[16];
    int continuity;
    unsigned faces;
    ffd_lattice_source other;
    const char *block;
} ffd_operation;
ffd_status ffd_lattice_set_run(const ffd_author_desc *job, const ffd_operation *operations, size_t count,
                               ffd_error *error);
ffd_status ffd_job_result_text(const ffd_job_result *result, const char *lattice, char **text,
                               ffd_error *error);
typedef struct ffd_report ffd_report;
ffd_status ffd_report_create(const char *path, bool stable, ffd_output_set *output_set, ffd_report **report,
                             ffd_error *error);
ffd_status ffd_report_create_sink(const char *name, bool stable, ffd_sink_function sink, void *user,
                                  ffd_report **report, ffd_error *error);
void ffd_report_destroy(ffd_report **report);
ffd_status ffd_report_add(ffd_report *report, const char *input, const char *output,
                          const ffd_job_result *result, ffd_error *error);
ffd_status ffd_report_add_refine(ffd_report *report, const char *input, const char *output,
                                 const ffd_refine_result *result, ffd_error *error);
ffd_status ffd_report_write(ffd_report *report, ffd_error *error);
ffd_status ffd_report_merge_run(const char *const *reports, size_t count, bool interleave, const char *output,
                                bool force, ffd_error *error);
ffd_status ffd_report_junit_run(const char *const *reports, size_t count, const char *output, bool force,
                                ffd_error *error);
typedef enum ffd_animate_targets {
    FFD_TARGETS_AUTO = 0,
    FFD_TARGETS_KEYS,
    FFD_TARGETS_COUNT
} ffd_animate_targets;
typedef struct ffd_animate_desc {
    size_t struct_size;
    const ffd_deform_desc *job;
    const char *name;
    double tolerance;
    bool relative;
    ffd_animate_targets targets;
    size_t count;
    double frames_per_second;
} ffd_animate_desc;
void ffd_animate_desc_init(ffd_animate_desc *desc, size_t size);
typedef struct ffd_animate_seconds {
    double read, plan, deform, write;
} ffd_animate_seconds;
typedef struct ffd_animate_result {
    size_t struct_size;
    ffd_status status;
    ffd_error error;
    ffd_animate_seconds seconds;
    uint64_t vertices, inside, outside, multiple, singular, invalid;
    char name[256];
    uint64_t targets;
    uint64_t keys;
    uint64_t samples;
    double tolerance;
    double bound;
    double largest_weight;
    uint64_t bytes;
    const ffd_output_list *outputs;
} ffd_animate_result;
ffd_status ffd_animate_run(const ffd_animate_desc *desc, ffd_animate_result *result, ffd_error *error);
ffd_status ffd_report_add_animation(ffd_report *report, const char *input, const char *output,
                                    const ffd_animate_result *result, ffd_error *error);
typedef ffd_status (*ffd_batch_next_function)(void *user, uint64_t index, const char **line);
typedef struct ffd_batch_job {
    uint64_t line;
    uint64_t row;
    const char *input;
    const char *output;
    bool skipped;
    const char *log;
    const ffd_job_result *result;
} ffd_batch_job;
typedef void (*ffd_batch_ended_function)(void *user, const ffd_batch_job *job);
typedef struct ffd_batch_desc {
    size_t struct_size;
    const char *manifest;
    const char *csv;
    const char *in;
    ffd_batch_next_function next;
    void *next_user;
    bool repeats;
    const char *csv_ignore;
    const char *out_dir;
    const ffd_deform_desc *defaults;
    const char *output_ending;
    int workers;
    double timeout;
    uint64_t shard, shards;
    bool resume;
    const char *journal;
    const char *positions;
    bool positions_double;
    const char *view;
    const char *report;
    bool report_stable;
    const char *depfile;
    bool shared_box;
    bool dry_run;
    bool stop;
    ffd_batch_ended_function ended;
    void *ended_user;
    bool (*progress)(void *user, double done);
    void *progress_user;
    ffd_log_function log;
    void *log_user;
    bool quiet;
    bool verbose;
    bool is_program;
    const int *cancel;
    const ffd_view_desc *look;
    bool pages;
} ffd_batch_desc;
void ffd_batch_desc_init(ffd_batch_desc *desc, size_t size);
ffd_status ffd_batch_desc_check(const ffd_batch_desc *desc, ffd_error *error);
typedef struct ffd_batch_result {
    size_t struct_size;
    uint64_t done, skipped, failed;
    bool is_complete;
} ffd_batch_result;
ffd_status ffd_batch_run(const ffd_batch_desc *desc, ffd_batch_result *result, ffd_error *error);
typedef enum ffd_number { FFD_FLOAT64 = 0, FFD_FLOAT32 } ffd_number;
typedef struct ffd_span {
    void *data;
    size_t count;
    ffd_number type;
    ptrdiff_t stride;
    ptrdiff_t step;
} ffd_span;
typedef struct ffd_run_options {
    size_t struct_size;
    int threads;
    ffd_isa isa;
    bool (*progress)(void *user, double done);
    void *user;
} ffd_run_options;
void ffd_run_options_init(ffd_run_options *options, size_t size);
typedef struct ffd_embedding_desc {
    size_t struct_size;
    const ffd_lattice *lattice;
    ffd_span points;
    ffd_outside outside;
    double falloff;
    double snap;
} ffd_embedding_desc;
void ffd_embedding_desc_init(ffd_embedding_desc *desc, size_t size);
typedef struct ffd_embedding ffd_embedding;
ffd_status ffd_embedding_create(const ffd_embedding_desc *desc, const ffd_run_options *options,
                                ffd_embedding **embedding, ffd_error *error);
void ffd_embedding_destroy(ffd_embedding **embedding);
size_t ffd_embedding_get_count(const ffd_embedding *embedding);
const double *ffd_embedding_get_uvw(const ffd_embedding *embedding);
const uint8_t *ffd_embedding_get_status(const ffd_embedding *embedding);
ffd_status ffd_embedding_deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in,
                                ffd_span out, double *gradients, const ffd_run_options *options,
                                ffd_error *error);
ffd_status ffd_embedding_deform_some(const ffd_embedding *embedding, const ffd_lattice *moved,
                                     const uint32_t *vertices, size_t count, ffd_span in, ffd_span out,
                                     double *gradients, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_deform_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                         const double *weights, const double *slopes, ffd_span in,
                                         ffd_span out, double *gradients, const ffd_run_options *options,
                                         ffd_error *error);
ffd_status ffd_embedding_deform_some_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                              const uint32_t *vertices, size_t count, const double *weights,
                                              const double *slopes, ffd_span in, ffd_span out,
                                              double *gradients, const ffd_run_options *options,
                                              ffd_error *error);
ffd_status ffd_embedding_deform_many(const ffd_embedding *embedding, size_t rows, const double *offsets,
                                     ffd_span in, ffd_span out, const ffd_run_options *options,
                                     ffd_error *error);
typedef struct ffd_variants {
    size_t struct_size;
    size_t count;
    const double *values;
    bool are_points;
    bool w_fastest;
    const double *control_weights;
    const double *weights;
} ffd_variants;
void ffd_variants_init(ffd_variants *variants, size_t size);
ffd_status ffd_embedding_deform_variants(const ffd_embedding *embedding, const ffd_variants *variants,
                                         ffd_span in, ffd_span out, const ffd_run_options *options,
                                         ffd_error *error);
ffd_status ffd_weight_slopes(ffd_span points, const double *weights, const uint32_t *triangles, size_t count,
                             double *slopes, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_affected(const ffd_embedding *embedding, const size_t *control_points, size_t count,
                                  uint32_t **vertices, size_t *vertex_count, ffd_error *error);
typedef struct ffd_csr {
    size_t rows, columns;
    size_t *starts;
    uint32_t *indices;
    double *values;
} ffd_csr;
ffd_status ffd_embedding_basis(const ffd_embedding *embedding, const double *weights, ffd_csr *matrix,
                               const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_basis_ordered(const ffd_embedding *embedding, const double *weights, bool w_fastest,
                                       ffd_csr *matrix, const ffd_run_options *options, ffd_error *error);
void ffd_csr_free(ffd_csr *matrix);
ffd_status ffd_embedding_basis_times(const ffd_embedding *embedding, const double *weights, const double *dq,
                                     double *dx, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_basis_transposed(const ffd_embedding *embedding, const double *weights,
                                          const double *dfdx, double *dfdq, const ffd_run_options *options,
                                          ffd_error *error);
ffd_status ffd_embedding_weights(const ffd_embedding *embedding, const ffd_lattice *moved, bool w_fastest,
                                 double *jacobian, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_weights_times(const ffd_embedding *embedding, const ffd_lattice *moved,
                                       const double *dw, double *dx, const ffd_run_options *options,
                                       ffd_error *error);
ffd_status ffd_embedding_weights_transposed(const ffd_embedding *embedding, const ffd_lattice *moved,
                                            const double *dfdx, double *dfdw, const ffd_run_options *options,
                                            ffd_error *error);
ffd_status ffd_embedding_parameters(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                    double *jacobian, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_parameters_times(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                          const double *dp, double *dx, const ffd_run_options *options,
                                          ffd_error *error);
ffd_status ffd_embedding_parameters_transposed(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                               const double *dfdx, double *dfdp,
                                               const ffd_run_options *options, ffd_error *error);
ffd_status ffd_embedding_save(const ffd_embedding *embedding, void **bytes, size_t *size, ffd_error *error);
ffd_status ffd_embedding_load(const void *bytes, size_t size, const ffd_lattice *lattice,
                              ffd_embedding **embedding, ffd_error *error);
ffd_status ffd_normals_deform(const double *gradients, ffd_span in, ffd_span out, size_t *collapsed,
                              const ffd_run_options *options, ffd_error *error);
ffd_status ffd_tangents_deform(const double *gradients, ffd_span normals, ffd_span in, ffd_span out,
                               size_t *collapsed, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_lattice_evaluate_many(const ffd_lattice *lattice, ffd_volume volume, const double *uvw,
                                     size_t count, double *xyz, double *jacobians,
                                     const ffd_run_options *options, ffd_error *error);
typedef struct ffd_cells_desc {
    size_t struct_size;
    ffd_span points;
    const char *kind;
    const uint32_t *cells;
    size_t count;
    const uint64_t *offsets;
    uint8_t *inverted;
    uint8_t *unknown;
    double *jacobian;
    double *scaled_jacobian;
} ffd_cells_desc;
int ffd_cells_kind_points(const char *kind);
void ffd_cells_desc_init(ffd_cells_desc *desc, size_t size);
ffd_status ffd_cells_measure(const ffd_cells_desc *desc, const ffd_run_options *options, ffd_error *error);
typedef struct ffd_chain_embedding ffd_chain_embedding;
typedef struct ffd_chain_desc {
    size_t struct_size;
    const ffd_lattice *const *lattices;
    size_t count;
    bool blocks;
    ffd_span points;
    ffd_outside outside;
    double falloff, snap;
    const ffd_chain_embedding *start;
} ffd_chain_desc;
void ffd_chain_desc_init(ffd_chain_desc *desc, size_t size);
ffd_status ffd_chain_embedding_create(const ffd_chain_desc *desc, const ffd_run_options *options,
                                      ffd_chain_embedding **embedding, ffd_error *error);
void ffd_chain_embedding_destroy(ffd_chain_embedding **embedding);
size_t ffd_chain_embedding_get_count(const ffd_chain_embedding *embedding);
const double *ffd_chain_embedding_get_uvw(const ffd_chain_embedding *embedding);
const uint8_t *ffd_chain_embedding_get_status(const ffd_chain_embedding *embedding);
const uint32_t *ffd_chain_embedding_get_blocks(const ffd_chain_embedding *embedding);
size_t ffd_chain_embedding_get_overlaps(const ffd_chain_embedding *embedding, size_t pair[2]);
ffd_status ffd_chain_embedding_bounds(const ffd_chain_embedding *embedding, ffd_span points, double min[3],
                                      double max[3], const ffd_run_options *options, ffd_error *error);
typedef struct ffd_chain_deform_desc {
    size_t struct_size;
    const ffd_lattice *const *moved;
    ffd_span in;
    ffd_span out;
    double *gradients;
    const double *weights;
    const double *slopes;
    const uint32_t *vertices;
    size_t vertex_count;
} ffd_chain_deform_desc;
void ffd_chain_deform_desc_init(ffd_chain_deform_desc *desc, size_t size);
ffd_status ffd_chain_embedding_deform(const ffd_chain_embedding *embedding, const ffd_chain_deform_desc *desc,
                                      const ffd_run_options *options, ffd_error *error);
ffd_status ffd_chain_embedding_basis_times(const ffd_chain_embedding *embedding, const double *const *dq,
                                           double *dx, const ffd_run_options *options, ffd_error *error);
ffd_status ffd_chain_embedding_basis_transposed(const ffd_chain_embedding *embedding, const double *dfdx,
                                                double *const *dfdq, const ffd_run_options *options,
                                                ffd_error *error);
int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3], double gradient[9]);
typedef enum ffd_direction_outcome {
    FFD_DIRECTION_KEPT = 0,
    FFD_DIRECTION_CARRIED,
    FFD_DIRECTION_COLLAPSED,
    FFD_DIRECTION_OUTCOMES
} ffd_direction_outcome;
ffd_direction_outcome ffd_deform_normal(const double gradient[9], const double normal[3], double result[3]);
ffd_direction_outcome ffd_deform_tangent(const double gradient[9], const double tangent[3],
                                         const double normal[3], double result[3]);
typedef enum ffd_fit_smoothing { FFD_FIT_AUTO = 0, FFD_FIT_GIVEN, FFD_FIT_WITHIN } ffd_fit_smoothing;
typedef struct ffd_fit_desc {
    size_t struct_size;
    const ffd_lattice *base;
    ffd_span source, target;
    const double *weights;
    const size_t *exact;
    size_t exact_count;
    bool handles;
    bool robust;
    int symmetric;
    ffd_fit_smoothing smoothing;
    double smooth;
    double within;
    double snap;
    size_t numbered_from;
} ffd_fit_desc;
void ffd_fit_desc_init(ffd_fit_desc *desc, size_t size);
typedef enum ffd_fit_choice {
    FFD_FIT_BY_GCV = 0,
    FFD_FIT_BY_DEFAULT,
    FFD_FIT_BY_WITHIN,
    FFD_FIT_BY_CALLER,
    FFD_FIT_BY_FOLDS
} ffd_fit_choice;
const char *ffd_fit_choice_name(ffd_fit_choice choice);
typedef struct ffd_fit_result {
    size_t struct_size;
    uint64_t pairs, used;
    uint64_t outside, multiple, singular;
    uint64_t exact, dependent;
    double smooth;
    ffd_fit_choice smooth_chosen_by;
    double gcv;
    double affine[12];
    double residual_max, residual_rms, residual_p95;
    uint64_t worst;
    double residual_exact;
    double largest_offset;
    uint64_t points_without_data;
    uint64_t downweighted;
    uint64_t spread_positions;
    double spread_largest;
    uint64_t flops;
    ffd_folds folds;
} ffd_fit_result;
ffd_status ffd_fit_points(const ffd_fit_desc *desc, const ffd_run_options *options, ffd_lattice **lattice,
                          double *residuals, ffd_fit_result *result, ffd_error *error);
typedef struct ffd_fit_job {
    size_t struct_size;
    const ffd_author_desc *job;
    const ffd_source *before;
    const ffd_source *after;
    const char *pairs;
    ffd_bytes pairs_bytes;
    const ffd_source *cover;
    size_t cover_count;
    const ffd_lattice_desc *lattice;
    const char *weights;
    ffd_bytes weights_bytes;
    bool handles, robust;
    int symmetric;
    ffd_fit_smoothing smoothing;
    double smooth, within;
    bool within_relative;
    double snap;
    bool snap_relative;
    unsigned fail_on;
    ffd_isa isa;
    double timeout;
    bool (*progress)(void *user, double done);
    void *progress_user;
} ffd_fit_job;
void ffd_fit_job_init(ffd_fit_job *job, size_t size);
typedef struct ffd_fit_seconds {
    double read, fit, write;
} ffd_fit_seconds;
typedef struct ffd_fit_job_result {
    size_t struct_size;
    ffd_status status;
    ffd_error error;
    ffd_fit_seconds seconds;
    bool is_fitted;
    bool robust;
    bool has_rows;
    ffd_fit_result fit;
} ffd_fit_job_result;
ffd_status ffd_fit_run(const ffd_fit_job *job, ffd_fit_job_result *result, ffd_error *error);
ffd_status ffd_report_add_fit(ffd_report *report, const char *input, const char *output,
                              const ffd_fit_job_result *result, ffd_error *error);
ffd_status ffd_fit_text(const ffd_fit_job_result *result, char **text, ffd_error *error);
typedef enum ffd_jacobian_by { FFD_BY_POINTS = 0, FFD_BY_PARAMETERS } ffd_jacobian_by;
typedef struct ffd_jacobian_desc {
    size_t struct_size;
    const ffd_deform_desc *job;
    const char *output;
    ffd_jacobian_by by;
    bool components;
    size_t of;
    const char *times, *transposed;
    bool check;
    ffd_bytes times_bytes, transposed_bytes;
} ffd_jacobian_desc;
void ffd_jacobian_desc_init(ffd_jacobian_desc *desc, size_t size);
typedef struct ffd_jacobian_result {
    size_t struct_size;
    uint64_t rows, columns, entries;
    uint64_t vertices, moving;
    double worst;
} ffd_jacobian_result;
ffd_status ffd_jacobian_run(const ffd_jacobian_desc *desc, ffd_jacobian_result *result, ffd_error *error);
void ffd_occupy_closed_streams(void);
void ffd_cleanup_on_signals(void);
void ffd_guard_inputs(void);
typedef void (*ffd_spell_function)(const char *member, const char *value, char *text, size_t capacity);
void ffd_spell_members(ffd_spell_function spell);
void ffd_make_one_line(char *text, size_t size);
const char *ffd_nearest_word(const char *word, const char *const *known, size_t count);
const char *ffd_word_meant(const char *word, const char *const *known, size_t count);
bool ffd_paths_meet(const char *a, const char *b);
ffd_status ffd_output_path(const char *folder, const char *input, const char *ending, char **path,
                           ffd_error *error);
ffd_status ffd_check_output_folder(const char *folder, ffd_error *error);
typedef struct ffd_bar ffd_bar;
ffd_bar *ffd_bar_create(const char *what);
bool ffd_bar_show(void *bar, double done);
void ffd_bar_clear(ffd_bar *bar);
void ffd_bar_destroy(ffd_bar **bar);
bool ffd_worker_main(int argc, char **argv, int *exit_code);
typedef enum ffd_member_kind {
    FFD_MEMBER_FLAG = 0,
    FFD_MEMBER_CHOICE,
    FFD_MEMBER_FORMAT,
    FFD_MEMBER_COUNT,
    FFD_MEMBER_LENGTH,
    FFD_MEMBER_DISTANCE,
    FFD_MEMBER_TIME,
    FFD_MEMBER_MOMENT,
    FFD_MEMBER_BYTES,
    FFD_MEMBER_GATES,
    FFD_MEMBER_TEXT,
    FFD_MEMBER_SEAM,
    FFD_MEMBER_TEXTS,
    FFD_MEMBER_SELECTORS,
    FFD_MEMBER_CLIPS,
    FFD_MEMBER_VALUES,
    FFD_MEMBER_LATTICES,
    FFD_MEMBER_MORPHS,
    FFD_MEMBER_OBJECT,
    FFD_MEMBER_WEIGHT
} ffd_member_kind;
typedef enum ffd_member_trait { FFD_MEMBER_IS_PATH = 1, FFD_MEMBER_IS_IDLE = 2 } ffd_member_trait;
typedef struct ffd_member {
    const char *name;
    const char *option;
    ffd_member_kind kind;
    size_t offset;
    size_t second;
    const char *const *words;
    unsigned traits;
} ffd_member;
const ffd_member *ffd_deform_member(size_t index);
const ffd_member *ffd_deform_member_of(const char *option);
ffd_status ffd_member_read(const ffd_member *member, void *desc, const char *text, ffd_error *error);
void ffd_deform_desc_clear(ffd_deform_desc *desc);
ffd_status ffd_deform_desc_check(const ffd_deform_desc *desc, ffd_error *error);
const char *ffd_version(void);
const char *ffd_version_build(void);
