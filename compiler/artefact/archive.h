// What a compiled scene is made of, one value after another, so that one list of fields (fields.cpp) serves the
// writer and the reader of bytes and those of text.
//
//     void fields(Archive& a, Film& film) {
//       field(a, "width", film.width, 1, kMaxSide);
//       ...
//     }
//
// A writer takes the values from the fields and leaves them as they are; a reader puts values there and fails when
// one is missing, is of another name or outside its range. After the first failure a reader leaves the fields alone.
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace fathom::compiler {

class Archive {
 public:
  virtual ~Archive() = default;

  // Begins the field of this name; values, or a record or a list, follow, then end().
  virtual void begin(std::string_view name) = 0;
  virtual void end() = 0;
  virtual void number(double& value) = 0;
  virtual void whole(std::uint64_t& value) = 0;
  virtual void text(std::string& value) = 0;
  virtual void choice(std::size_t& value, std::span<const std::string_view> names) = 0;
  // A field's fields, between these.
  virtual void begin_record() = 0;
  virtual void end_record() = 0;
  // Of so many records. Returns how many there are.
  virtual std::size_t list(std::size_t count) = 0;
  // Whether the value that may follow is there.
  virtual bool present(bool there) = 0;

  virtual bool reading() const = 0;
  // What was read makes no sense; the first reason stays. Of no effect in a writer.
  virtual void fail(std::string reason) = 0;
  virtual bool failed() const = 0;
};

inline constexpr double kEndless = std::numeric_limits<double>::infinity();

// Numbers of a reader lie in [least, most] and are no NaN.
void value(Archive& archive, double& number, double least, double most);
void value(Archive& archive, std::uint64_t& number, std::uint64_t least, std::uint64_t most);

inline void field(Archive& archive, std::string_view name, double& number, double least, double most) {
  archive.begin(name);
  value(archive, number, least, most);
  archive.end();
}

// int, std::uint32_t and the like.
template <typename Integer>
requires std::is_integral_v<Integer>
void field(Archive& archive, std::string_view name, Integer& number, std::uint64_t least, std::uint64_t most) {
  auto copy = static_cast<std::uint64_t>(number);
  archive.begin(name);
  value(archive, copy, least, most);
  archive.end();
  number = static_cast<Integer>(copy);
}

// Vectors and matrices of GLM, column by column.
template <typename Vector>
requires requires(Vector v) { v.length(); }
void field(Archive& archive, std::string_view name, Vector& vector, double least, double most) {
  constexpr std::size_t kCount = sizeof(Vector) / sizeof(double);
  auto* numbers = reinterpret_cast<double*>(&vector);
  archive.begin(name);
  for (std::size_t i = 0; i < kCount; ++i) value(archive, numbers[i], least, most);
  archive.end();
}

void field(Archive& archive, std::string_view name, bool& flag);
void field(Archive& archive, std::string_view name, std::string& text);

template <typename Enum>
requires std::is_enum_v<Enum>
void field(Archive& archive, std::string_view name, Enum& choice, std::span<const std::string_view> names) {
  auto index = static_cast<std::size_t>(choice);
  archive.begin(name);
  archive.choice(index, names);
  archive.end();
  choice = static_cast<Enum>(index);
}

// A number that may be missing.
void field(Archive& archive, std::string_view name, std::optional<double>& number, double least, double most);

// A record, by its fields().
template <typename Record>
void record(Archive& archive, std::string_view name, Record& value) {
  archive.begin(name);
  archive.begin_record();
  fields(archive, value);
  archive.end_record();
  archive.end();
}

// A list of records, of default-made ones when reading; `most` bounds it.
template <typename Record, typename Each>
void list(Archive& archive, std::string_view name, std::vector<Record>& values, const Each& each) {
  archive.begin(name);
  const std::size_t count = archive.list(values.size());
  if (archive.reading()) values.clear();
  for (std::size_t i = 0; i < count && !archive.failed(); ++i) {
    if (archive.reading()) values.emplace_back();
    archive.begin_record();
    each(archive, values[i]);
    archive.end_record();
  }
  archive.end();
}
template <typename Record>
void list(Archive& archive, std::string_view name, std::vector<Record>& values) {
  list(archive, name, values, [](Archive& a, Record& value) { fields(a, value); });
}

}  // namespace fathom::compiler
