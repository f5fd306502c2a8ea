// Simulates a farm of ten thousand machines: which size of units finishes first, and the cost of merging their films.
//
//     build/release/bench_farm [SCENE]
//
// The cost of a unit is that of a real image's pixels (runtime/cli/plan/pixel_costs.h). The cost of merging is
// measured on films written and read. Machines, queue and disk are numbers, kFarms. Machines take units in order from
// one queue, which starts a limited number of units per second. Machines differ in speed, and one in a hundred is
// four times slower. Machines are lost at random. The queue notices a loss after a while, and the unit continues from
// its checkpoint on another machine. All machines write to one disk, which serves one request at a time. The ratio is
// the time to the last film over the time of the same machines without any of these delays, so 1 is the optimum. The
// percentages say where the machines' time went. The last row of each table has the unit size that `fathom plan`
// chooses with --workers. Each row is the median of three farms drawn at random. One process on one thread merges the
// films.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "bench/scene_file.h"
#include "runtime/cli/plan/pixel_costs.h"
#include "runtime/cli/plan/plan_grid.h"
#include "runtime/film/film_file.h"
#include "runtime/render.h"

namespace fathom::bench {
namespace {

constexpr double kSpread = 0.15;               // standard deviation of the logarithm of machines' speeds
constexpr double kSlow = 0.01, kSlowness = 4;  // fraction of slow machines, and their slowdown factor
constexpr double kReplaced = 600;              // seconds until a lost machine is replaced
constexpr double kUnitOperations = 20, kMergeOperations = 3;  // disk operations per unit (strace)

struct Farm {
  const char* name;
  double start;                  // seconds per unit before its first sample: queue, loading and compiling
  double starts_per_second;      // by the queue
  double lost_after, noticed;    // mean hours until a machine is lost; seconds until the queue notices
  double operations, bandwidth;  // disk operations per second; bytes per second
  double checkpoint;             // seconds between checkpoints of a unit
};
constexpr Farm kFarms[] = {{"cluster", 1, 200, 24 * 30, 300, 20'000, 5e9, 600},
                           {"spot machines", 10, 200, 6, 300, 20'000, 5e9, 600},
                           {"slow disk", 1, 200, 24 * 30, 300, 2'000, 1e9, 600},
                           {"cluster, a checkpoint each minute", 1, 200, 24 * 30, 300, 20'000, 5e9, 60}};

constexpr double kUnitSeconds[] = {15, 30, 60, 120, 300, 600, 1800};
constexpr double kMinutes[] = {10, 60, 480};  // of work per machine
constexpr int kMachines[] = {10'000, 100};
constexpr std::uint64_t kMaxUnits = 20'000'000;  // max number of simulated units

struct Tally {
  double end = 0;  // seconds
  // Machine-seconds, except `disk_busy`: seconds of the disk.
  double started = 0, lost = 0, waited = 0, disk_busy = 0;
};

// One render on one farm.
class Simulation {
 public:
  // `costs`: seconds per unit of a frame on a machine of speed 1. `bytes`: size of a film.
  Simulation(const Farm& farm, int machines, std::vector<double> costs, std::uint64_t units, double bytes,
             unsigned seed)
      : farm_(farm),
        costs_(std::move(costs)),
        units_(units),
        service_(kUnitOperations / farm.operations + bytes / farm.bandwidth),
        random_(seed) {
    std::normal_distribution<double> logarithm(0, kSpread);
    std::bernoulli_distribution slow(kSlow);
    for (int machine = 0; machine < machines; ++machine) {
      speeds_.push_back(std::exp(logarithm(random_)) / (slow(random_) ? kSlowness : 1));
      events_.push({0, Event::Free, machine, 0});
    }
  }

  double speed() const {
    double sum = 0;
    for (const double speed : speeds_) sum += speed;
    return sum;
  }

  Tally run() {
    while (done_ < units_) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.time;
      switch (event.kind) {
        case Event::Free:
          give(event.machine);
          break;
        case Event::Computed:
          write(event);
          break;
        case Event::Written:
          ++done_;
          give(event.machine);
          break;
        case Event::Noticed:
          take_back(event.left);
          break;
      }
    }
    tally_.end = now_;
    return tally_;
  }

 private:
  struct Event {
    double time;
    enum Kind { Free, Computed, Written, Noticed } kind;
    int machine;
    double left;  // remaining seconds of the unit at speed 1
    bool operator>(const Event& other) const { return time > other.time; }
  };

  void give(int machine) {
    if (!returned_.empty()) {
      start(machine, returned_.back());
      returned_.pop_back();
    } else if (next_ < units_) {
      start(machine, costs_[next_++ % costs_.size()]);
    } else {
      idle_.push_back(machine);
    }
  }

  void take_back(double left) {
    returned_.push_back(left);
    if (idle_.empty()) return;
    const int machine = idle_.back();
    idle_.pop_back();
    give(machine);
  }

  void start(int machine, double left) {
    const double begin = std::max(now_, queue_free_);
    queue_free_ = begin + 1 / farm_.starts_per_second;
    const double speed = speeds_[static_cast<std::size_t>(machine)], computing = left / speed;
    const double lost = std::exponential_distribution<double>(1 / (3600 * farm_.lost_after))(random_);
    tally_.waited += begin - now_;
    if (lost >= farm_.start + computing) {
      checkpoint(computing);
      tally_.started += farm_.start;
      events_.push({begin + farm_.start + computing, Event::Computed, machine, 0});
      return;
    }
    const double computed = std::max(0.0, lost - farm_.start),
                 kept = std::floor(computed / farm_.checkpoint) * farm_.checkpoint;
    checkpoint(computed);
    tally_.lost += lost - kept + kReplaced;
    events_.push({begin + lost + farm_.noticed, Event::Noticed, 0, left - kept * speed});
    events_.push({begin + lost + kReplaced, Event::Free, machine, 0});
  }

  // Charges the disk for the unit's checkpoints. The machine writes them while rendering and does not wait.
  void checkpoint(double computing) {
    disk_free_ = std::max(disk_free_, now_);
    for (double at = farm_.checkpoint; at < computing; at += farm_.checkpoint) disk_free_ += busy();
  }

  void write(const Event& event) {
    disk_free_ = std::max(disk_free_, now_) + busy();
    tally_.waited += disk_free_ - now_;
    events_.push({disk_free_, Event::Written, event.machine, 0});
  }

  double busy() {
    tally_.disk_busy += service_;
    return service_;
  }

  const Farm& farm_;
  const std::vector<double> costs_;
  const std::uint64_t units_;
  const double service_;  // disk seconds per film
  std::mt19937_64 random_;
  std::vector<double> speeds_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::vector<double> returned_;
  std::vector<int> idle_;
  std::uint64_t next_ = 0, done_ = 0;
  double now_ = 0, queue_free_ = 0, disk_free_ = 0;
  Tally tally_;
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Processor time to read a unit's film and add it to the frame's: per unit, plus per pixel of the unit.
struct MergeCost {
  double unit, pixel;  // seconds
  double bytes;        // per pixel, in a film file
};

MergeCost measure_merging(const compiler::CompiledScene& scene) {
  runtime::keep_freed_memory();
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("bench_farm-{}.film", getpid());
  std::vector<double> seconds;
  double bytes = 0;
  constexpr int kSides[] = {8, 256}, kRounds = 20;
  for (const int side : kSides) {
    runtime::RenderOptions options;
    options.width = options.height = side;
    options.sample_range = {0, 1};
    options.layers = runtime::kAllLayers;
    const runtime::RenderResult result = runtime::render(scene, options);
    runtime::FilmHeader header;
    runtime::PartialRender render{result.film, std::vector<runtime::Coverage>(1), {}};
    header.width = header.height = side;
    header.samples = {0, 1};
    render.covered.front().add({result.film.area(), {0, 1}});
    if (const auto problem = write_film(header, render, path.string())) {
      fmt::print(stderr, "bench_farm: {}\n", *problem);
      std::exit(74);
    }
    bytes = static_cast<double>(std::filesystem::file_size(path)) / (side * side);
    runtime::Film sum(result.film.area(), result.film.layers());
    const double begin = now();
    for (int round = 0; round < kRounds; ++round)
      sum.merge(std::get<runtime::FilmFile>(runtime::read_film(path.string())).render.film);
    seconds.push_back((now() - begin) / kRounds);
  }
  std::filesystem::remove(path);
  const double pixel = (seconds[1] - seconds[0]) / (kSides[1] * kSides[1] - kSides[0] * kSides[0]);
  return {std::max(0.0, seconds[0] - pixel * kSides[0] * kSides[0]), pixel, bytes};
}

// A render on a number of machines, with its known costs.
struct Job {
  const cli::PixelCosts& costs;
  const MergeCost& merging;
  cli::PlanGrid grid;
  int machines;

  double frame_seconds() const { return costs.sum({0, 0, grid.width, grid.height}) * grid.spp; }
  double all_seconds() const { return frame_seconds() * static_cast<double>(grid.frame_count()); }
};

void simulate(const Farm& farm, const Job& job, double unit_seconds, const char* mark) {
  cli::PlanGrid grid = job.grid;
  cut(grid, false, job.frame_seconds(), unit_seconds);
  if (grid.units() > kMaxUnits) return;
  std::vector<double> costs;
  for (std::uint64_t number = 0; number < grid.units_of_frame(); ++number) {
    const cli::PlanUnit unit = unit_of(grid, number);
    costs.push_back(job.costs.sum(unit.area) * unit.samples.size());
  }
  const double longest = *std::ranges::max_element(costs);
  const double pixels = static_cast<double>(grid.width) * grid.height / grid.columns / grid.rows;
  const double units = static_cast<double>(grid.units()), bytes = pixels * job.merging.bytes;
  // The median by ratio of three farms.
  std::vector<std::pair<double, Tally>> runs;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Simulation simulation(farm, job.machines, costs, grid.units(), bytes, seed);
    const Tally tally = simulation.run();
    runs.emplace_back(tally.end * simulation.speed() / job.all_seconds(), tally);
  }
  std::ranges::sort(runs, {}, [](const auto& run) { return run.first; });
  const auto& [ratio, tally] = runs[1];
  const double machines = tally.end * job.machines / 100;
  const double merge = units * (job.merging.unit + pixels * job.merging.pixel + kMergeOperations / farm.operations +
                                bytes / farm.bandwidth);
  fmt::print("{:>6.0f} {:>7.0f} {:>9} {:>8.0f} {:>6.2f} {:>6.1f} {:>5.1f} {:>5.1f} {:>5.0f} {:>7.0f} {:>9.1f}  {}\n",
             unit_seconds, longest, grid.units(), tally.end, ratio, tally.started / machines, tally.lost / machines,
             tally.waited / machines, 100 * tally.disk_busy / tally.end, units * bytes / 1e9, merge / 60, mark);
}

void simulate(const Farm& farm, const Job& job) {
  fmt::print("\n{} of {}x{} and {} samples, {:.0f} s each; {} machines, {:.0f} min each; {}\n",
             job.grid.frames ? fmt::format("{} frames", job.grid.frame_count()) : "a still", job.grid.width,
             job.grid.height, job.grid.spp, job.frame_seconds(), job.machines, job.all_seconds() / job.machines / 60,
             farm.name);
  fmt::print("unit s longest     units  seconds  ratio start% lost% wait% disk%      GB merge min\n");
  for (const double seconds : kUnitSeconds) simulate(farm, job, seconds, "");
  simulate(farm, job, cli::default_unit_seconds(job.all_seconds(), job.machines), "fathom plan");
}

void run(const std::string& path) {
  const compiler::CompiledScene scene = read_scene("bench_farm", path);
  const MergeCost merging = measure_merging(scene);
  fmt::print("{}; a film: {:.0f} bytes a pixel; merging one: {:.0f} us and {:.0f} ns a pixel\n", path, merging.bytes,
             merging.unit * 1e6, merging.pixel * 1e9);
  cli::PlanGrid film;
  film.width = 1920, film.height = 1080, film.spp = film.block = 1024;
  const cli::PixelCosts costs(scene, {}, film.width, film.height, film.spp);
  for (const int machines : kMachines) {
    for (const double minutes : kMinutes) {
      Job job{costs, merging, film, machines};
      const double frames = minutes * 60 * machines / job.frame_seconds();
      job.grid.frames = cli::FrameRange{0, static_cast<int>(std::ceil(frames)), 1};
      for (const Farm& farm : kFarms) simulate(farm, job);
    }
  }
  cli::PlanGrid still;
  still.width = 3840, still.height = 2160, still.spp = still.block = 4096;
  const cli::PixelCosts costs_of_still(scene, {}, still.width, still.height, still.spp);
  for (const Farm& farm : kFarms) simulate(farm, Job{costs_of_still, merging, still, kMachines[1]});
}

}  // namespace
}  // namespace fathom::bench

int main(int argc, char** argv) {
  fathom::bench::run(argc > 1 ? argv[1] : FATHOM_SOURCE_DIR "/scenes/gallery/still-life.json");
}
