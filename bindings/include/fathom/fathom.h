/* Fathom's C interface, over the C++ interface of fathom.hpp, for other languages.
 *
 *     fathom_scene* scene = NULL;
 *     fathom_error error;
 *     if (fathom_load("scene.fathom", NULL, &scene, NULL, &error) != FATHOM_OK) return fail(error.message);
 *     fathom_distance_f32(scene, points, 3, 100, distance, &error);
 *     fathom_scene_free(scene);
 *
 * Functions that can fail return an error kind, 0 after success, and describe the error in `error`, which may be
 * NULL. There is no global state. Any number of threads may use one scene or image at once. Texts are UTF-8 and end
 * with a zero; those that the library returns live as long as the object that they were asked from. Lengths are in
 * scene units. Structs of options are to be zeroed before use: zero is the default of every member. */
#ifndef FATHOM_H
#define FATHOM_H

#include <fathom/export.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum fathom_error_kind {
  FATHOM_OK = 0,
  FATHOM_BAD_SCENE = 1,    /* the scene has errors: fathom_diagnostics lists them */
  FATHOM_BAD_ARGUMENT = 2, /* e.g. a null pointer */
  FATHOM_FILE = 3,         /* a file cannot be read or written */
  FATHOM_OUT_OF_MEMORY = 4,
  FATHOM_INTERNAL = 5 /* a defect of the library */
} fathom_error_kind;

typedef struct fathom_error {
  int kind;          /* a fathom_error_kind */
  char message[508]; /* a sentence, cut where it is longer; empty after success */
} fathom_error;

typedef struct fathom_scene fathom_scene;
typedef struct fathom_image fathom_image;
typedef struct fathom_diagnostics fathom_diagnostics;

/* Version of the library at run time, and the instruction set that evaluations use. */
FATHOM_API const char* fathom_version(void);
FATHOM_API const char* fathom_instruction_set(void);

/* ---- compile ---- */

typedef struct fathom_definition {
  const char* name;
  double value;
} fathom_definition;

typedef struct fathom_compile_options {
  const char* name;                    /* of the text in diagnostics; NULL: "scene" */
  const char* folder;                  /* of a text's imports and images; NULL: it imports nothing */
  const char* import_root;             /* folder that imports must lie in; NULL: the scene's */
  double memory;                       /* max bytes; 0: three quarters of the machine's */
  const fathom_definition* parameters; /* values that replace the defaults of the scene's parameters */
  size_t parameter_count;
} fathom_compile_options;

/* Compile a text of `length` bytes, or read and compile a file. `options` and `diagnostics` may be NULL. `*scene` is
 * set to a new scene, or to NULL after an error. `*diagnostics` is set to the errors and warnings, also after
 * success, or to NULL if there are none. */
FATHOM_API int fathom_compile(const char* text, size_t length, const fathom_compile_options* options,
                              fathom_scene** scene, fathom_diagnostics** diagnostics, fathom_error* error);
FATHOM_API int fathom_load(const char* path, const fathom_compile_options* options, fathom_scene** scene,
                           fathom_diagnostics** diagnostics, fathom_error* error);
FATHOM_API void fathom_scene_free(fathom_scene* scene); /* NULL is allowed */

typedef struct fathom_diagnostic {
  int is_error; /* 0: a warning */
  const char *code, *message, *file, *label;
  uint32_t line, column; /* from 1; 0: about the scene as a whole */
  size_t begin, end;     /* bytes of the file */
  size_t help_count;
} fathom_diagnostic;
FATHOM_API size_t fathom_diagnostics_count(const fathom_diagnostics* diagnostics); /* 0 for NULL */
FATHOM_API int fathom_diagnostics_get(const fathom_diagnostics* diagnostics, size_t index, fathom_diagnostic* out);
FATHOM_API const char* fathom_diagnostics_help(const fathom_diagnostics* diagnostics, size_t index, size_t help);
FATHOM_API void fathom_diagnostics_free(fathom_diagnostics* diagnostics);

/* ---- facts ---- */

FATHOM_API void fathom_bounds(const fathom_scene* scene, double lo[3], double hi[3]);
FATHOM_API double fathom_lipschitz(const fathom_scene* scene, int* certified); /* `certified` may be NULL */
FATHOM_API size_t fathom_object_count(const fathom_scene* scene);
FATHOM_API const char* fathom_object_name(const fathom_scene* scene, size_t object); /* NULL past the end */

/* ---- evaluate ----
 * Points are `count` times x, y, z, `stride` numbers from each point to the next: 3 if they are packed. */

FATHOM_API int fathom_distance_f32(const fathom_scene* scene, const float* points, ptrdiff_t stride, size_t count,
                                   float* distance, fathom_error* error);
