#include "runtime/shared_film.h"

#include <algorithm>

#include "runtime/film/film.h"

namespace fathom::runtime {
SharedFilm::SharedFilm(PartialRender& render, std::uint64_t samples, const RenderOptions& options,
                       Clock::time_point start)
    : render_(render),
      options_(options),
      samples_(static_cast<double>(samples)),
      resumed_(options.resume_from ? render.film.samples() : 0),
      start_(start),
      done_(resumed_) {}

bool SharedFilm::add(const Film& film, const SampleBlock& unit, std::size_t stage, std::uint64_t samples,
                     std::uint64_t rays) {
  const std::lock_guard lock(mutex_);
  const bool room = render_.film.merge(film, stage);
  render_.covered[stage].add(unit);
  done_ += samples;
  rays_ += rays;
  if (samples > 0) report();
  return room;
}

void SharedFilm::set_remaining(std::uint64_t left) {
  samples_ = static_cast<double>(done_ + left);
  report();
}

void SharedFilm::report() const {
  if (!options_.on_progress) return;
  const auto share = [&](std::uint64_t count) { return static_cast<double>(count) / samples_; };
  options_.on_progress({share(done_), share(resumed_), rays_, seconds()});
}

void SharedFilm::read(const std::function<void(const PartialRender&)>& use) {
  const std::lock_guard lock(mutex_);
  for (Coverage& covered : render_.covered) covered.canonicalise();
  use(render_);
}

void SharedFilm::modify(const std::function<void()>& make) {
  const std::lock_guard lock(mutex_);
  make();
}

bool SharedFilm::should_stop(bool first) {
  if (options_.cancel && options_.cancel->load(std::memory_order_relaxed)) {
    end_ = RenderEnd::Cancelled;
  } else if (!first && options_.time_limit && seconds() >= *options_.time_limit) {
    end_ = RenderEnd::TimeLimit;
  }
  return end_ == RenderEnd::Cancelled || (end_ == RenderEnd::TimeLimit && (!first || is_late()));
}

bool SharedFilm::is_late() {
  if (options_.cancel && options_.cancel->load(std::memory_order_relaxed)) {
    end_ = RenderEnd::Cancelled;
    double never = std::numeric_limits<double>::infinity();
    cancelled_at_.compare_exchange_strong(never, seconds());
  }
  const double limit = options_.time_limit.value_or(std::numeric_limits<double>::infinity());
  if (seconds() >= limit && end_ == RenderEnd::Done) end_ = RenderEnd::TimeLimit;
  return seconds() >= kGraceSeconds + std::min<double>(limit, cancelled_at_);
}

double SharedFilm::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

}  // namespace fathom::runtime
