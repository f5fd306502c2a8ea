// Fields as text: one a line, its name before its values, records in braces, a list as how many and its records.
//
//     film {
//       width 640
//       filter box
//     }
//     lights 1 {
//       name "lamp"
//     }
//
// What is missing is `none`. Numbers have the fewest digits that read back to the same. Fields stand in their order
// and none may be missing: what is read was written by the other half. `;` begins a comment.
//
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include "compiler/artefact/archive.h"

namespace fathom::compiler {

class TextArchiveWriter : public Archive {
 public:
  void begin(std::string_view name) override;
  void end() override { out_ += '\n'; }
  void number(double& value) override;
  void whole(std::uint64_t& value) override;
  void text(std::string& value) override;
  void choice(std::size_t& value, std::span<const std::string_view> names) override;
  void begin_record() override;
  void end_record() override;
  std::size_t list(std::size_t count) override;
  bool present(bool there) override;
  bool reading() const override { return false; }
  void fail(std::string) override {}
  bool failed() const override { return false; }

  const std::string& out() const { return out_; }

 private:
  std::string out_;
  std::size_t depth_ = 0;
};

class TextArchiveReader : public Archive {
 public:
  explicit TextArchiveReader(std::string_view in) : in_(in) {}

  void begin(std::string_view name) override { expect(name); }
  void end() override {}
  void number(double& value) override;
  void whole(std::uint64_t& value) override;
  void text(std::string& value) override;
  void choice(std::size_t& value, std::span<const std::string_view> names) override;
  void begin_record() override { expect("{"); }
  void end_record() override { expect("}"); }
  std::size_t list(std::size_t) override;
  bool present(bool) override;
  bool reading() const override { return true; }
  void fail(std::string reason) override;
  bool failed() const override { return !reason_.empty(); }

  // Where the next token begins; after a failure, what is at fault and why.
  std::size_t at() const { return at_; }
  void skip_to(std::size_t at) { at_ = at; }
  std::size_t fault_begin() const { return fault_begin_; }
  std::size_t fault_end() const { return fault_end_; }
  const std::string& reason() const { return reason_; }

  // The next token, or "" at the end; a text keeps its quotes.
  std::string_view next();
  // Fails when the next token is another.
  void expect(std::string_view token);

 private:
  void skip_blank();

  std::string_view in_;
  std::size_t at_ = 0;
  std::size_t fault_begin_ = 0, fault_end_ = 0;  // the last token
  std::string reason_;
};

}  // namespace fathom::compiler
