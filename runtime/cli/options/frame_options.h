// The options for animated scenes, such as --frames and --fps, and the names of the frames' files.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <optional>
#include <string>

#include "runtime/cli/options/arguments.h"

namespace fathom::cli {

// Frames first, first + step, ..., all less than `last`.
struct FrameRange {
  int first = 0, last = 1, step = 1;

  int count() const { return (last - first - 1) / step + 1; }
  int at(int index) const { return first + index * step; }
};

struct FrameOptions {
  bool all = false;  // --frames all: as many as the scene declares
  std::optional<FrameRange> range;
  std::optional<double> fps;
  bool fixed_noise = false;
  std::optional<int> shutter_times;

  bool given() const { return all || range; }
};

// Adds --frames only.
void add_frames_option(Arguments& arguments, const std::string& doc, FrameOptions& options);
// Adds --frames and --fps.
void add_frame_options(Arguments& arguments, FrameOptions& options);
// Adds the motion options of `fathom render`, in a group of their own.
void add_motion_options(Arguments& arguments, FrameOptions& options);

// Returns the file name of a frame. The frame's number replaces the last run of # in the name, padded to one digit
// per #. A name without # gets four digits before its ending. In a folder, "dir/", the number is the name.
//
//     "out.png", 7 -> "out-0007.png"      "shot.##.exr", 7 -> "shot.07.exr"      "dir/", 7 -> "dir/0007"
std::string numbered(const std::string& path, int frame);

}  // namespace fathom::cli
