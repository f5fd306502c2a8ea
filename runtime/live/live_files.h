// The texts of runtime/live/live.js, live.frag and live.css, which the build puts into the program.
#pragma once

#include <string_view>

namespace fathom::runtime {

extern const std::string_view kLiveScript, kLiveShader, kLiveStyle;

}  // namespace fathom::runtime
