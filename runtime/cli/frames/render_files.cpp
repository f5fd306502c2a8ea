#include "runtime/cli/frames/render_files.h"

#include "runtime/cli/picture/cost_map.h"
#include "runtime/cli/picture/render_job.h"

namespace fathom::cli {

std::vector<std::string> finished_files(const RenderRequest& request) {
  std::vector<std::string> files = files_of(image_files_of(request));
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) files.push_back(map);
  }
  return files;
}

std::vector<std::string> output_files(const RenderRequest& request) {
  std::vector<std::string> files = finished_files(request);
  if (request.stats_json && *request.stats_json != "-" && !is_special(*request.stats_json)) {
    files.push_back(*request.stats_json);
  }
  if (const auto checkpoint = checkpoint_of(request)) files.push_back(checkpoint->path());
  return files;
}

std::optional<ExitCode> check_outputs(const RenderRequest& request, const Streams& streams) {
  if (const auto code = check_paths(image_files_of(request), streams)) return code;
  if (const auto checkpoint = checkpoint_of(request)) {
    if (const auto code = checkpoint->check_path(streams)) return code;
  }
  if (request.cost_map) {
    for (const std::string& map : cost_map_files(*request.cost_map)) {
      if (const auto problem = runtime::check_file_path(map)) return fail(streams, kIo, *problem);
    }
  }
  if (request.stats_json) {
    const bool stream = *request.stats_json == "-";
    if (const auto problem = stream ? std::nullopt : check_text_path(*request.stats_json))
      return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

}  // namespace fathom::cli
