# How everything is compiled: warnings, the host's baseline architecture and strict floating point.
find_program(RTSL_CCACHE ccache)
if(RTSL_CCACHE)
  # ccache needs this sloppiness to cache precompiled headers. It takes the names of headers from
  # the compiler, and does not run the preprocessor first, which takes a tenth of the time of a
  # first build.
  set(rtslCcacheSettings CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=true)
  set(CMAKE_C_COMPILER_LAUNCHER "${RTSL_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env ${rtslCcacheSettings} "${RTSL_CCACHE}")
endif()

# Optimised lightly, with assertions and line tables: tests run fast and a crash still has a
# backtrace.
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

# Contraction would make the bits of a picture depend on the compiler; x86-64-v3 has the fused
# operations that correctly rounded functions request explicitly.
add_compile_options(-ffp-contract=off -march=x86-64-v3 -ffunction-sections -fdata-sections)

if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 vectorises {float(a), float(b)} in doubles and does not round one of them.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fno-tree-slp-vectorize>)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
  # A precompiled header out of ccache is older than the headers that it was made of; ccache has
  # compared those.
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
  # std::stable_sort of libstdc++ 12 uses std::get_temporary_buffer.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-deprecated-declarations>)
endif()

# lld links the static LLVM components in seconds.
if(EXISTS /usr/lib/llvm-22/bin/ld.lld)
  add_link_options(-B/usr/lib/llvm-22/bin -fuse-ld=lld)
endif()
add_link_options(-Wl,--gc-sections)

# What they find ends a program: many tests do not read what it prints. The assertions are those of
# containers, which see an index beyond the end that is still in allocated memory. Not checked are
# types behind pointers to functions: that reads what is before the function, which may be nothing
# if the JIT has made it.
if(RTSL_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer
    -fno-sanitize=vptr,function -fno-sanitize-recover=undefined)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=address,undefined)
endif()
if(RTSL_FUZZ) # libFuzzer's own main is linked by its targets alone
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Warnings for code of ours (not for generated parsers).
function(rtsl_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter)
endfunction()

# rtsl_library(name [SOURCES...] [FOLDERS folders...] [LINK libraries...]): a static library of this
# tree. Without sources it has all of the folders, by default of this one. Includes are written from
# the root of the tree, or of the build tree for generated files.
function(rtsl_library name)
  cmake_parse_arguments(ARG "" "" "FOLDERS;LINK" ${ARGN})
  set(sources ${ARG_UNPARSED_ARGUMENTS})
  if(NOT sources)
    set(folders ${ARG_FOLDERS})
    if(NOT folders)
      set(folders .)
    endif()
    list(TRANSFORM folders APPEND "/*.cpp")
    file(GLOB sources CONFIGURE_DEPENDS ${folders})
  endif()
  add_library(${name} STATIC ${sources})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}")
  target_link_libraries(${name} PUBLIC ${ARG_LINK})
  rtsl_warnings(${name})
endfunction()

# rtsl_command_line(target): for targets that read a command line by CLI11, whose templates take
# longer than our code: two thirds of it to optimise. So they are optimised less, and the headers
# precompiled, by rtslCommandLine.
function(rtsl_command_line target)
  target_compile_options(${target} PRIVATE -O1)
  if(target STREQUAL rtslCommandLine)
    target_precompile_headers(${target} PRIVATE <CLI/CLI.hpp> <fmt/format.h>)
  else()
    target_precompile_headers(${target} REUSE_FROM rtslCommandLine)
  endif()
endfunction()

# rtsl_precompiled_standard(targets...): for targets of many small files, of whose time a third to a
# half is reading these headers. A file still includes what it uses.
function(rtsl_precompiled_standard)
  foreach(target ${ARGN})
    foreach(header algorithm array cmath cstring functional map memory optional set string
      unordered_map utility variant vector fmt/format.h)
      target_precompile_headers(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:<${header}$<ANGLE-R>>")
    endforeach()
  endforeach()
endfunction()

# For targets that read MLIR's headers: they are precompiled once, by rtslIr. Of g++'s result ccache
# reads a checksum (codegen/ir/CMakeLists.txt): hashing its 484 MB for each file would take as long
# as compiling the file.
function(rtsl_precompiled_ir target)
  target_precompile_headers(${target} REUSE_FROM rtslIr)
  if(TARGET rtslPrecompiledChecksum)
    add_dependencies(${target} rtslPrecompiledChecksum)
    set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND};-E;env;${rtslCcacheSettings};CCACHE_PCH_EXTSUM=true;${RTSL_CCACHE}")
  endif()
endfunction()
