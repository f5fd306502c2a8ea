// Fields as bytes, one after another without names: numbers as f64, whole numbers as u64, texts as u32 bytes and
// these, a choice as u8, a list as u32 entries and these, what may be missing
// as u8 0 or 1 and, after 1, itself (vm/encoding/bytes.h).
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include "compiler/artefact/archive.h"
#include "vm/encoding/bytes.h"

namespace fathom::compiler {

class ByteArchiveWriter : public Archive {
 public:
  explicit ByteArchiveWriter(vm::ByteWriter& out) : out_(out) {}

  void begin(std::string_view) override {}
  void end() override {}
  void number(double& value) override { out_.f64(value); }
  void whole(std::uint64_t& value) override { out_.u64(value); }
  void text(std::string& value) override { out_.text(value); }
  void choice(std::size_t& value, std::span<const std::string_view>) override {
    out_.u8(static_cast<std::uint8_t>(value));
  }
  void begin_record() override {}
  void end_record() override {}
  std::size_t list(std::size_t count) override;
  bool present(bool there) override;
  bool reading() const override { return false; }
  void fail(std::string) override {}
  bool failed() const override { return false; }

 private:
  vm::ByteWriter& out_;
};

class ByteArchiveReader : public Archive {
 public:
  explicit ByteArchiveReader(vm::ByteReader& in) : in_(in) {}

  void begin(std::string_view name) override { name_ = name; }
  void end() override { name_.clear(); }
  void number(double& value) override { value = in_.f64(); }
  void whole(std::uint64_t& value) override { value = in_.u64(); }
  void text(std::string& value) override { value = in_.text(in_.left()); }
  void choice(std::size_t& value, std::span<const std::string_view> names) override;
  void begin_record() override {}
  void end_record() override {}
  std::size_t list(std::size_t) override { return in_.count(1); }
  bool present(bool) override;
  bool reading() const override { return true; }
  void fail(std::string reason) override;
  bool failed() const override { return in_.failed(); }

  // Of the first failure: "`fov`: 4 is not in [0, 3]".
  std::string reason() const { return reason_.empty() ? "it is cut off" : reason_; }

 private:
  vm::ByteReader& in_;
  std::string name_, reason_;  // the field at hand, if one is; why it failed
};

}  // namespace fathom::compiler
