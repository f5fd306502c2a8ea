# Instruction sets of the processor (`isas`), and Highway's target for each name that FATHOM_ISA takes, with its bit. The
# portable code, `scalar`, also serves SSSE3 machines and ARM processors without AES. Highway has further targets, each
# version others: the masks are of all bits that it keeps for the processor's family.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(isas scalar neon)
  set(family_targets 0x3fff8000)
  # Highway would otherwise take NEON for granted and leave the portable code out.
  target_compile_definitions(fathom_flags INTERFACE HWY_BASELINE_TARGETS=HWY_SCALAR)
  # Highway's functions of NEON have the option crypto, and g++ inlines them only into functions that have it, too.
  # Constructors that the compiler writes have the options of the command line. g++ itself makes no use of crypto.
  target_compile_options(fathom_flags INTERFACE -march=armv8-a+crypto)
else()
  set(isas scalar sse4 avx2 avx512)
  set(family_targets 0x7fff)
endif()
set(target_of_scalar HWY_SCALAR)
set(target_of_neon HWY_NEON)
set(target_of_sse4 HWY_SSE4)
set(target_of_avx2 HWY_AVX2)
set(target_of_avx512 HWY_AVX3)
set(bit_of_neon 28)
set(bit_of_sse4 11)
set(bit_of_avx2 9)
set(bit_of_avx512 8)
# Highway has two forms of portable code, chosen by the compiler. HWY_SCALAR, its choice for g++ before 12.3, is the one
# for all.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU" OR CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12.3)
  target_compile_definitions(fathom_flags INTERFACE HWY_BROKEN_EMU128=1)
endif()
if(FATHOM_ISAS STREQUAL "host")
  if(NOT FATHOM_HOST_ISA)
    try_run(ran compiled ${PROJECT_BINARY_DIR}/host_isa ${CMAKE_CURRENT_LIST_DIR}/host_isa.cpp LINK_LIBRARIES hwy::hwy
      RUN_OUTPUT_VARIABLE host_isa)
    if(NOT compiled OR NOT ran EQUAL 0)
      message(FATAL_ERROR "FATHOM_ISAS=host: cmake/host_isa.cpp does not run here; take FATHOM_ISAS=all")
    endif()
    set(FATHOM_HOST_ISA "${host_isa}" CACHE INTERNAL "This machine's best instruction set")
  endif()
  set(isas scalar ${FATHOM_HOST_ISA})
  list(REMOVE_DUPLICATES isas)
endif()

# targets_without(result isa...): sets `result` to the HWY_DISABLED_TARGETS that leaves only these instruction sets.
function(targets_without result)
  set(disabled ${family_targets})
  list(REMOVE_ITEM ARGN scalar)
  foreach(isa ${ARGN})
    math(EXPR disabled "${disabled} & ~(1 << ${bit_of_${isa}})" OUTPUT_FORMAT HEXADECIMAL)
  endforeach()
  set(${result} ${disabled}LL PARENT_SCOPE)
endfunction()

# compile_for_isas(source...): Highway compiles these sources for every instruction set within one object. Under the
# sanitizers one width in addition to the portable code is enough: they check loads and stores of lanes, whose source
# is the same for every width.
function(compile_for_isas)
  set(widths ${isas})
  if(FATHOM_SANITIZE AND FATHOM_ISAS STREQUAL "all")
    list(REMOVE_ITEM widths sse4 avx512)
  endif()
  targets_without(disabled ${widths})
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_DEFINITIONS HWY_DISABLED_TARGETS=${disabled})
endfunction()
