// The usual hand-written renderer: the scene is compiled into the program, and rays form packets as wide as a
// register. Sphere tracing is classic (a hit is where the field falls below epsilon, max 256 steps). Normals come
// from four evaluations at the corners of a tetrahedron. For paths, which soon diverge, a lane takes a new ray when
// its own has ended.
//
// Compiled once per instruction set. A scene is a type with
//     static Batch distance(Batch x, Batch y, Batch z);
//     static constexpr double kLevel;                    // to be added to the distance
#if defined(FATHOM_BENCH_PACKETS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_BENCH_PACKETS_INL
#undef FATHOM_BENCH_PACKETS_INL
#else
#define FATHOM_BENCH_PACKETS_INL
#endif

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "bench/workload.h"
#include "vm/number/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {
namespace {

using namespace fathom::vm::HWY_NAMESPACE;
using B = Batch;
using Mask = BatchMask;

HWY_INLINE B c(double value) { return Batch::broadcast(value); }
HWY_INLINE std::size_t count(Mask m) { return hn::CountTrue(FloatLanes(), m.m); }
HWY_INLINE Mask and_not(Mask a, Mask b) { return {hn::AndNot(a.m, b.m)}; }  // b and not a
HWY_INLINE B fraction_of(Mask m) { return select(m, c(1), c(0)); }

struct V {
  B x, y, z;
};
HWY_INLINE V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE V operator*(V a, B s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE B dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE V normalize(V a) { return a * (c(1) / sqrt(dot(a, a))); }
HWY_INLINE V select(Mask m, V a, V b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
HWY_INLINE V broadcast(glm::dvec3 v) { return {c(v.x), c(v.y), c(v.z)}; }

constexpr int kMaxSteps = 256;

template <class Scene>
HWY_INLINE B field(V p) {
  const B distance = Scene::distance(p.x, p.y, p.z);
  return Scene::kLevel > 0 ? distance + c(Scene::kLevel) : distance;
}

template <class Scene>
HWY_INLINE V tetrahedron_normal(V p, B h) {
  const B a = field<Scene>({p.x + h, p.y - h, p.z - h}), b = field<Scene>({p.x - h, p.y - h, p.z + h});
  const B d = field<Scene>({p.x - h, p.y + h, p.z - h}), e = field<Scene>({p.x + h, p.y + h, p.z + h});
  return normalize({a - b - d + e, d - a - b + e, b - a - d + e});
}

// A pinhole camera. Positions are in pixels, with 0 at the image's top left corner.
class Pinhole {
 public:
  Pinhole(const View& view, const Frame& frame) {
    const double half = std::tan(view.fov * 0.017453292519943295 / 2);
    const glm::dvec3 f = glm::normalize(view.at - view.eye), r = glm::normalize(glm::cross(f, {0, 1, 0}));
    eye_ = broadcast(view.eye);
    forward_ = broadcast(f);
    right_ = broadcast(r);
    up_ = broadcast(glm::cross(r, f));
    across_ = c(half * frame.width / frame.height);
    down_ = c(half);
    per_x_ = c(2.0 / frame.width);
    per_y_ = c(2.0 / frame.height);
  }
  HWY_INLINE V eye() const { return eye_; }
  HWY_INLINE V direction(B x, B y) const {
    return normalize(right_ * ((x * per_x_ - c(1)) * across_) + up_ * ((c(1) - y * per_y_) * down_) + forward_);
  }

 private:
  V eye_, forward_, right_, up_;
  B across_, down_, per_x_, per_y_;
};

struct Met {
  Mask hit;
  B t;
};

// Marches the rays of a packet until the last has ended.
template <class Scene>
HWY_INLINE Met march(V origin, V direction, Mask active, const View& view) {
  const B epsilon = c(view.epsilon), t_max = c(view.t_max);
  Met met{c(0) < c(0), c(0)};
  for (int i = 0; i < kMaxSteps && any(active); ++i) {
    const B q = field<Scene>(origin + direction * met.t);
    const Mask hits = active & (q < epsilon);
    met.hit = met.hit | hits;
    active = and_not(hits, active);
    met.t = select(active, met.t + q, met.t);
    active = active & (met.t <= t_max);
  }
  return met;
}

// Workload S. Packets are blocks of pixels, four wide when the register has enough lanes.
template <class Scene>
void render_shadow(const View& view, const Frame& frame, Picture& picture) {
  constexpr std::size_t kAcross = kLanes < 4 ? kLanes : 4, kDown = kLanes / kAcross;
  const Pinhole camera(view, frame);
  const V light = broadcast(glm::normalize(kToLight));
  const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
  picture = {width * height, 0, std::vector<float>(width * height)};
  for (std::size_t row = 0; row < height; row += kDown) {
    for (std::size_t column = 0; column < width; column += kAcross) {
      alignas(64) float x[kLanes], y[kLanes], value[kLanes];
      for (std::size_t i = 0; i < kLanes; ++i) {
        x[i] = static_cast<float>(column + i % kAcross) + 0.5f;
        y[i] = static_cast<float>(row + i / kAcross) + 0.5f;
      }
      const V d = camera.direction(B::load(x), B::load(y));
      const Met met = march<Scene>(camera.eye(), d, B::load(y) < c(frame.height), view);
      B shown = c(0.5) + c(0.5) * d.y;
      if (any(met.hit)) {
        const V p = camera.eye() + d * met.t, n = tetrahedron_normal<Scene>(p, c(view.epsilon));
        const B cosine = dot(n, light);
        const Mask lit = met.hit & (cosine > c(0));
        const Met blocked = march<Scene>(p + n * c(4 * view.epsilon), light, lit, view);
        const B s = select(and_not(blocked.hit, lit), cosine, c(0));
        shown = select(met.hit, c(kAlbedo) * (c(kAmbient) + c(1 - kAmbient) * s), shown);
        picture.rays += count(lit);
        picture.camera_hits += count(met.hit);
      }
      shown.store(value);
      for (std::size_t i = 0; i < kLanes && row + i / kAcross < height; ++i) {
        picture.pixels[(row + i / kAcross) * width + column + i % kAcross] = value[i];
      }
    }
  }
}

// PCG-RXS-M-XS 32 (O'Neill, 2014), one generator per lane.
class Random {
 public:
  using Ints = hn::RebindToUnsigned<FloatLanes>;
  using Int = hn::Vec<Ints>;

  HWY_INLINE Random() : state_(hn::Zero(Ints())) {}
  HWY_INLINE void seed(Mask where, Int seed) {
    state_ = hn::IfThenElse(hn::RebindMask(Ints(), where.m), output(step(seed)), state_);
  }
  // Returns numbers in [0,1), multiples of 2^-24. Only the lanes of `where` advance their generator.
  HWY_INLINE B next(Mask where) {
    state_ = hn::IfThenElse(hn::RebindMask(Ints(), where.m), step(state_), state_);
    const hn::RebindToSigned<FloatLanes> ints;
    return B{hn::ConvertTo(FloatLanes(), hn::BitCast(ints, hn::ShiftRight<8>(output(state_))))} * c(0x1p-24);
  }

 private:
  static HWY_INLINE Int k(std::uint32_t value) { return hn::Set(Ints(), value); }
  static HWY_INLINE Int step(Int s) { return hn::Add(hn::Mul(s, k(747796405u)), k(2891336453u)); }
  static HWY_INLINE Int output(Int s) {
    const Int w = hn::Mul(hn::Xor(hn::Shr(s, hn::Add(hn::ShiftRight<28>(s), k(4))), s), k(277803737u));
    return hn::Xor(hn::ShiftRight<22>(w), w);
  }

  Int state_;
};

// Number of ended lanes that wait for each other, to share the four evaluations for their normals. kLanes / 2 was the
// fastest of 1 to 16.
#ifndef FATHOM_SETTLE
#define FATHOM_SETTLE (kLanes / 2)
#endif
constexpr std::size_t kSettle = FATHOM_SETTLE;

// Workload P: one path per lane.
template <class Scene>
class PathPackets {
 public:
  PathPackets(const View& view, const Frame& frame, Picture& picture)
      : view_(view), frame_(frame), camera_(view, frame), picture_(picture) {
    const auto pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    picture = {0, 0, std::vector<float>(pixels)};
    paths_ = pixels * static_cast<std::size_t>(frame.spp);
  }

  void run() {
    const Mask all = c(0) == c(0), none = !all;
    refill(all);
    const B epsilon = c(view_.epsilon), t_max = c(view_.t_max);
    Mask hit = none, missed = none, under_way = alive_;
    while (any(under_way)) {
      const B q = field<Scene>(origin_ + direction_ * t_);
      steps_ = steps_ + c(1);
      const Mask hits = under_way & (q < epsilon);
      under_way = and_not(hits, under_way);
      t_ = select(under_way, t_ + q, t_);
      const Mask misses = under_way & ((t_ > t_max) | (steps_ >= c(kMaxSteps)));
      under_way = and_not(misses, under_way);
      hit = hit | hits;
      missed = missed | misses;
      const Mask ended = hit | missed;
      if (!any(ended) || (count(ended) < kSettle && any(under_way))) continue;
      settle(hit, missed);
      under_way = alive_;
      hit = missed = none;
    }
    for (float& pixel : picture_.pixels) pixel /= static_cast<float>(frame_.spp);
  }

 private:
  void settle(Mask hit, Mask missed) {
    picture_.rays += count(hit | missed);
    const Mask bounces = hit & (bounces_ < c(kMaxBounces)), ended = and_not(bounces, hit | missed);
    if (any(bounces)) bounce(bounces);
    // Adds the throughput of ended paths to their pixels, except for paths whose last surface is black.
    alignas(64) float value[kLanes], which[kLanes];
    select(missed, throughput_, c(0)).store(value);
    fraction_of(ended).store(which);
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (which[i] != 0) picture_.pixels[pixel_[i]] += value[i];
    }
    if (any(ended)) refill(ended);
  }

  HWY_INLINE void bounce(Mask where) {
    const V p = origin_ + direction_ * t_, n = tetrahedron_normal<Scene>(p, c(view_.epsilon));
    const B z = c(1) - c(2) * random_.next(where), r = sqrt(max(c(0), c(1) - z * z));
    const SinCos<B> phi = sin_cos(c(6.283185307179586) * random_.next(where));
    origin_ = select(where, p + n * c(4 * view_.epsilon), origin_);
    direction_ = select(where, normalize(n + V{r * phi.cos, r * phi.sin, z}), direction_);
    throughput_ = select(where, throughput_ * c(kAlbedo), throughput_);
    bounces_ = select(where, bounces_ + c(1), bounces_);
    t_ = select(where, c(0), t_);
    steps_ = select(where, c(0), steps_);
  }

  // Starts new camera paths in these lanes, in order, until none are left.
  HWY_INLINE void refill(Mask where) {
    alignas(64) float wanted[kLanes], x[kLanes], y[kLanes], taken[kLanes] = {};
    alignas(64) std::uint32_t seed[kLanes] = {};
    fraction_of(where).store(wanted);
    for (std::size_t i = 0; i < kLanes; ++i) {
      x[i] = y[i] = 0;
      if (wanted[i] == 0 || next_ == paths_) continue;
      pixel_[i] = next_ / static_cast<std::size_t>(frame_.spp);
      x[i] = static_cast<float>(pixel_[i] % static_cast<std::size_t>(frame_.width));
      y[i] = static_cast<float>(pixel_[i] / static_cast<std::size_t>(frame_.width));
      seed[i] = static_cast<std::uint32_t>(next_++);
      taken[i] = 1;
    }
    const Mask begins = B::load(taken) > c(0);
    alive_ = begins | and_not(where, alive_);
    random_.seed(begins, hn::Load(Random::Ints(), seed));
    const B jx = random_.next(begins), jy = random_.next(begins);
    origin_ = select(begins, camera_.eye(), origin_);
    direction_ = select(begins, camera_.direction(B::load(x) + jx, B::load(y) + jy), direction_);
    throughput_ = select(begins, c(1), throughput_);
    bounces_ = select(begins, c(0), bounces_);
    t_ = select(begins, c(0), t_);
    steps_ = select(begins, c(0), steps_);
  }

  const View view_;
  const Frame frame_;
  const Pinhole camera_;
  Picture& picture_;
  std::size_t next_ = 0, paths_;
  std::size_t pixel_[kLanes] = {};
  V origin_{c(0), c(0), c(0)}, direction_{c(0), c(0), c(1)};
  B t_ = c(0), steps_ = c(0), throughput_ = c(0), bounces_ = c(0);
  Mask alive_ = c(0) < c(0);
  Random random_;
};

template <class Scene>
void render_paths(const View& view, const Frame& frame, Picture& picture) {
  PathPackets<Scene>(view, frame, picture).run();
}

}  // namespace
}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
