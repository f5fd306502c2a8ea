// Settings of the picture and of its paths, from the scene file or the command line: the structs that follow from the
// table settings.def, and the table itself.
// Tested by: tests/compiler/scene/settings_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

namespace fathom::compiler {

inline constexpr int kMaxSide = 65535;  // pixels; the maximum of the image formats
inline constexpr int kMaxSpp = 1 << 20, kMaxDepth = 4096, kMaxTile = 1024;
inline constexpr double kMaxExposure = 100;                            // stops, of either sign
inline constexpr double kMinFilterWidth = 0.01, kMaxFilterWidth = 64;  // pixels
inline constexpr double kMaxNoiseThreshold = 1e6;
inline constexpr int kMaxFrames = 100'000'000;
inline constexpr double kUsualFps = 24, kMinFps = 1e-3, kMaxFps = 1e6;  // frames per second

// Reconstruction filter: the weight of light around a pixel's centre (runtime/sampling/filter.h).
enum class FilterKind { Box, Tent, Gaussian, BlackmanHarris, Mitchell };
inline constexpr std::array<std::string_view, 5> kFilterNames = {"box", "tent", "gaussian", "blackman-harris",
                                                                 "mitchell"};  // [FilterKind]
// Map from light to a display (runtime/image/tone.h), and its names in scene files and on the command line, in order.
enum class ToneCurve { None, Filmic, Aces, Agx, Neutral };
inline constexpr std::array<std::string_view, 5> kToneCurves = {"none", "filmic", "aces", "agx", "neutral"};

// Source of a render's random numbers (runtime/sampling/sampler.h).
enum class SamplerKind : std::uint8_t { Blue, Sobol, Independent };
inline constexpr std::array<std::string_view, 3> kSamplerNames = {"blue", "sobol", "independent"};  // [SamplerKind]

// Light sampling: multiple importance sampling (Mis) of the other two, next-event estimation alone (Nee), or BSDF
// sampling alone (Bsdf). Nee and Bsdf are for comparisons. All three find lights without a size by next-event
// estimation, because no path can hit them.
enum class LightSampling { Mis, Nee, Bsdf };
inline constexpr std::array<std::string_view, 3> kLightSamplingNames = {"mis", "nee", "bsdf"};  // [LightSampling]

// Names of an enum's values, in order.
constexpr std::span<const std::string_view> words_of(FilterKind) { return kFilterNames; }
constexpr std::span<const std::string_view> words_of(ToneCurve) { return kToneCurves; }
constexpr std::span<const std::string_view> words_of(SamplerKind) { return kSamplerNames; }
constexpr std::span<const std::string_view> words_of(LightSampling) { return kLightSamplingNames; }

struct Film {
#define FILM_SETTING(type, name, fallback, ...) type name = fallback;
#define RENDER_SETTING(...)
#include "compiler/scene/settings.def"
#undef FILM_SETTING
#undef RENDER_SETTING
};

struct RenderSettings {
#define FILM_SETTING(...)
#define RENDER_SETTING(type, name, fallback, ...) type name = fallback;
#include "compiler/scene/settings.def"
#undef FILM_SETTING
#undef RENDER_SETTING
};

template <typename T>
struct ValueOf {
  using Type = T;
};
template <typename T>
struct ValueOf<std::optional<T>> {
  using Type = T;
};
// Type of a setting that is present.
template <typename T>
using SettingValue = typename ValueOf<T>::Type;

// Settings that take the place of the scene's.
struct SettingsOverrides {
#define FILM_SETTING(type, name, ...) std::optional<SettingValue<type>> name;
#define RENDER_SETTING FILM_SETTING
#include "compiler/scene/settings.def"
#undef FILM_SETTING
#undef RENDER_SETTING
};

// Returns the scene's settings with the overrides in place of its values. A filter that is given without a width has
// the filter's own width.
Film with_overrides(Film film, const SettingsOverrides& overrides);
RenderSettings with_overrides(RenderSettings settings, const SettingsOverrides& overrides);

// Valid numbers of a setting: [least, most], or all above zero.
struct SettingRange {
  double least = 0, most = 0;
  bool above_zero = false;
};

// Headings of `fathom render --help` with options of settings.
enum class OptionGroup { Picture, Renderer, Light };

// The option of `fathom render`, in the form of Arguments::option(). `hint` is help for a number out of range.
struct SettingOption {
  OptionGroup group = OptionGroup::Renderer;
  std::string_view names = {}, placeholder = {}, help = {}, hint = {};
};

// The row in the identity of films. A setting without a value has the text `absent`, or no row if the text is empty.
struct SettingIdentity {
  std::string_view row = {}, absent = {};
};

// A row of the table.
template <typename RecordType, typename MemberType>
struct Setting {
  using Record = RecordType;  // Film or RenderSettings
  using Member = MemberType;
  using Value = SettingValue<Member>;
  std::string_view name;
  Member Record::*member;
  std::optional<Value> SettingsOverrides::*overriding;
  SettingRange range;
  std::string_view doc;      // empty: not a property of scene files
  SettingOption option;      // without names: no option, or an option of its own code
  SettingIdentity identity;  // without a row: changes no sample, or has a row of its own code
};

// Words of the table's columns.
namespace setting_columns {

constexpr SettingRange between(double least, double most) { return {least, most}; }
inline constexpr SettingRange above_zero{.above_zero = true}, all_bits{}, words{};
constexpr SettingOption option(OptionGroup group, std::string_view names, std::string_view placeholder,
                               std::string_view help, std::string_view hint = {}) {
  return {group, names, placeholder, help, hint};
}
inline constexpr SettingOption no_option{};
constexpr SettingIdentity identity(std::string_view row, std::string_view absent = {}) { return {row, absent}; }
inline constexpr SettingIdentity no_identity{};

}  // namespace setting_columns

// Calls `use` with every row of the table, in order.
template <typename Use>
void for_each_setting(const Use& use) {
  using namespace setting_columns;
#define SETTING(record, type, name, range, doc, option, identity) \
  use(Setting<record, type>{#name, &record::name, &SettingsOverrides::name, range, doc, option, identity});
#define FILM_SETTING(type, name, fallback, ...) SETTING(Film, type, name, __VA_ARGS__)
#define RENDER_SETTING(type, name, fallback, ...) SETTING(RenderSettings, type, name, __VA_ARGS__)
#include "compiler/scene/settings.def"
#undef SETTING
#undef FILM_SETTING
#undef RENDER_SETTING
}

// Calls `use` with every row of Film or of RenderSettings.
template <typename Record, typename Use>
void for_each_setting_of(const Use& use) {
  for_each_setting([&](const auto& setting) {
    if constexpr (std::is_same_v<typename std::remove_cvref_t<decltype(setting)>::Record, Record>) use(setting);
  });
}

}  // namespace fathom::compiler
