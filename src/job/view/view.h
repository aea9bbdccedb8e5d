/* view.h - the steps in which `ffd view` makes its scene, each in a source of its own: the inputs that the
   output must not replace (view_inputs.c), the geometry (view_mesh.c), which vertices of two files are the
   same (view_order.c), marks and control lattices (view_marks.c), animations (view_rigs.c), Gaussian splats
   (view_splats.c), the passes of --morph (view_morphs.c), morph targets (view_targets.c). */
#ifndef FFD_JOB_VIEW_VIEW_H
#define FFD_JOB_VIEW_VIEW_H

#include "job/measure/job_state.h"
#include "mesh/mesh.h"
#include "mesh/mesh_log.h"
#include "mesh/model.h"
#include "mesh/morphs.h"
#include "view/view_scene.h"

/* Refuses an output that is a mesh, a lattice or the embedding of the view (FFD_E_EXISTS). */
ffd_status ffd_view_check_inputs(const ffd_view_desc *desc, ffd_error *error);
/* Likewise for the files that an open mesh refers to: buffers, images, material libraries. Errors also:
   FFD_E_MEMORY. */
ffd_status ffd_view_check_files(const ffd_source *source, const mesh_document *document, const char *output,
                                ffd_error *error);

/* Fills the scene's vertices, triangles, segments, points and parts. Arrays that the scene keeps are moved
   out of the model. faces: filled with the polygon of each triangle, scene->triangle_count numbers; freed by
   the caller. log: gets a warning of polygons whose triangles may overlap. Errors: FFD_E_LIMIT (more triangle
   corners than 32 bits can number, or the model's memory budget), FFD_E_MEMORY. */
ffd_status ffd_view_take_mesh(mesh_model *model, view_scene *scene, uint32_t **faces, const mesh_log *log,
                              ffd_error *error);

/* Fills the positions after. deformed: 3 numbers for each vertex of the document after, in the order of `ffd
   embed`; NULL: no vertex moves. A vertex whose entry is NaN (its transform has no inverse) stays. Errors:
   FFD_E_LIMIT (the model's memory budget), FFD_E_MEMORY. */
ffd_status ffd_view_place_after(const mesh_model *model, const double *deformed, view_scene *scene,
                                ffd_error *error);

/* The later file may list its parts in another order. Finds the vertex of `after` that each vertex of
   `before` is, by what shows them: nodes of a glTF that got copies of their meshes have these behind all
   others. Both have as many vertices. order: the caller's to free; NULL where the vertices have the same
   order, or where the parts of the two cannot be matched. Errors: FFD_E_LIMIT (the memory budget of after),
   FFD_E_MEMORY. */
ffd_status ffd_view_match_parts(const mesh_document *before, mesh_document *after, size_t **order,
                                ffd_error *error);

/* Fills the marks of a scene that has its mesh. faces: of each triangle the polygon in the model that the
   scene was made from. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_add_marks(const deform_job *job, const ffd_job_result *result, const mesh_model *model,
                              const uint32_t *faces, view_scene *scene, ffd_error *error);
/* Fills the cages. The lattices must be fitted. sources: of the lattices, for their names. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_view_add_cages(const lattice_chain *chain, const ffd_lattice_source *sources,
                              view_scene *scene, ffd_error *error);
/* Finds the largest displacement of a vertex. */
void ffd_view_measure(view_scene *scene);

/* What the lattices of --morph do, 3 numbers for each vertex of the document. All zeros: there are none. */
typedef struct view_morphs {
    float **moves; /* by how much each target moves a vertex, in the order of the lattices */
    size_t count;
    double *base;  /* the stored shape */
    double *after; /* the shape that default weights show with all targets in full */
    double *shift; /* by how much it differs from that without them */
} view_morphs;

/* Reads the positions of all vertices in the order of `ffd embed`; the caller frees them in every case.
   Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_view_read_positions(const mesh_document *document, mesh_state state, double **positions,
                                   ffd_error *error);
/* Runs an open job whose description has morphs, once for each lattice, and fills morphs and job->details;
   details are of the base with all targets in full. Free them with ffd_view_free_morphs in every case.
   Errors: as ffd_deform_job_run; FFD_E_GATE is returned when all targets have run. */
ffd_status ffd_view_run_morphs(deform_job *job, view_morphs *morphs, ffd_job_result *result,
                               ffd_error *error);
/* Whether a target of the file has one of the names of new ones. */
bool ffd_view_replaces(const char *const *names, size_t count, const mesh_target *target);
/* Frees the arrays. */
void ffd_view_free_morphs(view_morphs *morphs);

typedef struct view_targets_desc {
    mesh_document *before, *after; /* after: the deformed mesh as a file, or NULL */
    const deform_job *job;
    bool deforms;                   /* the job has deformed the shape before, and its targets */
    bool stored;                    /* the shapes are those without any target */
    const char *const *morph_names; /* morph_count names of further targets */
    size_t morph_count;
    const view_morphs *morphs; /* their moves */
    const mesh_log *log;
} view_targets_desc;

/* Fills the sliders and targets of a scene that has its mesh. Results of the document may be replaced.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_view_add_targets(const view_targets_desc *desc, view_scene *scene, ffd_error *error);

/* Default number of poses in a picture. */
#define VIEW_POSES 5

typedef struct view_rigs_desc {
    mesh_document *before, *after; /* after: the deformed mesh as a file, or NULL */
    bool deformed;                 /* `before` has results, which are the mesh after */
    bool follows;                  /* its nodes have moved too */
    const double *gradients;       /* of the displacement, 9 a vertex; or NULL */
    const double *shift;           /* what the shape after has beside that before, 3 a vertex; or NULL */
    mesh_state state;              /* of both meshes */
    const char *before_name, *after_name;
    const char *animation; /* name of the animation to show; NULL: none */
    bool all;              /* load all animations, for a page; unreadable ones are left out with a warning */
    const mesh_log *log;
} view_rigs_desc;

/* Fills the scene's rigs and animations, and finds the one to show. Errors: FFD_E_ARGUMENT (there is no such
   animation), those of reading its keys, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_view_make_rigs(const view_rigs_desc *desc, view_scene *scene, ffd_error *error);

/* Adds the Gaussian splats of the mesh before, if it has any. After they are those of the other mesh, or are
   carried by the gradients of the deformation (9 for each vertex of the mesh; NULL: none). Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_view_add_splats(mesh_document *before, mesh_document *after, const double *gradients,
                               view_scene *scene, ffd_error *error);

#endif
