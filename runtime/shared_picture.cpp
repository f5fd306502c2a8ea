#include "runtime/shared_picture.h"

#include "runtime/film.h"

namespace fathom::runtime {
SharedPicture::SharedPicture(PartialRender& render, std::uint64_t samples, const RenderOptions& options,
                             Clock::time_point start)
    : render_(render),
      options_(options),
      samples_(static_cast<double>(samples)),
      resumed_(options.resume_from ? render.film.samples() : 0),
      start_(start),
      done_(resumed_) {}

bool SharedPicture::add(const Film& film, const SampleBlock& unit, std::size_t stage, std::uint64_t samples,
                        std::uint64_t rays) {
  const std::lock_guard lock(mutex_);
  const bool room = render_.film.merge(film, stage);
  render_.covered[stage].add(unit);
  done_ += samples;
  rays_ += rays;
  if (options_.on_progress && samples > 0) {
    const auto share = [&](std::uint64_t count) { return static_cast<double>(count) / samples_; };
    options_.on_progress({share(done_), share(resumed_), rays_, seconds()});
  }
  return room;
}

void SharedPicture::look(const std::function<void(const PartialRender&)>& use) {
  const std::lock_guard lock(mutex_);
  for (Coverage& covered : render_.covered) covered.tidy();
  use(render_);
}

void SharedPicture::change(const std::function<void()>& make) {
  const std::lock_guard lock(mutex_);
  make();
}

bool SharedPicture::stopped() {
  if (options_.cancel && options_.cancel->load(std::memory_order_relaxed)) {
    end_ = RenderEnd::Cancelled;
  } else if (options_.time_limit && seconds() >= *options_.time_limit) {
    end_ = RenderEnd::TimeLimit;
  }
  return end_ != RenderEnd::Done;
}

double SharedPicture::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace fathom::runtime
