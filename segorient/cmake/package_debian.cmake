# SPDX-License-Identifier: BSD-3-Clause
# What Debian's policy asks of a package beyond the files: run by CPack on the staged tree.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
# In /usr/lib the system finds libraries without being told where; a tree that can be moved, as a
# plain install makes it, needs to be told.
file(GLOB_RECURSE staged LIST_DIRECTORIES FALSE ${CPACK_TEMPORARY_DIRECTORY}/usr/bin/*
  ${CPACK_TEMPORARY_DIRECTORY}/usr/lib/*.so*)
foreach(file ${staged})
  if(NOT IS_SYMLINK ${file})
    file(RPATH_REMOVE FILE ${file})
  endif()
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/../packaging/lintian-overrides
  ${CPACK_TEMPORARY_DIRECTORY}/usr/share/lintian/overrides/segorient COPYONLY)