FATHOM_API int fathom_distance_f64(const fathom_scene* scene, const double* points, ptrdiff_t stride, size_t count,
                                   double* distance, fathom_error* error);
/* Each result may be NULL. `gradient` has three numbers per point, not normalised. */
FATHOM_API int fathom_evaluate_f32(const fathom_scene* scene, const float* points, ptrdiff_t stride, size_t count,
                                   float* distance, float* gradient, uint32_t* object, fathom_error* error);
FATHOM_API int fathom_evaluate_f64(const fathom_scene* scene, const double* points, ptrdiff_t stride, size_t count,
                                   double* distance, double* gradient, uint32_t* object, fathom_error* error);
/* Interval that contains the distances of all points in the box. */
FATHOM_API int fathom_range(const fathom_scene* scene, const double lo[3], const double hi[3], double range[2],
                            fathom_error* error);

typedef struct fathom_hit {
  int hit, inside; /* inside: the ray began in a solid */
  double t;        /* distance from the ray's origin */
  double position[3], normal[3];
  uint32_t object;
} fathom_hit;
/* Follow rays to the first surface: three numbers per origin and per direction. */
FATHOM_API int fathom_march(const fathom_scene* scene, const double* origins, const double* directions, size_t count,
                            fathom_hit* hits, fathom_error* error);

/* ---- render ---- */

typedef struct fathom_render_options {
  int width, height, samples; /* 0: the scene's */
  int threads;                /* 0: one per processor */
  int denoise;                /* 1: denoise the image */
  int has_seed;               /* 1: `seed` replaces the scene's */
  uint64_t seed;
  double time_limit; /* seconds; 0: none */
  /* Called by one rendering thread at a time with the share that is done, in [0, 1]. A result other than 0 ends the
   * render; the image then has the samples so far. */
  int (*progress)(double fraction, void* user);
  void* user;
} fathom_render_options;

typedef enum fathom_layer {
  FATHOM_RADIANCE = 0, /* linear sRGB */
  FATHOM_ALBEDO = 1,
  FATHOM_NORMAL = 2,
  FATHOM_POSITION = 3
} fathom_layer;

FATHOM_API int fathom_render(const fathom_scene* scene, const fathom_render_options* options, fathom_image** image,
                             fathom_error* error);
FATHOM_API int fathom_image_width(const fathom_image* image);
FATHOM_API int fathom_image_height(const fathom_image* image);
FATHOM_API int fathom_image_complete(const fathom_image* image); /* 0 if the render was ended early */
/* Read all pixels: [y][x][3], y downwards. `display` is sRGB encoded, with the scene's exposure and tone curve. */
FATHOM_API int fathom_image_read(const fathom_image* image, fathom_layer layer, float* out, fathom_error* error);
FATHOM_API int fathom_image_display(const fathom_image* image, uint8_t* out, fathom_error* error);
/* [y][x]; depth is 0 and object is 0xffffffff without a hit. */
FATHOM_API int fathom_image_depth(const fathom_image* image, float* out, fathom_error* error);
FATHOM_API int fathom_image_objects(const fathom_image* image, uint32_t* out, fathom_error* error);
/* Format by the path's ending: png, jpg, bmp, exr, pfm, hdr. */
FATHOM_API int fathom_image_write(const fathom_image* image, const char* path, fathom_error* error);
FATHOM_API void fathom_image_free(fathom_image* image);

/* ---- mesh ---- */

typedef struct fathom_mesh_options {
  double tolerance;   /* max distance of the mesh from the surface; 0: `resolution` decides */
  int resolution;     /* cells along the longest side; 0: 256 */
  const double* box;  /* x0, y0, z0, x1, y1, z1, at which the solid is cut off; NULL: no box */
  int keep_triangles; /* 1: triangles are not merged */
  int threads;        /* 0: one per processor */
} fathom_mesh_options;

/* A closed manifold mesh. All arrays belong to the mesh. */
typedef struct fathom_mesh {
  size_t vertex_count, triangle_count;
  const double* vertices;    /* [vertex][3], scene units */
  const uint32_t* triangles; /* [triangle][3], counter-clockwise seen from outside */
  const uint32_t* objects;   /* [triangle] */
  double bound;              /* every point of the mesh is within this distance of the surface */
  int proved;                /* 0: the bound is an estimate */
} fathom_mesh;
FATHOM_API int fathom_make_mesh(const fathom_scene* scene, const fathom_mesh_options* options,
                                const fathom_mesh** mesh, fathom_error* error);
FATHOM_API void fathom_mesh_free(const fathom_mesh* mesh);

#ifdef __cplusplus
}
#endif

#endif
