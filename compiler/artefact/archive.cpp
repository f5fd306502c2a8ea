#include "compiler/artefact/archive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "vm/encoding/printable.h"

namespace fathom::compiler {
namespace {

constexpr std::size_t kMaxDepth = 16, kMaxMembers = 128;
constexpr std::string_view kInfinite[] = {"inf", "-inf"};

// Builds the JSON within the limits. The recursion of nlohmann's parser of CBOR is as deep as the nesting, so the
// limit must hold while it parses.
class TableBuilder final : public nlohmann::json_sax<TableJson> {
 public:
  TableJson root;
  std::string problem;

  bool null() override { return put(nullptr); }
  bool boolean(bool flag) override { return put(flag); }
  bool number_integer(number_integer_t number) override { return put(number); }
  bool number_unsigned(number_unsigned_t number) override { return put(number); }
  bool number_float(number_float_t number, const string_t&) override { return put(number); }
  bool string(string_t& text) override { return put(std::move(text)); }
  bool binary(binary_t&) override { return refuse("there are bytes in it"); }
  bool start_object(std::size_t) override { return open(TableJson::object()); }
  bool start_array(std::size_t) override { return open(TableJson::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (open_.back()->size() == kMaxMembers) return refuse("an object has too many members");
    if (open_.back()->contains(name)) return refuse(fmt::format("`{}` is there twice", vm::printable(name)));
    key_ = std::move(name);
    return true;
  }
  bool parse_error(std::size_t at, const std::string&, const nlohmann::detail::exception&) override {
    return refuse(fmt::format("byte {} makes no sense", at));
  }

 private:
  TableJson* place(TableJson json) {
    if (open_.empty()) return &(root = std::move(json));
    TableJson& outer = *open_.back();
    if (outer.is_object()) return &(outer[key_] = std::move(json));
    outer.push_back(std::move(json));
    return &outer.back();
  }
  bool put(TableJson json) {
    place(std::move(json));
    return true;
  }
  bool open(TableJson json) {
    if (open_.size() == kMaxDepth) return refuse("it is nested too deep");
    open_.push_back(place(std::move(json)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  bool refuse(std::string reason) {
    problem = std::move(reason);
    return false;
  }

  std::vector<TableJson*> open_;  // the objects and arrays around the next value, the outermost first
  std::string key_;
};

void print(const TableJson& json, std::size_t depth, std::string& out) {
  const bool object = json.is_object();
  const bool flat = !object && std::ranges::none_of(json, [](const TableJson& e) { return e.is_structured(); });
  if (!json.is_structured() || json.empty() || flat) {
    out += json.dump();
    return;
  }
  out += object ? "{" : "[";
  const char* separator = "\n";
  for (const auto& [name, member] : json.items()) {
    out.append(separator).append(2 * depth + 2, ' ');
    if (object) out += TableJson(name).dump() + ": ";
    print(member, depth + 1, out);
    separator = ",\n";
  }
  out.append("\n").append(2 * depth, ' ').append(object ? "}" : "]");
}

}  // namespace

void Archive::fail(std::string_view reason) {
  if (!reading_ || failed()) return;
  for (const std::string& step : path_) reason_ += "/" + step;
  reason_ += fmt::format("{}: {}", path_.empty() ? "/" : "", reason);
}

// Members are in the order in which they were written.
TableJson* Archive::next(std::string_view name) {
  if (!reading_) return &((*here_)[std::string(name)] = nullptr);
  if (failed()) return nullptr;
  const auto found = at_ < here_->size() ? std::next(here_->begin(), static_cast<std::ptrdiff_t>(at_)) : here_->end();
  if (found == here_->end() || found.key() != name) {
    fail(fmt::format("`{}` should be here", name));
    return nullptr;
  }
  ++at_;
  return &found.value();
}

std::variant<TableJson, std::string> parse_tables(std::span<const std::uint8_t> bytes, bool cbor) {
  using Format = TableJson::input_format_t;
  TableBuilder builder;
  const bool parsed = TableJson::sax_parse(bytes.begin(), bytes.end(), &builder, cbor ? Format::cbor : Format::json);
  if (!parsed) return builder.problem;
  return std::move(builder.root);
}

std::string print_tables(const TableJson& json) {
  std::string out;
  print(json, 0, out);
  return vm::escape_controls(out);
}

void value(Archive& archive, TableJson& json, double& number, double least, double most) {
  if (!archive.reading()) {
    if (std::isinf(number)) {
      json = kInfinite[number < 0 ? 1 : 0];
    } else {
      json = number;
    }
    return;
  }
  if (archive.failed()) return;
  double read = 0;
  if (json.is_number_float()) {
    read = json.get<double>();
  } else if (json == kInfinite[0] || json == kInfinite[1]) {
    read = json == kInfinite[0] ? kEndless : -kEndless;
  } else {
    return archive.fail("this should be a number with a point");
  }
  if (!(read >= least && read <= most)) return archive.fail(fmt::format("{} is not in [{}, {}]", read, least, most));
  number = read;
}

void value(Archive& archive, TableJson& json, std::uint64_t& number, std::uint64_t least, std::uint64_t most) {
  if (!archive.reading()) {
    json = number;
    return;
  }
  if (archive.failed()) return;
  if (!json.is_number_unsigned()) return archive.fail("this should be a whole number");
  const auto read = json.get<std::uint64_t>();
  if (read < least || read > most) return archive.fail(fmt::format("{} is not in {}..{}", read, least, most));
  number = read;
}

void value(Archive& archive, TableJson& json, bool& flag) {
  if (!archive.reading()) {
    json = flag;
  } else if (!json.is_boolean()) {
    archive.fail("this should be true or false");
  } else {
    flag = json.get<bool>();
  }
}

void value(Archive& archive, TableJson& json, std::string& text) {
  if (!archive.reading()) {
    json = text;
    return;
  }
  if (!json.is_string()) return archive.fail("this should be a text");
  const auto& read = json.get_ref<const std::string&>();
  const bool controls = std::ranges::any_of(read, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (controls || !vm::is_utf8(read)) return archive.fail("a text has a control character, or is not UTF-8");
  text = read;
}

void choice(Archive& archive, TableJson& json, std::size_t& index, std::span<const std::string_view> names) {
  if (!archive.reading()) {
    json = names[index];
    return;
  }
  const auto found = std::ranges::find_if(names, [&](std::string_view name) { return json == name; });
  if (found == names.end()) return archive.fail(fmt::format("this should be one of: {}", fmt::join(names, ", ")));
  index = static_cast<std::size_t>(found - names.begin());
}

}  // namespace fathom::compiler
