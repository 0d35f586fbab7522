# rtsl_bitcode(library symbol TARGET SOURCES...): compiles freestanding C++ to LLVM bitcode for a
# TARGET, host or gpu, and embeds the linked module into a static library, as the bytes between the
# symbols <symbol>Begin and <symbol>End. RTSL_IN_PROGRAM is defined: what the code asks of the
# program that it is linked into (runtime/device/ray/Abi.h) folds there.
find_program(RTSL_CLANG NAMES clang++-22 PATHS /usr/lib/llvm-22/bin REQUIRED)
find_program(RTSL_LLVM_LINK NAMES llvm-link-22 llvm-link PATHS /usr/lib/llvm-22/bin REQUIRED)

# No errno: a square root is then one instruction. Loops that are to be unrolled may wait for the
# program that makes their bounds constant.
set(RTSL_BITCODE_FLAGS -std=c++17 -O2 -ffreestanding -nostdlib -ffp-contract=off -fno-math-errno
    -fno-exceptions -fno-rtti -fno-threadsafe-statics -DRTSL_IN_PROGRAM -Wall -Wextra
    -Wno-pass-failed)
# The features are those of the host's baseline and no others, so that the code generator may inline
# these functions into shaders. For a GPU the code generator replaces them by those of the requested
# architecture.
set(RTSL_BITCODE_FLAGS_host -march=x86-64-v3)
# Without a CUDA toolkit clang's default PTX version is too old for current GPUs; sm_75 needs at
# least 6.3.
set(RTSL_BITCODE_FLAGS_gpu --target=nvptx64-nvidia-cuda -march=sm_75 -Xclang -target-feature
  -Xclang +ptx63)

function(rtsl_bitcode library symbol target)
  set(modules)
  foreach(source IN LISTS ARGN)
    get_filename_component(stem "${source}" NAME_WE)
    set(module "${CMAKE_CURRENT_BINARY_DIR}/${symbol}.${stem}.bc")
    add_custom_command(OUTPUT "${module}"
      COMMAND "${RTSL_CLANG}" ${RTSL_BITCODE_FLAGS} ${RTSL_BITCODE_FLAGS_${target}}
        -I "${PROJECT_SOURCE_DIR}" -MD -MF "${module}.d" -MT "${module}"
              -emit-llvm -c "${source}" -o "${module}"
      DEPENDS "${source}" DEPFILE "${module}.d"
        COMMENT "Compiling ${stem} to bitcode for the ${target}" VERBATIM)
    list(APPEND modules "${module}")
  endforeach()
  set(linked "${CMAKE_CURRENT_BINARY_DIR}/${symbol}.bc")
  add_custom_command(OUTPUT "${linked}" COMMAND "${RTSL_LLVM_LINK}" ${modules} -o "${linked}"
    DEPENDS ${modules} COMMENT "Linking ${symbol}.bc" VERBATIM)
  rtsl_embed(${library} ${symbol} "${linked}")
endfunction()

# rtsl_ptx(library symbol SOURCE): compiles freestanding C++ with kernels to PTX for the oldest GPU,
# and embeds it in the same way; a zero follows its end.
function(rtsl_ptx library symbol source)
  set(ptx "${CMAKE_CURRENT_BINARY_DIR}/${symbol}.ptx")
  add_custom_command(OUTPUT "${ptx}"
    COMMAND "${RTSL_CLANG}" ${RTSL_BITCODE_FLAGS} ${RTSL_BITCODE_FLAGS_gpu}
      -I "${PROJECT_SOURCE_DIR}" -MD -MF "${ptx}.d" -MT "${ptx}" -S "${source}" -o "${ptx}"
    DEPENDS "${source}" DEPFILE "${ptx}.d" COMMENT "Compiling ${symbol} to PTX" VERBATIM)
  rtsl_embed(${library} ${symbol} "${ptx}")
endfunction()

function(rtsl_embed library symbol file)
  # The assembler puts the file into the object as it is: no megabytes of C++ to parse.
  set(embedding "${CMAKE_CURRENT_BINARY_DIR}/${symbol}Bytes.cpp")
  file(CONFIGURE OUTPUT "${embedding}" CONTENT [[
// Made by cmake/RtslBitcode.cmake.
asm(".section .rodata.@symbol@, \"a\", @progbits\n"
    ".balign 16\n"
    ".globl @symbol@Begin\n"
    ".globl @symbol@End\n"
    "@symbol@Begin:\n"
    ".incbin \"@file@\"\n"
    "@symbol@End:\n"
    ".byte 0\n"
    ".text\n");
]] @ONLY)
  # Without ccache, which does not see what .incbin reads and would return an object with earlier
  # bytes. The launcher is a property of targets only.
  set_source_files_properties("${embedding}" PROPERTIES OBJECT_DEPENDS "${file}"
    SKIP_UNITY_BUILD_INCLUSION ON)
  add_library(${symbol}Bytes OBJECT "${embedding}")
  set_target_properties(${symbol}Bytes PROPERTIES CXX_COMPILER_LAUNCHER "")
  target_sources(${library} PRIVATE $<TARGET_OBJECTS:${symbol}Bytes>)
endfunction()
