// Fathom's C++ interface: scenes of signed distance fields, compiled, evaluated, marched and rendered.
//
//     const fathom::Compiled compiled = fathom::compile("fathom 1\nobject \"ball\" sphere(1)\n");
//     if (!compiled.scene) return print(compiled.diagnostics);
//     float distance[2];
//     const fathom::Vec3f points[2] = {{0, 0, 0}, {2, 0, 0}};
//     fathom::Error error = compiled.scene.distance(fathom::Points(points), distance);
//
// No function throws: functions return an Error, which is false after success. The library has no global state. A
// Scene is immutable, and any number of threads may use one Scene at once. Lengths are in scene units and places in
// the scene's coordinates unless stated otherwise. Results have the same bits on every processor and for any number
// of threads.
#pragma once

#include <fathom/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom {

// Version of the library at run time, e.g. "0.1.0". FATHOM_VERSION (fathom/export.h) is that of the headers.
FATHOM_API const char* version() noexcept;
// Instruction set that evaluations use: "avx512", "avx2", "sse4", "neon" or "scalar".
FATHOM_API const char* instruction_set() noexcept;

// Outcome of a call.
struct Error {
  enum class Kind : int {
    None = 0,
    BadScene = 1,     // the scene has errors; Compiled::diagnostics lists them
    BadArgument = 2,  // e.g. spans of different lengths
    File = 3,         // a file cannot be read or written
    OutOfMemory = 4,
    Internal = 5,  // a defect of the library
  };
  Kind kind = Kind::None;
  std::string message = {};  // a sentence without a full stop; empty after success and when memory is short

  explicit operator bool() const noexcept { return kind != Kind::None; }
};

template <class T>
struct Vec3 {
  T x, y, z;
};
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

// Axis-aligned box, scene units. Sides may be infinite. A box with lo > hi on an axis is empty.
struct Box {
  Vec3d lo, hi;
};
// Closed interval of distances, scene units.
struct Interval {
  double lo, hi;
};

// View of points in memory of the caller: three coordinates per point, `stride` numbers from each point to the next.
// The library reads the points in place.
template <class T>
struct Points {
  const T* x = nullptr;
  const T* y = nullptr;
  const T* z = nullptr;
  std::size_t count = 0;
  std::ptrdiff_t stride = 1;

  Points() = default;
  Points(const T* xs, const T* ys, const T* zs, std::size_t n, std::ptrdiff_t step = 1)
      : x(xs), y(ys), z(zs), count(n), stride(step) {}
  explicit Points(std::span<const Vec3<T>> points)
      : x(&points.data()->x), y(&points.data()->y), z(&points.data()->z), count(points.size()), stride(3) {}
};
template <class T, std::size_t N>
Points(const Vec3<T> (&)[N]) -> Points<T>;
template <class T>
Points(const std::vector<Vec3<T>>&) -> Points<T>;

// Results of Scene::evaluate(), each empty or as long as the points. Empty results are not computed.
template <class T>
struct Values {
  std::span<T> distance = {};            // negative inside solids
  std::span<Vec3<T>> gradient = {};      // of the distance; not normalised; zero where undefined
  std::span<std::uint32_t> object = {};  // index into Scene::objects() of the nearest surface's object
};

struct Ray {
  Vec3d origin;
  Vec3d direction;                   // any finite length except zero
  std::optional<double> t_max = {};  // max distance from the origin
};

// First surface that a ray meets.
struct Hit {
  bool hit = false;
  bool inside = false;  // the ray began inside a solid, and `t` is where it leaves the solid
  double t = 0;         // distance from the origin; the members below are zero without a hit
  Vec3d position = {0, 0, 0};
  Vec3d normal = {0, 0, 0};  // unit length, towards the ray's origin
  std::uint32_t object = 0;  // index into Scene::objects()
};

