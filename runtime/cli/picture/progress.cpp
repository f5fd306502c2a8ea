#include "runtime/cli/picture/progress.h"

#include <fmt/format.h>

#include <cmath>
#include <ostream>

namespace fathom::cli {
namespace {

constexpr double kRedrawSeconds = 0.1;  // minimum interval on a terminal
// For logs: a line for every tenth of the work or every ten seconds, but at most one per second.
constexpr double kLineFraction = 0.1, kLineSeconds = 10, kMinSeconds = 1;
constexpr double kTrustedSeconds = 0.5;  // before this, an estimate of the remaining time is noise

std::string describe(const runtime::Progress& progress) {
  const double rate = progress.seconds > 0 ? static_cast<double>(progress.rays) / progress.seconds : 0;
  std::string line = fmt::format("{:3.0f} %   {:.2f} Mray/s", std::floor(progress.fraction * 100), rate * 1e-6);
  const double done = progress.fraction - progress.resumed;
  if (done > 0 && progress.fraction < 1 && progress.seconds > kTrustedSeconds) {
    line += "   about " + duration(progress.seconds * (1 - progress.fraction) / done) + " left";
  }
  return line;
}

}  // namespace

std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

ProgressLine::~ProgressLine() { erase(); }

void ProgressLine::erase() {
  if (drawn_ && streams_.terminal) streams_.err << "\r\033[K" << std::flush;
  drawn_ = false;
}

bool ProgressLine::due(const runtime::Progress& progress) const {
  const double since = progress.seconds - last_seconds_;
  if (streams_.terminal) return since >= kRedrawSeconds;
  if (progress.fraction >= 1) return false;
  return since >= kLineSeconds || (since >= kMinSeconds && progress.fraction - last_fraction_ >= kLineFraction);
}

void ProgressLine::update(const runtime::Progress& progress) {
  if (!due(progress)) return;
  last_seconds_ = progress.seconds;
  last_fraction_ = progress.fraction;
  drawn_ = true;
  if (streams_.terminal) {
    streams_.err << '\r' << prefix_ << describe(progress) << "\033[K" << std::flush;
  } else {
    streams_.err << prefix_ << describe(progress) << '\n' << std::flush;
  }
}

}  // namespace fathom::cli
