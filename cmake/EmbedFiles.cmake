# embed_files(result file...): sets `result` to a C++ string literal of the files' texts one after another. A change of
# a file configures the build again.
function(embed_files result)
  set(texts "")
  foreach(path ${ARGN})
    file(READ ${path} text)
    string(APPEND texts "${text}")
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  set(${result} "R\"text(${texts})text\"" PARENT_SCOPE)
endfunction()

# embed_table(output header function name path...): writes the source file `output`. It defines the function of `header`
# that returns the files, each by its name: std::span<const fathom::compiler::EmbeddedFile>.
function(embed_table output header function)
  set(rows "")
  set(pairs ${ARGN})
  while(pairs)
    list(POP_FRONT pairs name path)
    embed_files(text ${path})
    string(APPEND rows "      fathom::compiler::EmbeddedFile{\"${name}\", ${text}},\n")
  endwhile()
  file(CONFIGURE OUTPUT ${output} CONTENT [[
#include "@header@"

#include <array>

std::span<const fathom::compiler::EmbeddedFile> @function@() {
  static constexpr std::array kFiles = {
@rows@  };
  return kFiles;
}
]] @ONLY)
endfunction()
