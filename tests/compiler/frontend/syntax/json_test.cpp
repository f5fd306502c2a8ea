// The JSON front end: values, spans and limits. Messages: tests/golden/diagnostics.
#include "compiler/frontend/syntax/json.h"

#include "compiler/frontend/formats/print_syntax.h"
#include "tests/support/catch.h"

namespace fathom::json_test {

namespace {

using namespace fathom::compiler;

syntax::File read(const Source& source) {
  Diagnostics diagnostics;
  auto file = read_json(source, diagnostics);
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(file.has_value());
  REQUIRE(!diagnostics.has_errors());
  return std::move(*file);
}

std::string first_code(const std::string& text) {
  const Source source("scene.json", text);
  Diagnostics diagnostics;
  read_json(source, diagnostics);
  return diagnostics.all().empty() ? "" : diagnostics.all()[0].code;
}

std::string text_at(const Source& source, Span span) {
  return source.text().substr(span.begin, span.end - span.begin);
}

const syntax::Record& record(const syntax::Value& value) { return std::get<syntax::Record>(value.data); }

// Checks that every value's span is exactly its text: the text of a scalar reads back as the same scalar, a record or
// list begins and ends with its brackets, and its contained values lie inside it, in order.
void check_spans(const Source& source, const syntax::Value& value) {
  const std::string text = text_at(source, value.span);
  CAPTURE(text);
  if (const auto* r = std::get_if<syntax::Record>(&value.data)) {
    CHECK((text.front() == '{' && text.back() == '}'));
    std::uint32_t last = value.span.begin + 1;
    for (const syntax::Property& property : r->properties) {
      CHECK(text_at(source, property.name_span) == "\"" + property.name + "\"");
      CHECK(property.name_span.begin >= last);
      CHECK(property.value->span.begin > property.name_span.end);
      check_spans(source, *property.value);
      last = property.value->span.end;
    }
    CHECK(last < value.span.end);
  } else if (const auto* list = std::get_if<syntax::List>(&value.data)) {
    CHECK((text.front() == '[' && text.back() == ']'));
    for (const syntax::Value& item : *list) check_spans(source, item);
  } else if (const auto* number = std::get_if<double>(&value.data)) {
    CHECK(std::stod(text) == *number);
    CHECK(text.find_first_not_of("0123456789+-.eE") == std::string::npos);
  } else if (const auto* string = std::get_if<std::string>(&value.data)) {
    CHECK(text == "\"" + *string + "\"");
  } else if (const auto* boolean = std::get_if<bool>(&value.data)) {
    CHECK(text == (*boolean ? "true" : "false"));
  } else {
    CHECK(text == "null");
  }
}

TEST_CASE("every value has its exact span", "[frontend][json]") {
  for (const char* text : {
           R"({"a": 1, "b": [1,2 , 3.5e2], "c": {"d": null}, "e": true,"f":false})",
           R"([1,-2,3e4,0.5 ,[ ],{ },"x"])",
           "{\"a\"\t:\t1\r\n,\r\n\t\"b\"\r\n:\r\n[\t-4e0\t]}\r\n",
           "// first\n{ // second\n\"a\" /* third */ : /* , : */ 1 // , 5\n, /**/ \"b\":/***/2}// last",
           "\xEF\xBB\xBF{\"größe\": \"∅ 𝄞\", /* ü */ \"b\": [1]}",
           "{\"a\": \"// no comment\", \"b\": \"/* nor this */\", \"c\": 7}",
           "1",
           " 1 ",
           "12",
           "-0.5e-3",
           "\"x\"",
           "[1]",
           "[[1],[2]]",
           "{\"a\":1}",
           "// x\r1",
           "null",
       }) {
    const Source source("scene.json", text);
    check_spans(source, read(source).root);
  }
}

TEST_CASE("numbers end where they end, whatever follows", "[frontend][json]") {
  for (const char* separator : {"", " ", "\n", "\r\n", "\t", "//", "/**/", "// 1"}) {
    const Source source("scene.json", std::string("-1.5e1") + separator);
    const syntax::File file = read(source);
    CHECK(text_at(source, file.root.span) == "-1.5e1");
    CHECK(std::get<double>(file.root.data) == -15);
  }
}

TEST_CASE("positions count code points, and a tab as one", "[frontend][json]") {
  const Source source("scene.json", "{\r\n\t\"größe\":\t\"∅\", \"x\": 1}");
  const syntax::File file = read(source);
  const Position x = source.locate(record(file.root).find("x")->name_span.begin);
  CHECK(x.line == 2);
  CHECK(x.column == 16);
  CHECK(source.line(1) == "{");
  CHECK(source.line(2) == "\t\"größe\":\t\"∅\", \"x\": 1}");
  CHECK(source.line(3) == "");
}

TEST_CASE("values are read as written", "[frontend][json]") {
  const Source source("scene.json",
                      R"({"a": 9007199254740993, "b": -3, "c": 18446744073709551616, "d": "\u00fc\\\ud834\udd1e"})");
  const syntax::File file = read(source);
  const auto number = [&](const char* name) { return std::get<double>(record(file.root).find(name)->value->data); };
  CHECK(number("a") == 9007199254740992.0);
  CHECK(number("b") == -3);
  CHECK(number("c") == 18446744073709551616.0);
  CHECK(std::get<std::string>(record(file.root).find("d")->value->data) == "ü\\𝄞");
  CHECK(record(file.root).find("e") == nullptr);
}

TEST_CASE("print_syntax shows the structure", "[frontend][json]") {
  const Source source("scene.json",
                      R"({"version": 1, "$schema": null, "nodes": {}, "a b": "x\"y", "m": [[1, 2], [true]],
    "objects": [{"type": "sphere", "radius": 0.1, "of": [{"use": "b"}]}, 5]})");
  CHECK(print_syntax(read(source)) ==
        "version: 1\n"
        "$schema: null\n"
        "nodes: {}\n"
        "\"a b\": \"x\\\"y\"\n"
        "m:\n"
        "  - [1, 2]\n"
        "  - [true]\n"
        "objects:\n"
        "  -\n"
        "    type: \"sphere\"\n"
        "    radius: 0.1\n"
        "    of:\n"
        "      -\n"
        "        use: \"b\"\n"
        "  - 5\n");
}

TEST_CASE("nesting up to the limit is read, one more is an error", "[frontend][json]") {
  const auto nested = [](int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
  };
  CHECK(first_code(nested(4096)) == "");
  CHECK(first_code(nested(4097)) == "E0008");
  CHECK(first_code(nested(5000)) == "E0008");
  CHECK(first_code(nested(1000000)) == "E0008");
  const Source deep("scene.json", nested(4096));
  CHECK(!print_syntax(read(deep)).empty());
}

TEST_CASE("all duplicates are reported, and the first value of a name is kept", "[frontend][json]") {
  const Source source("scene.json", R"({"a": 1, "b": {"c": 1, "c": 2, "c": 3}, "a": 4, "d": 5})");
  Diagnostics diagnostics;
  const auto file = read_json(source, diagnostics);
  REQUIRE(file.has_value());
  CHECK(diagnostics.errors() == 3);
  for (const Diagnostic& d : diagnostics.all()) CHECK(d.code == "E0010");
  REQUIRE(record(file->root).properties.size() == 3);
  CHECK(std::get<double>(record(file->root).find("a")->value->data) == 1);
  CHECK(record(*record(file->root).find("b")->value).properties.size() == 1);
}

TEST_CASE("what is not JSON is one error of the right kind", "[frontend][json]") {
  const std::pair<const char*, const char*> cases[] = {
      {"", "E0002"},
      {" \n// only a comment", "E0002"},
      {"[", "E0002"},
      {"[1", "E0002"},
      {"[1,", "E0002"},
      {"{\"a\"", "E0002"},
      {"{\"a\":", "E0002"},
      {"{\"a\":1", "E0002"},
      {"{\"a\":1,", "E0002"},
      {"]", "E0001"},
      {"[1 2]", "E0001"},
      {"[1,,2]", "E0001"},
      {"[,1]", "E0001"},
      {"[1,]", "E0001"},
      {"{,}", "E0001"},
      {"{\"a\":1,}", "E0001"},
      {"{\"a\" 1}", "E0001"},
      {"{1:1}", "E0001"},
      {"{\"a\":1:2}", "E0001"},
      {"[1}", "E0001"},
      {"{]", "E0001"},
      {"1 2", "E0001"},
      {"[1] x", "E0005"},
      {"[1-2]", "E0001"},
      {"[\"a\" \"b\"]", "E0001"},
      {"[true false]", "E0001"},
      {"\"abc", "E0003"},
      {"\"a\nb\"", "E0003"},
      {"\"\\x\"", "E0003"},
      {"\"\\", "E0003"},
      {"\"\\u12", "E0003"},
      {"\"\\ud800\\u0041\"", "E0003"},
      {"\"\\udc00\"", "E0003"},
      {"\"\\ud834\\udzzz\"", "E0003"},
      {"\"\\u-123\"", "E0003"},
      {"-", "E0004"},
      {"[-]", "E0004"},
      {"[1.]", "E0004"},
      {"[1e]", "E0004"},
      {"[1e+]", "E0004"},
      {"[.5]", "E0004"},
      {"[+1]", "E0004"},
      {"[01]", "E0004"},
      {"[0x1F]", "E0004"},
      {"[-inf]", "E0004"},
      {"nan", "E0005"},
      {"tru", "E0005"},
      {"True", "E0005"},
      {"nulll", "E0005"},
      {"{a:1}", "E0005"},
      {"'a'", "E0005"},
      {"#", "E0005"},
      {"ü", "E0005"},
      {"/", "E0006"},
      {"[/]", "E0006"},
      {"/* ", "E0006"},
      {"[1 /* ]", "E0006"},
      {"[1]/*", "E0006"},
      {"\xFF", "E0007"},
      {"\"\xC0\x80\"", "E0007"},
      {"\"\xED\xA0\x80\"", "E0007"},
      {"[1] // \xE4", "E0007"},
      {"[1e999]", "E0009"},
      {"-1e999", "E0009"},
      {"{\"a\":1,\"a\":2}", "E0010"},
  };
  for (const auto& [text, code] : cases) {
    CAPTURE(text);
    CHECK(first_code(text) == code);
  }
  CHECK(first_code(std::string("[1\0]", 4)) == "E0007");
  CHECK(first_code(std::string("[1]\0[", 5)) == "E0007");
}

TEST_CASE("an error's place lies in the file, wherever it is cut short", "[frontend][json]") {
  const std::string whole = "{\"a\": [1, -2.5e3, \"x\\u00fc\\\\\", {\"b\": null}], // c\n \"d\": /* e */ true}";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Source source("scene.json", whole.substr(0, length));
    CAPTURE(source.text());
    Diagnostics diagnostics;
    CHECK(!read_json(source, diagnostics));
    REQUIRE(diagnostics.errors() == 1);
    const Span span = diagnostics.all()[0].span;
    CHECK(span.begin <= span.end);
    CHECK(span.end <= length + 1);
    CHECK(!diagnostics.print(source, ErrorFormat::Text).empty());
  }
}

}  // namespace

}  // namespace fathom::json_test
