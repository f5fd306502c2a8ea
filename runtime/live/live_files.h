// The texts of the scripts live_*.js together, of live.frag and of live.css in runtime/live/, which the build puts
// into the program.
#pragma once

#include <string_view>

namespace fathom::runtime {

extern const std::string_view kLiveScript, kLiveShader, kLiveStyle;

}  // namespace fathom::runtime
