// Renders a scene until it is done or Enter is pressed: another thread asks for the stop.
#include <cstdio>
#include <fathom/fathom.hpp>
#include <thread>

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: render scene.fathom picture.png\n", stderr), 2;
  const fathom::Compiled compiled = fathom::load(argv[1]);
  std::fputs(fathom::to_string(compiled.diagnostics).c_str(), stderr);
  if (!compiled.scene) return std::fprintf(stderr, "%s\n", compiled.error.message.c_str()), 1;

  std::stop_source stop;
  std::thread([&stop] {
    if (std::getchar() != EOF) stop.request_stop();
  }).detach();

  fathom::RenderOptions options;
  options.width = 640;
  options.height = 360;
  options.samples = 256;
  options.stop = stop.get_token();
  options.progress = [](double fraction) { std::fprintf(stderr, "\r%3.0f %%", 100 * fraction); };
  const fathom::Rendered rendered = compiled.scene.render(options);
  const fathom::Error error = rendered.error ? rendered.error : rendered.image.write(argv[2]);
  if (error) return std::fprintf(stderr, "\n%s\n", error.message.c_str()), 1;
  std::fprintf(stderr, "\r%s %s\n", rendered.image.complete() ? "drew" : "stopped, drew", argv[2]);
}
