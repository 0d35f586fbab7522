# rtsl_unit_test(NAME [EACH] [COMPUTES] SOURCES... LINK libraries...): the GoogleTest program
# test-NAME. CTest runs it as one test, NAME, which takes less time than a process for each of its
# hundreds of tests; --gtest_filter=Suite.Test chooses among them. With EACH, for tests that take
# seconds, they are tests of CTest, called NAME.Suite.Test. Only with COMPUTES, for tests whose own
# code takes seconds, it is optimised: compiling tests mostly takes longer than running them, and
# four times as long with optimisation.
include(GoogleTest)

# rtsl_precompiled_tests(NAME [OTHER]): for tests that do not read MLIR's headers. GoogleTest's are
# precompiled for test-NAME, or those of test-OTHER are used, which is compiled with the same
# options.
function(rtsl_precompiled_tests name)
  if(ARGC EQUAL 1)
    target_precompile_headers(test-${name} PRIVATE <gtest/gtest.h> <fmt/format.h>)
  else()
    target_precompile_headers(test-${name} REUSE_FROM test-${ARGV1})
  endif()
endfunction()

# rtsl_precompiled_ir_tests(NAME): the same for tests that read MLIR's headers, of which test-lower
# is the first.
function(rtsl_precompiled_ir_tests name)
  if(name STREQUAL lower)
    target_precompile_headers(test-lower PRIVATE "${PROJECT_SOURCE_DIR}/codegen/ir/Precompiled.h")
  else()
    target_precompile_headers(test-${name} REUSE_FROM test-lower)
  endif()
endfunction()

function(rtsl_unit_test name)
  cmake_parse_arguments(ARG "EACH;COMPUTES" "" "LINK" ${ARGN})
  add_executable(test-${name} ${ARG_UNPARSED_ARGUMENTS})
  target_include_directories(test-${name} SYSTEM PRIVATE ${MLIR_INCLUDE_DIRS} ${LLVM_INCLUDE_DIRS})
  target_link_libraries(test-${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  target_compile_definitions(test-${name} PRIVATE RTSL_ROOT="${PROJECT_SOURCE_DIR}")
  if(NOT ARG_COMPUTES)
    target_compile_options(test-${name} PRIVATE -O0)
  endif()
  rtsl_warnings(test-${name})
  if(ARG_EACH)
    # Tests are listed when they are run: a build starts none of the programs that it makes.
    gtest_discover_tests(test-${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 120
      DISCOVERY_MODE PRE_TEST)
  else()
    add_test(NAME ${name} COMMAND test-${name} --gtest_brief=1)
  endif()
endfunction()
