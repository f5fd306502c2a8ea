// The frames of an animated scene: the requested range, their times, and the scene's arguments for each frame.
// Tested by: tests/runtime/cli/frames/cli_frames_test.cpp
#pragma once

#include <string>
#include <variant>

#include "compiler/frontend/animation.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/frame_options.h"

namespace fathom::cli {

// The requested frames of an animated scene.
struct Sequence {
  compiler::Animation animation;
  FrameRange frames;
  double fps;

  double time_of(int frame) const { return frame / fps; }  // seconds
  // Returns `arguments` with the definitions for the frame's time and number.
  SceneArguments at(const SceneArguments& arguments, int frame) const;
  std::string describe(int frame) const;  // "frame 37 (1.542 s)"
};

// Returns the requested frames. Prints a message and returns an exit code if the scene is not animated, if --frames
// all is given and the scene declares no number of frames, or if the command line also defines the time. Also loads
// the scene's imports into `input`.
std::variant<Sequence, ExitCode> sequence_of(const FrameOptions& options, SceneInput& input,
                                             const SceneArguments& arguments, const Streams& streams);

}  // namespace fathom::cli
