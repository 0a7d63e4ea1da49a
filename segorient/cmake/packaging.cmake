# SPDX-License-Identifier: BSD-3-Clause
# What is installed beside the targets, and the .deb: pkg-config file, `uninstall`, CPack.

# Debian names PCL's pkg-config files without a version, PCL itself with one.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(SEGORIENT_PCL_PLAIN QUIET pcl_search)
endif()
set(suffix "")
if(NOT SEGORIENT_PCL_PLAIN_FOUND)
  set(suffix "-${PCL_VERSION_MAJOR}.${PCL_VERSION_MINOR}")
endif()
set(SEGORIENT_PC_REQUIRES
  "pcl_common${suffix} pcl_search${suffix} pcl_features${suffix} pcl_surface${suffix} eigen3")
# From the file's place to the prefix, so that the installed tree can be moved.
file(RELATIVE_PATH SEGORIENT_PC_UP /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${PROJECT_SOURCE_DIR}/segorient/cmake/segorient.pc.in
  ${PROJECT_BINARY_DIR}/segorient.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/segorient.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/package.xml
  DESTINATION ${CMAKE_INSTALL_DATADIR}/segorient)

# The manual page, and what Debian's policy wants beside it: compressed, without a time of its own.
set(pages ${PROJECT_SOURCE_DIR}/segorient/packaging)
find_program(SEGORIENT_GZIP gzip)
mark_as_advanced(SEGORIENT_GZIP)
if(SEGORIENT_GZIP)
  foreach(page segorient.1 changelog)
    add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/${page}.gz
      COMMAND ${SEGORIENT_GZIP} -9nc ${pages}/${page} > ${PROJECT_BINARY_DIR}/${page}.gz
      DEPENDS ${pages}/${page} VERBATIM)
  endforeach()
  add_custom_target(segorient_pages ALL
    DEPENDS ${PROJECT_BINARY_DIR}/segorient.1.gz ${PROJECT_BINARY_DIR}/changelog.gz)
  install(FILES ${PROJECT_BINARY_DIR}/segorient.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz ${pages}/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/segorient)
endif()

if(NOT TARGET uninstall)
  add_custom_target(uninstall
    COMMAND ${CMAKE_COMMAND} -DMANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt
      -P ${PROJECT_SOURCE_DIR}/segorient/cmake/uninstall.cmake
    COMMENT "Removing what the last install put in place")
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME segorient)
set(CPACK_PACKAGE_VENDOR "segorient authors")
set(CPACK_PACKAGE_CONTACT "segorient maintainers <maintainers@segorient.invalid>")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "segmented, consistently oriented point clouds for PCL")
set(CPACK_PACKAGE_DESCRIPTION_FILE ${PROJECT_SOURCE_DIR}/segorient/packaging/description.txt)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# lintian has no errors to tell; packaging/lintian-overrides says what its warnings are about.
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/segorient/packaging/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/segorient/cmake/package_debian.cmake)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Our own libraries are where the build put them.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libpcl-dev)
if(TARGET segorient_python)
  # Extensions are for one version of Python.
  string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" version "${SEGORIENT_PYTHON_VERSION}")
  math(EXPR next "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= ${version}), python3 (<< ${CMAKE_MATCH_1}.${next}), python3-numpy")
endif()
include(CPack)
