#include "compiler/frontend/syntax/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "compiler/frontend/syntax/json_error.h"

namespace fathom::compiler {
namespace {

// Feeds a text to nlohmann's lexer and counts the bytes that the lexer has consumed.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t* taken) : at_(at), taken_(taken) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*taken_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::size_t* taken_;
};

bool in_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E'; }

// SAX handler that builds the syntax tree. nlohmann sends each event right after reading its token, so the token ends
// at the bytes consumed so far. After a number the lexer has consumed one byte more, to see where the number ends.
// The token begins at the first byte after the previous token that is not a blank, a comment, a comma or a colon.
class Reader : public nlohmann::json_sax<nlohmann::json> {
 public:
  Reader(const Source& source, Diagnostics& diagnostics, const Limits& limits, const std::size_t& taken)
      : text_(source.text()), source_(source), diagnostics_(diagnostics), limits_(limits), taken_(taken) {
    if (text_.starts_with("\xEF\xBB\xBF")) last_end_ = 3;
  }

  syntax::Value take_root() { return std::move(root_); }

  bool null() override { return scalar(std::monostate{}); }
  bool boolean(bool value) override { return scalar(value); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value), value); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    const Span span = token(taken_);
    refuse_control_characters(value, span);
    put({span, std::move(value)});
    return true;
  }
  bool binary(binary_t&) override { return false; }  // not in JSON

  bool start_object(std::size_t) override { return open(syntax::Record{}); }
  bool start_array(std::size_t) override { return open(syntax::List{}); }
  bool end_object() override {
    drop_duplicates(std::get<syntax::Record>(open_.back().value.data));
    return close();
  }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Open& record = open_.back();
    record.key_span = token(taken_);
    refuse_control_characters(name, record.key_span);
    record.key = std::move(name);
    record.has_key = true;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    JsonPlace place;
    place.token_end = position;
    place.overflow = error.id == 406;  // out_of_range.406: "number overflow"
    place.skipped = skip_to_token(text_, last_end_, position);
    if (open_.empty()) {
      place.inside = has_root_ ? JsonPlace::Inside::AfterRoot : JsonPlace::Inside::Nothing;
    } else {
      const Open& inner = open_.back();
      const auto* record = std::get_if<syntax::Record>(&inner.value.data);
      place.inside = record ? JsonPlace::Inside::Record : JsonPlace::Inside::List;
      place.opened_at = inner.value.span.begin;
      place.has_key = inner.has_key;
      place.key = inner.key;
      place.empty = record ? record->properties.empty() : std::get<syntax::List>(inner.value.data).empty();
    }
    report_json_error(source_, place, diagnostics_);
    return false;
  }

 private:
  struct Open {
    syntax::Value value;  // Record or List
    std::string key;      // of the property being read
    Span key_span;
    bool has_key = false;
  };

  Span token(std::size_t end) {
    const std::size_t begin = skip_to_token(text_, last_end_, end).begin;
    last_end_ = end;
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }

  // Rejects control characters, because listings and messages print one name per line.
  void refuse_control_characters(const std::string& text, Span span) {
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (std::none_of(text.begin(), text.end(), control)) return;
    diagnostics_.error("E0003", span, "a control character in a string", "",
                       {"leave out line breaks, tabs and escapes such as \\u001b"});
  }

  bool scalar(decltype(syntax::Value::data) data) {
    put({token(taken_), std::move(data)});
    return true;
  }

  bool number(double value, std::uint64_t integer = 0) {
    const bool ended_by_text = taken_ < text_.size() || !in_number(text_.back());
    put({token(taken_ - (ended_by_text ? 1 : 0)), value, integer});
    return true;
  }

  bool open(decltype(syntax::Value::data) empty) {
    const Span span = token(taken_);
    if (static_cast<double>(open_.size()) >= limits_.nesting) {
      diagnostics_.error("E0008", span,
                         fmt::format("lists and objects are nested more than {} deep", limits_.nesting),
                         "one level too many", {"give inner nodes a name under `nodes` and refer to it with `use`"});
      return false;
    }
    open_.push_back({{span, std::move(empty)}, "", {}, false});
    return true;
  }

  bool close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    done.value.span.end = token(taken_).end;
    put(std::move(done.value));
    return true;
  }

  void put(syntax::Value value) {
    if (open_.empty()) {
      root_ = std::move(value);
      has_root_ = true;
      return;
    }
    Open& inner = open_.back();
    if (auto* record = std::get_if<syntax::Record>(&inner.value.data)) {
      record->properties.push_back(
          {std::move(inner.key), inner.key_span, std::make_unique<syntax::Value>(std::move(value))});
      inner.has_key = false;
    } else {
      std::get<syntax::List>(inner.value.data).push_back(std::move(value));
    }
  }

  // Reports every property whose name occurred before, and keeps the first of each name.
  void drop_duplicates(syntax::Record& record) {
    std::vector<const syntax::Property*> sorted;
    for (const syntax::Property& property : record.properties) sorted.push_back(&property);
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
    const syntax::Property* first = nullptr;
    std::vector<std::uint32_t> dropped;  // begin offsets of their names
    for (const syntax::Property* property : sorted) {
      if (diagnostics_.full()) break;
      if (first == nullptr || first->name != property->name) {
        first = property;
        continue;
      }
      const Position at = source_.locate(first->name_span.begin);
      diagnostics_.error("E0010", property->name_span,
                         property->name.empty() ? "a property without a name is given twice"
                                                : fmt::format("`{}` is given twice", property->name),
                         "the second of the same name",
                         {fmt::format("the first is at line {}, column {}; keep one of them", at.line, at.column)});
      dropped.push_back(property->name_span.begin);
    }
    if (dropped.empty()) return;
    std::sort(dropped.begin(), dropped.end());
    std::erase_if(record.properties, [&](const syntax::Property& property) {
      return std::binary_search(dropped.begin(), dropped.end(), property.name_span.begin);
    });
  }

  const std::string& text_;
  const Source& source_;
  Diagnostics& diagnostics_;
  const Limits& limits_;
  const std::size_t& taken_;  // bytes that nlohmann's lexer has consumed
  std::size_t last_end_ = 0;  // end offset of the last token
  std::vector<Open> open_;
  syntax::Value root_;
  bool has_root_ = false;
};

