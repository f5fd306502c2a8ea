// Errors and warnings about a scene, each with a place in the source, collected over a whole file.
//
//     error[E0102]: unknown property `fvo` in `camera`
//       --> toy.json:2:42
//        |
//      2 |   "camera": {"position": [0, 1.5,-4e0 ], "fvo": 45},
//        |                                          ^^^^^ not a camera property
//        = help: did you mean `fov`? known: aperture, fov, position, target, up
//
// Tested by: tests/golden (diagnostics)
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler {

enum class Severity { Error, Warning };

struct Diagnostic {
  Severity severity;
  std::string code;     // e.g. E0102; each code has one meaning
  std::string message;  // one line, no full stop
  Span span;
  std::string label;              // printed after the carets; may be empty
  std::vector<std::string> help;  // printed as one line each after "= help:"
  std::size_t again = 0;          // number of further occurrences in calls and loops
};

// A function call, or an iteration of a loop, that led to a place in the source.
struct Trace {
  std::uint32_t outside;  // number of the trace that the call is in; 0: none
  Span at;                // the call or loop
  Span name;              // the function's name, or the loop variable's
  bool loop;
  double value;  // the loop variable's; NaN if the variable is not a number
};

// Notation of the source, in which remedies are worded.
enum class Notation { Json, Text };

enum class ErrorFormat { Text, Short, Json };

class Diagnostics {
 public:
  void error(std::string code, Span span, std::string message, std::string label = "",
             std::vector<std::string> help = {});
  void warning(std::string code, Span span, std::string message, std::string label = "",
               std::vector<std::string> help = {});

  void set_notation(Notation notation) { notation_ = notation; }
  // Returns the remedy in the source's notation.
  std::string spelled(std::string json, std::string text) const {
    return notation_ == Notation::Json ? std::move(json) : std::move(text);
  }

  // Adds the errors, without warnings and traces, of a text that begins at offset `base` of the source.
  void append(const Diagnostics& of_text, std::uint32_t base);

  // Returns the trace's number, for Span::trace.
  std::uint32_t add_trace(const Trace& trace) {
    traces_.push_back(trace);
    return static_cast<std::uint32_t>(traces_.size());
  }

  bool has_errors() const { return errors_ > 0; }
  std::size_t errors() const { return errors_; }
  std::size_t warnings() const { return warnings_; }
  // True if the file has so many errors that looking for more is useless: a file can have millions.
  bool full() const { return errors_ >= kMaxKept; }
  // The first kMaxKept errors and the first kMaxKept warnings.
  const std::vector<Diagnostic>& all() const { return all_; }

  // Prints the diagnostics in source order: the first 20 errors, the first 20 warnings, and the number of further
  // errors.
  std::string print(const Source& source, ErrorFormat format, bool color = false) const;

 private:
  void add(Diagnostic d);
  bool count_known(const std::string& code, Span span);
  std::vector<std::string> calls(const Diagnostic& d, const Source& source) const;

  static constexpr std::size_t kMaxKept = 100;

  std::vector<Diagnostic> all_;
  std::vector<Trace> traces_;
  Notation notation_ = Notation::Json;
  std::size_t errors_ = 0, warnings_ = 0;
  std::size_t repeated_ = 0;  // errors that repeat an earlier error at its place
};

// Returns the candidate nearest to `word` by edit distance, or empty if none is near enough for a typing error.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace fathom::compiler
