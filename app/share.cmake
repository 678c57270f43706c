# What the finished command says of itself, for editors, shells and `man`: the schema of case files with the parameters of all plugins,
# completion, the manual page. Written into the build's share/, from where a new case finds the schema before anything is installed.
function(millscope_targets_below directory result)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(folders DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(folder ${folders})
    millscope_targets_below(${folder} below)
    list(APPEND targets ${below})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

set(plugin_libraries)
foreach(room plugins geometry analyzers)
  millscope_targets_below(${PROJECT_SOURCE_DIR}/${room} found)
  foreach(target ${found})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL MODULE_LIBRARY)
      list(APPEND plugin_libraries ${target})
    endif()
  endforeach()
endforeach()

set(share ${PROJECT_BINARY_DIR}/share)
set(share_files)
# millscope_share_file(FILE WORD…): what `millscope WORD…` prints, as share/FILE.
function(millscope_share_file file)
  get_filename_component(folder ${share}/${file} DIRECTORY)
  get_filename_component(installed ${CMAKE_INSTALL_DATADIR}/${file} DIRECTORY)
  add_custom_command(OUTPUT ${share}/${file}
                     COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
                     COMMAND $<TARGET_FILE:millscope> ${ARGN} > ${share}/${file}.new
                     COMMAND ${CMAKE_COMMAND} -E rename ${share}/${file}.new ${share}/${file}
                     DEPENDS millscope ${plugin_libraries} COMMENT "Writing share/${file}" VERBATIM)
  install(FILES ${share}/${file} DESTINATION ${installed})
  set(share_files ${share_files} ${share}/${file} PARENT_SCOPE)
endfunction()

millscope_share_file(millscope/case.schema.json schema)
millscope_share_file(man/man1/millscope.1 manual)
millscope_share_file(bash-completion/completions/millscope completion bash)
millscope_share_file(zsh/site-functions/_millscope completion zsh)
millscope_share_file(fish/vendor_completions.d/millscope.fish completion fish)
add_custom_target(millscope_share ALL DEPENDS ${share_files})

# Materials for new cases; in a build tree they are taken from the sources.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs/materials DESTINATION ${CMAKE_INSTALL_DATADIR}/millscope FILES_MATCHING PATTERN "*.yaml")
