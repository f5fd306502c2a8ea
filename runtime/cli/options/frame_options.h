// The options that say which moments of a scene that moves are rendered, --frames, --fps and what goes with them;
// and the names of the files of frames.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <optional>
#include <string>

#include "runtime/cli/options/arguments.h"

namespace fathom::cli {

// Frames first, first + step, ... before `last`.
struct FrameRange {
  int first = 0, last = 1, step = 1;

  int count() const { return (last - first + step - 1) / step; }
  int at(int index) const { return first + index * step; }
};

struct FrameOptions {
  bool all = false;  // that the scene says there are
  std::optional<FrameRange> range;
  std::optional<double> fps;
  bool fixed_noise = false;
  std::optional<int> shutter_times;

  bool given() const { return all || range; }
};

// --frames alone.
void add_frames_option(Arguments& arguments, const std::string& doc, FrameOptions& options);
// --frames and --fps.
void add_frame_options(Arguments& arguments, FrameOptions& options);
// Those of a render, in a group of their own.
void add_motion_options(Arguments& arguments, FrameOptions& options);

// The name of a frame's file: the frame's number takes the place of the row of # in the name, of which each is a
// digit and there are more where the number needs them; without any it comes before the ending, in four digits. Of a
// folder, "dir/", the number is the name.
//
//     "out.png", 7 -> "out-0007.png"      "shot.##.exr", 7 -> "shot.07.exr"      "dir/", 7 -> "dir/0007"
std::string numbered(const std::string& path, int frame);

}  // namespace fathom::cli
