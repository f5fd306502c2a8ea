// The colours of an OpenEXR file in linear sRGB: luminance and chroma, grey, other primaries, the names of layers.
// Source: F. Kainz, "Technical Introduction to OpenEXR", 2009: "Luminance/Chroma Images", "CIE XYZ Color".
// Tested by: tests/runtime/image/exr_kinds_test.cpp
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/image/color_space.h"
#include "runtime/image/float_image.h"

namespace fathom::runtime {

// Returns what follows the name of the layer: "RY" of "left.RY".
std::string_view name_in_layer(std::string_view channel);

// Returns what the names of the layers with colours begin with: "" or "left.". `luminance`: only those with Y alone. A
// layer with X and Y has vectors.
std::set<std::string> color_layers(const std::vector<ChannelName>& channels, bool luminance = false);

// Gives every layer R, G and B in linear sRGB.
//
//     Y          grey
//     Y, RY, BY  luminance and chroma; chroma may have every second column and row only
//     R, G, B    converted from the primaries `from`
//
// If the file has no R, and one layer alone has colours, that layer's channels lose its name. The channels
// `subsampled`, of an image of even width and height, have values in even columns and rows alone. Returns the problem
// if there is one.
std::optional<std::string> decode_colors(FloatImage& image, const Chromaticities& from,
                                         const std::set<std::string>& subsampled);

}  // namespace fathom::runtime
