# cmake --install: the programs, the standard library, the runtime library with its headers,
# find_package(rtsl), pkg-config, a man page and completions. Headers keep their folders below
# include/rtsl, which is an include path of rtsl::runtime.
include(CMakePackageConfigHelpers)

install(TARGETS rtsl rtsl-images rtsl-meshes LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(DIRECTORY include/rtsl DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
foreach(part support language runtime)
  install(DIRECTORY ${part}/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/rtsl/${part}"
    FILES_MATCHING PATTERN "*.h" PATTERN "*.def" PATTERN "c" EXCLUDE)
endforeach()

set(rtslPackage "${CMAKE_INSTALL_LIBDIR}/cmake/rtsl")
configure_package_config_file(cmake/rtslConfig.cmake.in "${PROJECT_BINARY_DIR}/rtslConfig.cmake.in"
  INSTALL_DESTINATION "${rtslPackage}"
  PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_BINDIR
            CMAKE_INSTALL_DATADIR)
file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/rtslConfig.cmake" INPUT
  "${PROJECT_BINARY_DIR}/rtslConfig.cmake.in")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/rtslConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/rtslConfig.cmake"
  "${PROJECT_BINARY_DIR}/rtslConfigVersion.cmake"
  cmake/RtslAddShaders.cmake DESTINATION "${rtslPackage}")

# An installed tree may be moved.
file(RELATIVE_PATH rtslPrefixFromPackage "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file(cmake/rtsl.pc.in "${PROJECT_BINARY_DIR}/rtsl.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/rtsl.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

install(DIRECTORY library DESTINATION "${CMAKE_INSTALL_DATADIR}/rtslc"
  FILES_MATCHING PATTERN "*.rtsl" PATTERN "*.json")
install(FILES tools/man/rtslc.1 DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES tools/completion/rtslc.bash
  DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME rtslc)
install(FILES tools/completion/_rtslc DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions")
