# The libraries that the program is made of. Tests and benches find theirs themselves.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(hwy REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)

# Distributions agree on stb's headers, not on a library or a pkg-config file (runtime/image/stb.cpp).
find_path(STB_INCLUDE_DIR stb_image_write.h PATH_SUFFIXES stb REQUIRED)
add_library(fathom_stb INTERFACE)
target_include_directories(fathom_stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})

# cpp-httplib as it is, or compiled by the distribution, which names only a pkg-config file. Its header calls OpenSSL if
# it was compiled with it, and the pkg-config file keeps that to itself.
find_package(httplib QUIET)
if(NOT httplib_FOUND)
  pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)
  pkg_check_modules(libcrypto QUIET IMPORTED_TARGET libcrypto)
  add_library(httplib::httplib INTERFACE IMPORTED)
  target_link_libraries(httplib::httplib INTERFACE PkgConfig::httplib $<TARGET_NAME_IF_EXISTS:PkgConfig::libcrypto>)
endif()

# Machine code exists for x86 only. Everywhere else, and without asmjit, the interpreter evaluates.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|amd64|AMD64")
  find_package(asmjit QUIET)
  if(NOT asmjit_FOUND)
    message(STATUS "asmjit is missing: programs are interpreted, not compiled to machine code")
  endif()
endif()

# Open Image Denoise, if installed, does the denoiser's work (runtime/denoise/denoise.cpp).
find_package(OpenImageDenoise QUIET)
