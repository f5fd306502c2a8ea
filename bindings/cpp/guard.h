// The border of the library: no exception leaves it.
// Tested by: tests/bindings/library_test.cpp
#pragma once

#include <exception>
#include <fathom/fathom.hpp>
#include <new>
#include <string>
#include <string_view>

namespace fathom::library {

// Returns an error of a kind. Keeps the kind even if there is no memory for the message.
inline Error error_of(Error::Kind kind, std::string_view message) noexcept {
  Error error{kind};
  try {
    error.message = message;
  } catch (...) {
  }
  return error;
}

inline Error bad_argument(std::string_view message) noexcept { return error_of(Error::Kind::BadArgument, message); }

// Returns the error that an argument is null though it has elements, or none.
template <class Elements>
Error announced(std::string_view name, const Elements& elements) {
  if (elements.data() != nullptr || elements.empty()) return {};
  return error_of(Error::Kind::BadArgument, std::string(name) + " is null");
}

// Returns the error that a path holds a zero byte, at which the system would cut it off, or none.
inline Error check_path(std::string_view name, std::string_view path) {
  if (path.find('\0') == path.npos) return {};
  return error_of(Error::Kind::BadArgument, std::string(name) + " holds a zero byte");
}

// Calls `work`, which returns an Error, and converts exceptions to errors.
template <class Work>
Error guard(Work&& work) noexcept {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return {Error::Kind::OutOfMemory};
  } catch (const std::exception& failure) {
    return error_of(Error::Kind::Internal, failure.what());
  } catch (...) {
    return {Error::Kind::Internal};
  }
}

inline constexpr std::string_view kNoScene = "the scene is empty: it was not compiled";

}  // namespace fathom::library
