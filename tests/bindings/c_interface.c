/* The C interface, from C: returns the line of the first check that fails, or 0. */
#include <fathom/fathom.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition) \
  if (!(condition)) return __LINE__

static int stop_at_once(double fraction, void* user) {
  *(double*)user = fraction;
  return 1;
}

static int check_errors(void) {
  static const char kBad[] = "fathom 1\nobject \"a\" spere(1)\n";
  fathom_scene* scene = NULL;
  fathom_diagnostics* diagnostics = NULL;
  fathom_error error;
  fathom_diagnostic first;
  CHECK(fathom_compile(kBad, strlen(kBad), NULL, &scene, &diagnostics, &error) == FATHOM_BAD_SCENE);
  CHECK(scene == NULL && error.kind == FATHOM_BAD_SCENE && strstr(error.message, "spere") != NULL);
  CHECK(fathom_diagnostics_count(diagnostics) == 1);
  CHECK(fathom_diagnostics_get(diagnostics, 0, &first) == FATHOM_OK);
  CHECK(first.is_error && first.line == 2 && first.column == 12 && first.end - first.begin == 5);
  CHECK(first.help_count == 1 && strstr(fathom_diagnostics_help(diagnostics, 0, 0), "sphere") != NULL);
  CHECK(fathom_diagnostics_help(diagnostics, 0, 1) == NULL);
  CHECK(fathom_diagnostics_get(diagnostics, 1, &first) == FATHOM_BAD_ARGUMENT);
  fathom_diagnostics_free(diagnostics);
  CHECK(fathom_load("no such file", NULL, &scene, NULL, NULL) == FATHOM_FILE);
  CHECK(fathom_load(NULL, NULL, &scene, NULL, NULL) == FATHOM_BAD_ARGUMENT);
  CHECK(fathom_distance_f32(NULL, NULL, 3, 1, NULL, &error) == FATHOM_BAD_ARGUMENT);
  CHECK(fathom_object_count(NULL) == 0 && fathom_diagnostics_count(NULL) == 0);
  fathom_scene_free(NULL);
  fathom_diagnostics_free(NULL);
  fathom_image_free(NULL);
  return 0;
}

static int check_values(const fathom_scene* scene) {
  static const float kPoints[] = {0, 0, 0, 3, 0, 0};
  static const double kReal[] = {0, 0, 0, -1, 3, 0, 0, -1};
  static const double kOrigins[] = {0, 0, 5, 9, 9, 9}, kDirections[] = {0, 0, -1, 0, 0, 1};
  static const double kLo[] = {-1, -1, -1}, kHi[] = {1, 1, 1};
  float distance[2], gradient[6];
  double real[2], range[2], lo[3], hi[3];
  uint32_t object[2];
  fathom_hit hits[2];
  int certified = 0;
  CHECK(fathom_distance_f32(scene, kPoints, 3, 2, distance, NULL) == FATHOM_OK);
  CHECK(distance[0] == -2 && distance[1] == 1);
  CHECK(fathom_distance_f64(scene, kReal, 4, 2, real, NULL) == FATHOM_OK);
  CHECK(real[0] == -2 && real[1] == 1);
  CHECK(fathom_evaluate_f32(scene, kPoints, 3, 2, NULL, gradient, object, NULL) == FATHOM_OK);
  CHECK(gradient[3] == 1 && gradient[4] == 0 && object[1] == 0);
  CHECK(fathom_evaluate_f64(scene, kReal, 4, 2, real, NULL, NULL, NULL) == FATHOM_OK && real[1] == 1);
  CHECK(fathom_range(scene, kLo, kHi, range, NULL) == FATHOM_OK && range[0] <= -2 && range[1] >= sqrt(3) - 2);
  CHECK(fathom_march(scene, kOrigins, kDirections, 2, hits, NULL) == FATHOM_OK);
  CHECK(hits[0].hit && fabs(hits[0].t - 3) < 1e-6 && fabs(hits[0].normal[2] - 1) < 1e-6 && !hits[1].hit);
  fathom_bounds(scene, lo, hi);
  CHECK(lo[0] == -2 && hi[2] == 2);
  CHECK(fathom_lipschitz(scene, &certified) == 1 && certified);
  CHECK(fathom_object_count(scene) == 1 && strcmp(fathom_object_name(scene, 0), "ball") == 0);
  CHECK(fathom_object_name(scene, 1) == NULL);
  return 0;
}

