# millscope_add_plugin(NAME SOURCES file… [WIDE] [COMPONENT name] [LINK target…])
#
# Builds one plugin library, the target NAME_plugin. Contact laws, interactions and pair parameters say WIDE, and so does a geometry or a
# body force that computes in packs: they are built once per instruction set (x86-64-v2, v3, v4) into the sub-folders v2, v3, v4, and the
# loader takes the best that the machine runs. The same function serves the plugins of the project and those built out of tree with
# find_package(millscope).

if(NOT DEFINED MILLSCOPE_PLUGIN_OUTPUT)
  set(MILLSCOPE_PLUGIN_OUTPUT ${CMAKE_BINARY_DIR}/lib/millscope/plugins)
endif()

function(_millscope_plugin_variant name folder march sources links component)
  set(target ${name}_plugin)
  if(folder)
    set(target ${name}_plugin_${folder})
  endif()
  add_library(${target} MODULE ${sources})
  target_link_libraries(${target} PRIVATE millscope::sdk ${links})
  if(TARGET millscope_options)
    target_link_libraries(${target} PRIVATE millscope_options)
  endif()
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Sanitize>>:-O3> -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden ${march})
  set_target_properties(${target} PROPERTIES PREFIX "lib" OUTPUT_NAME ${name} SUFFIX ".so" UNITY_BUILD OFF
                        LIBRARY_OUTPUT_DIRECTORY ${MILLSCOPE_PLUGIN_OUTPUT}/${folder})
  # The loader refuses what others can write, whatever the umask of the build was.
  add_custom_command(TARGET ${target} POST_BUILD COMMAND chmod go-w $<TARGET_FILE:${target}> $<TARGET_FILE_DIR:${target}> ${MILLSCOPE_PLUGIN_OUTPUT}
                     VERBATIM)
  if(NOT MILLSCOPE_PLUGIN_NO_INSTALL)
    include(GNUInstallDirs)
    set(destination ${CMAKE_INSTALL_LIBDIR}/millscope/plugins)
    install(TARGETS ${target} LIBRARY DESTINATION ${destination}/${folder} COMPONENT ${component})
    install(CODE "execute_process(COMMAND chmod go-w \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${destination}\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${destination}/${folder}\")"
            COMPONENT ${component})
  endif()
endfunction()

function(millscope_add_plugin name)
  cmake_parse_arguments(arg "WIDE" "COMPONENT" "SOURCES;LINK" ${ARGN})
  if(NOT arg_COMPONENT)
    set(arg_COMPONENT ${CMAKE_INSTALL_DEFAULT_COMPONENT_NAME})  # of an installation; a package may hold one component
  endif()
  if(NOT arg_COMPONENT)
    set(arg_COMPONENT plugins)
  endif()
  if(NOT arg_SOURCES)
    message(FATAL_ERROR "millscope_add_plugin(${name}): SOURCES is missing")
  endif()
  # A build folder keeps what an earlier commit built under the other kind of name; two libraries of one plugin must not be found.
  if(arg_WIDE)
    file(REMOVE ${MILLSCOPE_PLUGIN_OUTPUT}/lib${name}.so)
    _millscope_plugin_variant(${name} v2 "-march=x86-64-v2" "${arg_SOURCES}" "${arg_LINK}" ${arg_COMPONENT})
    _millscope_plugin_variant(${name} v3 "-march=x86-64-v3" "${arg_SOURCES}" "${arg_LINK}" ${arg_COMPONENT})
    _millscope_plugin_variant(${name} v4 "-march=x86-64-v4;-mprefer-vector-width=512" "${arg_SOURCES}" "${arg_LINK}" ${arg_COMPONENT})
    add_custom_target(${name}_plugin DEPENDS ${name}_plugin_v2 ${name}_plugin_v3 ${name}_plugin_v4)
  else()
    foreach(folder v2 v3 v4)
      file(REMOVE ${MILLSCOPE_PLUGIN_OUTPUT}/${folder}/lib${name}.so)
    endforeach()
    _millscope_plugin_variant(${name} "" "" "${arg_SOURCES}" "${arg_LINK}" ${arg_COMPONENT})
  endif()
endfunction()
