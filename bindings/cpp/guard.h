// The border of the library: no exception leaves it.
// Tested by: tests/bindings/library_test.cpp
#pragma once

#include <exception>
#include <fathom/fathom.hpp>
#include <new>

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
