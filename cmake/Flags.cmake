# Flags of every target. Contraction is off and there is no fast-math: the same bits on every machine
# (ARCHITECTURE.md).
add_library(fathom_flags INTERFACE)
target_include_directories(fathom_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(fathom_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${FATHOM_WERROR}>:-Werror>
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12's SLP vectoriser drops double -> float -> double rounding of adjacent struct members
  # (tests/vm/number/rounding_test.cpp fails without the flag).
  target_compile_options(fathom_flags INTERFACE -fno-tree-slp-vectorize)
  # g++ 12 warns about its own std::string operator+ at -O3 (gcc.gnu.org/PR105651).
  target_compile_options(fathom_flags INTERFACE $<$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>:-Wno-restrict>)
endif()

# Flags of code that runs once per scene or command: there -O3 takes more time to compile than it saves.
set(run_once_flags $<$<NOT:$<CONFIG:Debug>>:-O1>)

# Flags of the product. The sanitizers instrument the product but not the tests.
set(product_flags)
if(FATHOM_SANITIZE)
  # Checks of every address are off: AddressSanitizer finds a wrong address where the program uses it, the processor
  # finds a null address, and the checks are a quarter of the time to compile.
  set(product_flags -O1 -g1 -UNDEBUG -fsanitize=address,undefined
    -fno-sanitize=object-size,pointer-overflow,null,alignment,vptr -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND product_flags -Wno-maybe-uninitialized)  # g++ 12 warns about its own std::optional in such builds
  endif()
  # -no-pie saves every start the relocation of half a million addresses in AddressSanitizer's descriptions of
  # globals.
  target_link_options(fathom_flags INTERFACE -fsanitize=address,undefined $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
endif()
if(FATHOM_FUZZ)
  if(NOT FATHOM_SANITIZE OR NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "FATHOM_FUZZ goes with FATHOM_SANITIZE and clang, as in the preset `fuzz`")
  endif()
  list(APPEND product_flags -fsanitize=fuzzer-no-link)
endif()

# ThreadSanitizer instruments the renderer and the program alone. No thread writes to the data of the other libraries
# that the renderer shares between threads, and without instrumentation their objects equal those of the other builds.
set(renderer_flags ${product_flags})
if(FATHOM_SANITIZE_THREAD)
  set(renderer_flags -O1 -g1 -UNDEBUG -fsanitize=thread)
  target_link_options(fathom_flags INTERFACE -fsanitize=thread $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
endif()

# compile_together(target): compiles several sources of a target together: most of the time to compile a single source
# goes into reading headers and into instantiations that the other sources of the folder need, too. Names in anonymous
# namespaces are therefore unique per library. Sources with options of their own are compiled alone, among them all
# sources that Highway compiles per instruction set.
function(compile_together target)
  if(FATHOM_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 24)
  endif()
endfunction()
