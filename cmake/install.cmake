# find_package(textplane) support. The headers have no architecture, so the version file is ARCH_INDEPENDENT.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS textplane EXPORT textplane-targets)
install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.inl")
set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/textplane)
install(EXPORT textplane-targets NAMESPACE textplane:: DESTINATION ${package_dir})
configure_package_config_file(cmake/textplane-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/textplane-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/textplane-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/textplane-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/textplane-config-version.cmake
  DESTINATION ${package_dir})
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/textplane)  # for ROS: REP 136
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
include(cmake/package.cmake)
