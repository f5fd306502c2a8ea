// Prints the distance, gradient and object at points that it reads as lines of x y z, as `fathom eval` does.
#include <cstdio>
#include <fathom/fathom.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: distances scene.fathom < points\n", stderr), 2;
  const fathom::Compiled compiled = fathom::load(argv[1]);
  std::fputs(fathom::to_string(compiled.diagnostics).c_str(), stderr);
  if (!compiled.scene) return std::fprintf(stderr, "%s\n", compiled.error.message.c_str()), 1;

  std::vector<fathom::Vec3d> points;
  for (fathom::Vec3d p; std::scanf("%lf %lf %lf", &p.x, &p.y, &p.z) == 3;) points.push_back(p);

  std::vector<double> distance(points.size());
  std::vector<fathom::Vec3d> gradient(points.size());
  std::vector<std::uint32_t> object(points.size());
  const fathom::Values<double> values{distance, gradient, object};
  if (const fathom::Error error = compiled.scene.evaluate(fathom::Points<double>(points), values)) {
    return std::fprintf(stderr, "%s\n", error.message.c_str()), 1;
  }

  std::vector<std::string> names;
  if (compiled.scene.objects(names)) return 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const fathom::Vec3d& g = gradient[i];
    std::printf("%.17g %.17g %.17g %.17g %s\n", distance[i], g.x, g.y, g.z, names[object[i]].c_str());
  }
}
