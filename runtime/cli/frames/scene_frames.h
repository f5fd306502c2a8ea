// The frames of a scene that moves: those that --frames asks for, their times, and the scene's arguments for each.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <string>
#include <variant>

#include "compiler/frontend/animation.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/frame_options.h"

namespace fathom::cli {

// The frames of a scene that moves.
struct Sequence {
  compiler::Animation animation;
  FrameRange frames;
  double fps;

  double time_of(int frame) const { return frame / fps; }  // seconds
  // The scene's arguments for the frame.
  SceneArguments at(const SceneArguments& arguments, int frame) const;
  std::string describe(int frame) const;  // "frame 37 (1.542 s)"
};

// Those asked for, or the exit code after a message when the scene does not move, does not say how many frames there
// are, or is given its time on the command line, too. The input has what the scene imports, then.
std::variant<Sequence, ExitCode> sequence_of(const FrameOptions& options, SceneInput& input,
                                             const SceneArguments& arguments, const Streams& streams);

}  // namespace fathom::cli
