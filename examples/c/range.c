/* Prints bounds of the distance in a box: cc range.c $(pkg-config --cflags --libs fathom) -o range */
#include <fathom/fathom.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  if (argc != 8) return fputs("usage: range scene.fathom x0 y0 z0 x1 y1 z1\n", stderr), 2;
  double corners[6], range[2];
  for (int i = 0; i < 6; ++i) corners[i] = atof(argv[2 + i]);

  fathom_scene* scene = NULL;
  fathom_diagnostics* diagnostics = NULL;
  fathom_error error;
  const int kind = fathom_load(argv[1], NULL, &scene, &diagnostics, &error);
  for (size_t i = 0; i < fathom_diagnostics_count(diagnostics); ++i) {
    fathom_diagnostic d;
    fathom_diagnostics_get(diagnostics, i, &d);
    fprintf(stderr, "%s:%u:%u: %s: %s\n", d.file, d.line, d.column, d.is_error ? "error" : "warning", d.message);
  }
  fathom_diagnostics_free(diagnostics);
  if (kind != FATHOM_OK) return fprintf(stderr, "%s\n", error.message), 1;

  if (fathom_range(scene, corners, corners + 3, range, &error) == FATHOM_OK) {
    printf("%.17g %.17g\n", range[0], range[1]);
  } else {
    fprintf(stderr, "%s\n", error.message);
  }
  fathom_scene_free(scene);
  return error.kind != FATHOM_OK;
}