// Error or warning about a scene's text.
struct Diagnostic {
  bool error = false;                  // false: a warning
  std::string code;                    // e.g. "E0102", docs/reference/check.md
  std::string message;                 // one line without a full stop
  std::string file;                    // of the scene, or of a file that it imports
  std::uint32_t line = 0, column = 0;  // from 1; columns count code points; 0: about the scene as a whole
  std::size_t begin = 0, end = 0;      // bytes of `file`
  std::string label;                   // describes the bytes; may be empty
  std::vector<std::string> help;       // remedies
};

struct Parameter {
  std::string name;
  double value, min, max;  // min and max may be infinite
  std::string doc;
};

struct RenderOptions {
  // Settings without a value are the scene's.
  std::optional<int> width = {}, height = {};  // pixels
  std::optional<int> samples = {};             // per pixel
  std::optional<std::uint64_t> seed = {};      // of the random numbers
  std::optional<double> time_limit = {};       // seconds; the image then has the samples taken so far
  bool denoise = false;                        // takes two samples per pixel or more
  int threads = 0;                             // 0: one per processor
  // Called by one rendering thread at a time with the share of the work that is done, in [0, 1].
  std::function<void(double fraction)> progress = {};
  // Ends the render soon after a stop was requested. The image then has the samples taken so far.
  std::stop_token stop = {};
};

enum class Layer : int {
  Radiance = 0,  // linear sRGB
  Albedo = 1,    // of the first hit, linear sRGB; 0 without a hit
  Normal = 2,    // mean of the first hits' normals; 0 without a hit
  Position = 3,  // of the first hit; 0 without a hit
};

// A rendered image. Copies share the image.
class FATHOM_API Image {
 public:
  struct Data;

  Image() noexcept = default;
  explicit Image(std::shared_ptr<const Data> data) noexcept : data_(std::move(data)) {}
  explicit operator bool() const noexcept { return data_ != nullptr; }

  int width() const noexcept;
  int height() const noexcept;
  bool complete() const noexcept;          // false if a stop or the time limit ended the render
  std::uint64_t samples() const noexcept;  // over all pixels

  // Read all pixels, [y][x][3], y downwards. `out` has 3 * width * height elements.
  Error read(Layer layer, std::span<float> out) const noexcept;
  // Distance of the first hit along the ray, [y][x]; 0 without a hit.
  Error read_depth(std::span<float> out) const noexcept;
  // Index into Scene::objects() of the first hit, [y][x]; kNoObject without a hit.
  static constexpr std::uint32_t kNoObject = 0xffffffff;
  Error read_objects(std::span<std::uint32_t> out) const noexcept;
  // The image for a display, with the scene's exposure and tone curve, sRGB encoded, [y][x][3].
  Error read_display(std::span<std::uint8_t> out) const noexcept;
  // The bytes of the PNG file that write() makes.
  Error encode_png(std::vector<std::uint8_t>& out) const noexcept;
  // Writes the image in the format of the file name's ending: png, jpg, bmp, exr (all layers), pfm or hdr. The file
  // appears whole or not at all.
  Error write(const std::string& path) const noexcept;

 private:
  std::shared_ptr<const Data> data_;
};

struct Rendered {
  Image image;
  Error error;
};

struct MeshOptions {
  // Max distance of the mesh from the surface, scene units. Without it, `resolution` decides.
  std::optional<double> tolerance = {};
  int resolution = 256;         // cells along the longest side
  std::optional<Box> box = {};  // cuts the solid off, with flat faces; a scene without end needs it
  bool simplify = true;         // merges triangles where the tolerance allows it
  int threads = 0;              // 0: one per processor; never changes the mesh
};

// A part of the scene, or a gap, that is too thin for the cells of a mesh.
struct LostPart {
  Vec3d place;
  double thickness;      // a tolerance of this size keeps the part
  std::uint32_t object;  // index into Scene::objects()
  bool gap;
};

// A closed manifold mesh of triangles.
struct Mesh {
  std::vector<Vec3d> vertices;                          // scene units
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<std::uint32_t> objects;                   // [triangle] index into Scene::objects()
  double bound = 0;                                     // every point of the mesh is within `bound` of the surface
  bool proved = false;  // false: the field's float error, and so `bound`, is an estimate
  std::vector<LostPart> lost;
};

