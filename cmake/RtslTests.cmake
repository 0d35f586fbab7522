# rtsl_unit_test(NAME SOURCES... LINK libraries...): the GoogleTest program test-NAME. Its tests are called NAME.Suite.Test.
include(GoogleTest)

function(rtsl_unit_test name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(test-${name} ${ARG_UNPARSED_ARGUMENTS})
  target_include_directories(test-${name} SYSTEM PRIVATE ${MLIR_INCLUDE_DIRS} ${LLVM_INCLUDE_DIRS})
  target_link_libraries(test-${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  target_compile_definitions(test-${name} PRIVATE RTSL_ROOT="${PROJECT_SOURCE_DIR}")
  rtsl_warnings(test-${name})
  # Tests are listed when they are run: a build starts none of the programs that it makes.
  gtest_discover_tests(test-${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 120 DISCOVERY_MODE PRE_TEST)
endfunction()
