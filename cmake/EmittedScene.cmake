# add_emitted_scene(target header scene namespace): `fathom emit cpp` writes the scene file `scene` (relative to the
# project's root) as C++ to emitted/`header` in the binary folder, with its function in `namespace`, before `target`
# is compiled. A change of the program or of the scene emits the header again. Sources that include the header are
# compiled again only if the header's text changes.
function(add_emitted_scene target header scene namespace)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/emitted)
  set(output ${folder}/${header})
  get_source_file_property(known ${output} GENERATED)
  if(NOT known)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
      COMMAND fathom emit cpp ${scene} --namespace ${namespace} -o ${output}.new
      COMMAND ${CMAKE_COMMAND} -E copy_if_different ${output}.new ${output}
      DEPENDS fathom ${PROJECT_SOURCE_DIR}/${scene}
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
      COMMENT "Emitting ${header}"
      VERBATIM)
  endif()
  target_sources(${target} PRIVATE ${output})
endfunction()
