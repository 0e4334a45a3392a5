# textplane.pc for pkg-config, and the Debian package of CPack: headers alone, the same for all architectures.
set(pc_include ${CMAKE_INSTALL_INCLUDEDIR})
if(NOT IS_ABSOLUTE ${pc_include})
  set(pc_include "\${prefix}/${pc_include}")
endif()
configure_file(cmake/textplane.pc.in ${CMAKE_CURRENT_BINARY_DIR}/textplane.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/textplane.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # Nothing has to be built before.
  set(CPACK_PACKAGE_NAME libtextplane-dev)
  set(CPACK_PACKAGE_VENDOR "textplane contributors")
  set(CPACK_PACKAGE_CONTACT "textplane contributors <maintainers@textplane.invalid>")
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_GENERATOR DEB)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.3)")
  set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "A text patch that a camera sees is one plane. Poses and planes are found by
minimising the normalised intensity difference with other frames.
The headers depend on Eigen alone.")
  set(CPACK_TEXTPLANE_SOURCE ${PROJECT_SOURCE_DIR})
  set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
  include(CPack)
endif()
