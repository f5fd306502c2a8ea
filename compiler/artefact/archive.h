// The tables of a compiled scene as JSON, so that one list of fields (fields.cpp) writes and reads them.
//
//     void fields(Archive& a, Film& film) {
//       field(a, "width", film.width, 1, kMaxSide);
//       ...
//     }
//
// A writer copies the values from the fields. A reader copies values to the fields, and fails if a value is missing,
// of another type, out of range or not in its place: equal tables are equal JSON. After the first failure a reader
// leaves the fields as they are. Infinite numbers, which JSON lacks, are the texts "inf" and "-inf".
//
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace fathom::compiler {

using TableJson = nlohmann::ordered_json;

class Archive {
 public:
  Archive() : json_(TableJson::object()) { here_ = &json_; }                                     // writes
  explicit Archive(TableJson json) : json_(std::move(json)), reading_(true) { here_ = &json_; }  // reads

  bool reading() const { return reading_; }
  const TableJson& json() const { return json_; }

  bool failed() const { return !reason_.empty(); }
  // The first failure, after the JSON Pointer (RFC 6901) of the value: "/camera/fov: 4 is not in [0, 3]".
  const std::string& reason() const { return reason_; }
  // Reports that the value at hand makes no sense. The first report stays. Without effect in a writer.
  void fail(std::string_view reason);

  // Reads or writes all of the JSON as one record by use().
  template <typename Use>
  void all(const Use& use) {
    record(json_, use);
  }
  // Calls use(json) with the next member of the record at hand, which must have this name.
  template <typename Use>
  void member(std::string_view name, const Use& use) {
    TableJson* const value = next(name);
    if (value == nullptr) return;
    path_.emplace_back(name);
    use(*value);
    path_.pop_back();
  }
  // Reads or writes the members of the record `json` by use(), all of them.
  template <typename Use>
  void record(TableJson& json, const Use& use) {
    if (!reading_) json = TableJson::object();
    if (failed() || !json.is_object()) return fail("this should be an object");
    TableJson* const outer = std::exchange(here_, &json);
    const std::size_t outer_at = std::exchange(at_, 0);
    use();
    if (reading_ && at_ < json.size()) fail("holds more than it should");
    here_ = outer, at_ = outer_at;
  }
  // Reads or writes `count` elements of the array `json` by use(element, index). Reading, make_room(size) comes
  // first.
  template <typename Room, typename Use>
  void array(TableJson& json, std::size_t count, const Room& make_room, const Use& use) {
    if (!reading_) json = TableJson(count, nullptr);
    if (failed() || !json.is_array()) return fail("this should be an array");
    if (reading_ && !make_room(json.size())) return fail("the array has another size than it should");
    for (std::size_t i = 0; i < json.size() && !failed(); ++i) {
      path_.push_back(std::to_string(i));
      use(json[i], i);
      path_.pop_back();
    }
  }

 private:
  TableJson* next(std::string_view name);

  TableJson json_;
  bool reading_ = false;
  TableJson* here_;                // the record at hand
  std::size_t at_ = 0;             // number of its members read so far
  std::vector<std::string> path_;  // to the value at hand
  std::string reason_;
};

// Parses tables, or returns the reason why not. Refuses deep nesting and large objects, which tables do not have.
std::variant<TableJson, std::string> parse_tables(std::span<const std::uint8_t> bytes, bool cbor);

// Returns the tables as text. Arrays of numbers stand on one line.
std::string print_tables(const TableJson& json);

inline constexpr double kEndless = std::numeric_limits<double>::infinity();

// Read or write a value. Numbers of a reader lie in [least, most] and are not NaN.
void value(Archive& archive, TableJson& json, double& number, double least, double most);
void value(Archive& archive, TableJson& json, std::uint64_t& number, std::uint64_t least, std::uint64_t most);
void value(Archive& archive, TableJson& json, bool& flag);
void value(Archive& archive, TableJson& json, std::string& text);
void choice(Archive& archive, TableJson& json, std::size_t& index, std::span<const std::string_view> names);

template <typename Integer>
requires(std::is_integral_v<Integer> && !std::is_same_v<Integer, std::uint64_t> &&
         !std::is_same_v<Integer, bool>) void value(Archive& archive, TableJson& json, Integer& number,
                                                    std::uint64_t least, std::uint64_t most) {
  auto copy = static_cast<std::uint64_t>(number);
  value(archive, json, copy, least, most);
  number = static_cast<Integer>(copy);
}

// Vectors and matrices of GLM, column by column.
template <typename Vector>
requires requires(Vector v) { v.length(); }
void value(Archive& archive, TableJson& json, Vector& vector, double least, double most) {
  constexpr std::size_t kCount = sizeof(Vector) / sizeof(double);
  auto* numbers = reinterpret_cast<double*>(&vector);
  archive.array(
      json, kCount, [](std::size_t size) { return size == kCount; },
      [&](TableJson& element, std::size_t i) { value(archive, element, numbers[i], least, most); });
}

template <typename Enum>
requires std::is_enum_v<Enum>
void value(Archive& archive, TableJson& json, Enum& member, std::span<const std::string_view> names) {
  auto index = static_cast<std::size_t>(member);
  choice(archive, json, index, names);
  member = static_cast<Enum>(index);
}

// A value that may be missing: null.
template <typename T, typename... Range>
void value(Archive& archive, TableJson& json, std::optional<T>& optional, Range... range) {
  if (!archive.reading() && !optional) return;  // stays null
  if (archive.reading()) optional = json.is_null() ? std::nullopt : std::optional<T>(T());
  if (optional) value(archive, json, *optional, range...);
}

// The member `name`, with the arguments of value() after the JSON.
template <typename T, typename... Range>
void field(Archive& archive, std::string_view name, T& member, Range... range) {
  archive.member(name, [&](TableJson& json) { value(archive, json, member, range...); });
}

// A record, by its fields().
template <typename Record>
void record(Archive& archive, std::string_view name, Record& member) {
  archive.member(name, [&](TableJson& json) { archive.record(json, [&] { fields(archive, member); }); });
}

// A list of records by each(archive, record). Reading, the records are default-made.
template <typename Record, typename Each>
void list(Archive& archive, std::string_view name, std::vector<Record>& values, const Each& each) {
  archive.member(name, [&](TableJson& json) {
    const auto make_room = [&](std::size_t) {
      values.clear();
      return true;
    };
    archive.array(json, values.size(), make_room, [&](TableJson& element, std::size_t i) {
      if (archive.reading()) values.emplace_back();
      archive.record(element, [&] { each(archive, values[i]); });
    });
  });
}
template <typename Record>
void list(Archive& archive, std::string_view name, std::vector<Record>& values) {
  list(archive, name, values, [](Archive& a, Record& value) { fields(a, value); });
}

}  // namespace fathom::compiler