struct Meshed {
  Mesh mesh;
  Error error;
};

// A compiled scene. Copies share the scene.
class FATHOM_API Scene {
 public:
  struct Data;

  Scene() noexcept = default;
  explicit Scene(std::shared_ptr<const Data> data) noexcept : data_(std::move(data)) {}
  explicit operator bool() const noexcept { return data_ != nullptr; }

  // Signed distances, with the bits of `fathom eval --number f32` for float and `fathom eval` for double. A
  // point that is not finite has a distance that is not finite.
  Error distance(Points<float> points, std::span<float> out) const noexcept;
  Error distance(Points<double> points, std::span<double> out) const noexcept;
  // Gradients of the distance, not normalised.
  Error gradient(Points<float> points, std::span<Vec3f> out) const noexcept;
  Error gradient(Points<double> points, std::span<Vec3d> out) const noexcept;
  // Several results at once.
  Error evaluate(Points<float> points, const Values<float>& out) const noexcept;
  Error evaluate(Points<double> points, const Values<double>& out) const noexcept;
  // Intervals that contain all distances in each box, by interval arithmetic (Moore, "Interval Analysis", 1966). No
  // box's `lo` is above its `hi` on any axis.
  Error range(std::span<const Box> boxes, std::span<Interval> out) const noexcept;
  // Follows rays to the first surface.
  Error march(std::span<const Ray> rays, std::span<Hit> out) const noexcept;

  Rendered render(const RenderOptions& options = {}) const noexcept;

  // Meshes the surface by dual contouring (Schaefer, Ju, Warren, "Manifold Dual Contouring", 2007).
  Meshed mesh(const MeshOptions& options = {}) const noexcept;

  // Box outside which there is no surface.
  Box bounds() const noexcept;
  // Lipschitz constant of the distance: |f(p) - f(q)| <= lipschitz() * |p - q|. An estimate unless certified().
  double lipschitz() const noexcept;
  bool certified() const noexcept;
  // Names of the objects, in the order of Values::object. A name may be empty.
  Error objects(std::vector<std::string>& out) const noexcept;
  Error parameters(std::vector<Parameter>& out) const noexcept;
  // The scene as bytes for unpack(), of the same version of the library.
  Error pack(std::string& out) const noexcept;
  // Width, height and samples per pixel that the scene states.
  int width() const noexcept;
  int height() const noexcept;
  int samples() const noexcept;

 private:
  std::shared_ptr<const Data> data_;
};

struct CompileOptions {
  std::string name = "scene";  // of the text, in diagnostics
  // Values that replace the defaults of the scene's parameters.
  std::vector<std::pair<std::string, double>> parameters = {};
  // Folder of a text's imports and images; empty: a text imports nothing, and images are relative to the current
  // folder. load() takes the file's folder.
  std::string folder = {};
  // Folder that imports must lie in; default: `folder`.
  std::optional<std::string> import_root = {};
  // Max memory for compiling and rendering, bytes; 0: three quarters of the machine's memory.
  double memory = 0;
};

struct Compiled {
  Scene scene;                          // false after an error
  std::vector<Diagnostic> diagnostics;  // errors and warnings, in the text's order
  Error error;

  explicit operator bool() const noexcept { return static_cast<bool>(scene); }
};

// Compiles a scene's text: the scene language, JSON, or a model of another format (docs/reference/other-formats.md).
FATHOM_API Compiled compile(std::string_view text, const CompileOptions& options = {}) noexcept;
// Reads and compiles a scene file, or reads a compiled file (.fbc). `options.name` is ignored.
FATHOM_API Compiled load(const std::string& path, const CompileOptions& options = {}) noexcept;

// Makes a scene of the bytes of Scene::pack(). Believes them: bytes of others belong to load().
FATHOM_API Compiled unpack(std::string_view bytes) noexcept;

// Formats diagnostics as `fathom check` prints them, without excerpts of the text: "scene:3:14: error: ...", a line
// each.
FATHOM_API std::string to_string(std::span<const Diagnostic> diagnostics);

}  // namespace fathom