// Counts values and names and stops parsing at the first one above the limit, so that an oversized file is never
// stored.
class Counter : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Counter(double most) : most_(most) {}
  bool too_many() const { return count_ > most_; }

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return count(); }
  bool start_array(std::size_t) override { return count(); }
  bool key(string_t&) override { return count(); }
  bool end_object() override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

 private:
  bool count() { return ++count_ <= most_; }
  double most_, count_ = 0;
};

bool parse(const std::string& text, nlohmann::json_sax<nlohmann::json>& reader, std::size_t& taken) {
  return nlohmann::json::sax_parse(CountingIterator(text.data(), &taken),
                                   CountingIterator(text.data() + text.size(), &taken), &reader,
                                   nlohmann::json::input_format_t::json, true, true);
}

// False, after a report, if the text has more values and names than the limit. A text has fewer values and names than
// bytes, so the check skips short texts.
bool check_tokens(const std::string& text, const Limits& limits, Diagnostics& diagnostics) {
  if (static_cast<double>(text.size()) <= limits.tokens) return true;
  Counter counter(limits.tokens);
  std::size_t taken = 0;
  parse(text, counter, taken);
  if (!counter.too_many()) return true;
  const auto at = static_cast<std::uint32_t>(taken);
  diagnostics.error("E0008", {at - 1, at}, fmt::format("the file has more than {} values and names", limits.tokens),
                    "one too many", {"move repeated parts to `nodes`", raise(&Limits::tokens, 2 * limits.tokens)});
  return false;
}

}  // namespace

std::optional<syntax::File> read_json(const Source& source, Diagnostics& diagnostics, const Limits& limits) {
  const std::string& text = source.text();
  if (!check_text(source, diagnostics) || !check_tokens(text, limits, diagnostics)) return std::nullopt;
  std::size_t taken = 0;
  Reader reader(source, diagnostics, limits, taken);
  if (!parse(text, reader, taken)) return std::nullopt;
  return syntax::File{reader.take_root()};
}

}  // namespace fathom::compiler
