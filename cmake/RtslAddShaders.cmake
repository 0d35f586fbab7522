# rtsl_add_shaders(target NAME name SHADERS files... [TRACE split|recurse] [FP strict|fast]):
# compiles RTSL files to C++ when the target is built, again when one of them or what they import
# changes, and adds it to the target. A file may be a module of the standard library, such as
# std.materials.Principled. The target then has `const RtslShaders *name_shaders()`
# (declare it with RTSL_DECLARE_SHADERS(name)) and links rtsl::runtime. TRACE selects how methods
# that trace are compiled: their states, or calls. FP fast lets the C++ compiler change the last
# digits for speed (docs/fast.md).
function(rtsl_add_shaders target)
  cmake_parse_arguments(ARG "" "NAME;TRACE;FP" "SHADERS" ${ARGN})
  if(NOT ARG_NAME OR NOT ARG_SHADERS)
    message(FATAL_ERROR "rtsl_add_shaders: give a NAME and SHADERS")
  endif()
  set(files)
  foreach(file IN LISTS ARG_SHADERS)
    if(file MATCHES "^std\\.[A-Za-z0-9_.]+$" AND NOT file MATCHES "\\.rtsl$")
      string(REPLACE "." "/" file "${file}")
      set(file "${RTSL_LIBRARY}/${file}.rtsl")
      if(NOT EXISTS "${file}")
        message(FATAL_ERROR "rtsl_add_shaders: the standard library has no ${file}")
      endif()
    endif()
    get_filename_component(file "${file}" ABSOLUTE)
    list(APPEND files "${file}")
  endforeach()
  set(options)
  if(ARG_TRACE)
    list(APPEND options "--trace=${ARG_TRACE}")
  endif()
  if(ARG_FP)
    list(APPEND options "--fp=${ARG_FP}")
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${target}-shaders") # others may have some of that name
  file(MAKE_DIRECTORY "${folder}")
  set(generated "${folder}/${ARG_NAME}.cpp")
  add_custom_command(OUTPUT "${generated}"
    COMMAND rtsl::rtslc compile ${files} --emit=cpp ${options} -o "${generated}" -MD
      -MF "${generated}.d"
    DEPENDS ${files} rtsl::rtslc DEPFILE "${generated}.d"
    COMMENT "Compiling the shaders of ${ARG_NAME} to C++" VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
  # Square roots and fused operations as instructions: the results are the same, and quicker.
  set_source_files_properties("${generated}"
    PROPERTIES COMPILE_OPTIONS
      "-fno-math-errno;$<$<BOOL:${RTSL_SHADER_FLAGS}>:${RTSL_SHADER_FLAGS}>")
  target_link_libraries(${target} PRIVATE rtsl::runtime)
endfunction()

if(NOT DEFINED RTSL_SHADER_FLAGS AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(RTSL_SHADER_FLAGS -march=x86-64-v3) # what the runtime is compiled for
endif()

if(NOT DEFINED RTSL_LIBRARY) # in the build tree; the installed package sets it
  get_filename_component(RTSL_LIBRARY "${CMAKE_CURRENT_LIST_DIR}/../library" ABSOLUTE)
endif()