#define NAMES(call, what) \
  CHECK((call) == FATHOM_BAD_ARGUMENT && strncmp(error.message, what, strlen(what)) == 0)

/* NULL where an array is announced, or a name needed, was a signal or an internal error. */
static int check_nulls(const fathom_scene* scene) {
  static const double kPoint[] = {0, 0, 0}, kUp[] = {0, 1, 0}, kNan[] = {0, NAN, 0};
  static const char kText[] = "fathom 1\nobject \"a\" sphere(1)\n";
  fathom_definition unnamed = {NULL, 1};
  fathom_compile_options options;
  fathom_mesh_options cut;
  fathom_scene* made = NULL;
  const fathom_mesh* mesh = NULL;
  fathom_error error;
  double value[6], box[6] = {1, 0, 0, 0, 1, 1};
  fathom_hit hit;
  memset(&options, 0, sizeof options);
  memset(&cut, 0, sizeof cut);
  options.parameter_count = 1;
  NAMES(fathom_compile(kText, strlen(kText), &options, &made, NULL, &error), "options.parameters is NULL");
  NAMES(fathom_load("a.fathom", &options, &made, NULL, &error), "options.parameters is NULL");
  options.parameters = &unnamed;
  NAMES(fathom_compile(kText, strlen(kText), &options, &made, NULL, &error), "options.parameters[0].name is NULL");
  NAMES(fathom_compile(NULL, 8, NULL, &made, NULL, &error), "text is NULL");
  NAMES(fathom_compile(kText, strlen(kText), NULL, NULL, NULL, &error), "scene is NULL");
  NAMES(fathom_load(NULL, NULL, &made, NULL, &error), "path is NULL");
  NAMES(fathom_distance_f64(NULL, kPoint, 3, 1, value, &error), "scene is NULL");
  NAMES(fathom_distance_f64(scene, NULL, 3, 1, value, &error), "points is NULL");
  NAMES(fathom_distance_f64(scene, kPoint, 3, 1, NULL, &error), "distance is NULL");
  NAMES(fathom_distance_f32(scene, NULL, 3, 1, NULL, &error), "distance is NULL");
  NAMES(fathom_evaluate_f64(scene, NULL, 3, 1, value, NULL, NULL, &error), "points is NULL");
  NAMES(fathom_range(scene, NULL, kUp, value, &error), "lo is NULL");
  NAMES(fathom_range(scene, kPoint, kUp, NULL, &error), "range is NULL");
  NAMES(fathom_range(scene, kUp, kPoint, value, &error), "box 0: y from 1 to 0");
  NAMES(fathom_range(scene, kPoint, kNan, value, &error), "box 0: y from 0 to nan");
  NAMES(fathom_march(scene, NULL, kUp, 1, &hit, &error), "origins is NULL");
  NAMES(fathom_march(scene, kPoint, NULL, 1, &hit, &error), "directions is NULL");
  NAMES(fathom_march(scene, kPoint, kUp, 1, NULL, &error), "hits is NULL");
  NAMES(fathom_render(scene, NULL, NULL, &error), "image is NULL");
  NAMES(fathom_image_depth(NULL, NULL, &error), "image is NULL");
  NAMES(fathom_image_write(NULL, "a.png", &error), "image is NULL");
  NAMES(fathom_make_mesh(scene, NULL, NULL, &error), "mesh is NULL");
  cut.box = box;
  NAMES(fathom_make_mesh(scene, &cut, &mesh, &error), "box: x from 1 to 0");
  CHECK(fathom_distance_f64(scene, NULL, 3, 0, NULL, &error) == FATHOM_OK);
  CHECK(fathom_march(scene, NULL, NULL, 0, NULL, &error) == FATHOM_OK);
  fathom_bounds(scene, NULL, value);
  fathom_bounds(scene, value, NULL);
  return 0;
}

