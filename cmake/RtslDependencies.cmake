# The libraries that rtslc uses; docs/dependencies.md gives the reason for each. `make dependencies`
# installs them.
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(Threads REQUIRED)

# Debian's MLIR accepts only its exact version, so none is required here. Its targets carry the
# shared LLVM in their link interface; together with the static components that would put two LLVMs
# into one process.
list(APPEND CMAKE_PREFIX_PATH /usr/lib/llvm-22)
set(MLIR_DIR /usr/lib/llvm-22/lib/cmake/mlir CACHE PATH "where MLIRConfig.cmake lies")
find_package(MLIR REQUIRED CONFIG)
get_property(rtslImported DIRECTORY PROPERTY IMPORTED_TARGETS)
foreach(target IN LISTS rtslImported)
  if(target MATCHES "^MLIR")
    get_target_property(libraries ${target} INTERFACE_LINK_LIBRARIES)
    if(libraries)
      list(REMOVE_ITEM libraries LLVM)
      set_target_properties(${target} PROPERTIES INTERFACE_LINK_LIBRARIES "${libraries}")
    endif()
  endif()
endforeach()
list(APPEND CMAKE_MODULE_PATH "${MLIR_CMAKE_DIR}" "${LLVM_CMAKE_DIR}")

if(RTSL_TESTS)
  find_package(GTest REQUIRED)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()
