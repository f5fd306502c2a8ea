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