static int check_render(const fathom_scene* scene) {
  fathom_render_options options;
  fathom_image* image = NULL;
  double fraction = -1;
  float radiance[3 * 8 * 6], depth[8 * 6];
  uint8_t display[3 * 8 * 6];
  uint32_t object[8 * 6];
  memset(&options, 0, sizeof options);
  options.width = 8;
  options.height = 6;
  options.samples = 2;
  CHECK(fathom_render(scene, &options, &image, NULL) == FATHOM_OK);
  CHECK(fathom_image_width(image) == 8 && fathom_image_height(image) == 6 && fathom_image_complete(image));
  CHECK(fathom_image_read(image, FATHOM_RADIANCE, radiance, NULL) == FATHOM_OK && radiance[0] > 0);
  CHECK(fathom_image_display(image, display, NULL) == FATHOM_OK && display[0] > 0);
  CHECK(fathom_image_depth(image, depth, NULL) == FATHOM_OK && depth[8 * 3 + 4] > 0);
  CHECK(fathom_image_objects(image, object, NULL) == FATHOM_OK && object[8 * 3 + 4] == 0);
  CHECK(fathom_image_write(image, "picture.gif", NULL) == FATHOM_BAD_ARGUMENT);
  fathom_image_free(image);
  options.samples = 1 << 20;
  options.progress = stop_at_once;
  options.user = &fraction;
  CHECK(fathom_render(scene, &options, &image, NULL) == FATHOM_OK);
  CHECK(!fathom_image_complete(image) && fraction >= 0 && fraction < 1);
  fathom_image_free(image);
  return 0;
}

static int check_mesh(const fathom_scene* scene) {
  fathom_mesh_options options;
  const fathom_mesh* mesh = NULL;
  fathom_error error;
  memset(&options, 0, sizeof options);
  options.tolerance = 0.1;
  CHECK(fathom_make_mesh(scene, &options, &mesh, NULL) == FATHOM_OK);
  CHECK(mesh->triangle_count == 2 * mesh->vertex_count - 4 && mesh->proved && mesh->bound <= 0.1);
  CHECK(fabs(mesh->vertices[0]) <= 2.1 && mesh->triangles[0] < mesh->vertex_count && mesh->objects[0] == 0);
  fathom_mesh_free(mesh);
  options.tolerance = -1;
  CHECK(fathom_make_mesh(scene, &options, &mesh, &error) == FATHOM_BAD_ARGUMENT && mesh == NULL);
  fathom_mesh_free(NULL);
  return 0;
}

int check_c_interface(void) {
  static const char kBall[] = "fathom 1\nparam r = 1\nobject \"ball\" sphere(r)\nbackground [1, 1, 1]\n";
  static const fathom_definition kRadius = {"r", 2};
  fathom_compile_options options;
  fathom_scene* scene = NULL;
  int line;
  CHECK(strcmp(fathom_version(), FATHOM_VERSION) == 0 && fathom_instruction_set()[0] != '\0');
  memset(&options, 0, sizeof options);
  options.parameters = &kRadius;
  options.parameter_count = 1;
  CHECK(fathom_compile(kBall, strlen(kBall), &options, &scene, NULL, NULL) == FATHOM_OK && scene != NULL);
  line = check_errors();
  if (line == 0) line = check_values(scene);
  if (line == 0) line = check_nulls(scene);
  if (line == 0) line = check_render(scene);
  if (line == 0) line = check_mesh(scene);
  fathom_scene_free(scene);
  return line;
}
