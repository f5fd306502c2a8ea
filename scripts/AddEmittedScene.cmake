# add_emitted_scene(target header scene namespace): emitted/`header` in the binary folder is what `fathom emit cpp` makes
# of the scene file `scene` (from the project's root) with its function in `namespace`, there before `target` is compiled.
# It is made anew when the program or the scene changes, and what includes it is compiled anew only when its text does.
function(add_emitted_scene target header scene namespace)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/emitted)
  set(output ${folder}/${header})
  get_source_file_property(known ${output} GENERATED)
  if(NOT known)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
      COMMAND fathom emit cpp ${scene} --namespace ${namespace} -o ${output}.new
      COMMAND ${CMAKE_COMMAND} -E copy_if_different ${output}.new ${output}
      DEPENDS fathom ${CMAKE_SOURCE_DIR}/${scene}
      WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
      COMMENT "Emitting ${header}"
      VERBATIM)
  endif()
  target_sources(${target} PRIVATE ${output})
endfunction()
