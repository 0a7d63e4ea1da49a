# SPDX-License-Identifier: BSD-3-Clause
# Makes the .deb, looks at what it says it needs, unpacks it elsewhere and runs its program.
find_program(shlibdeps dpkg-shlibdeps)
if(NOT shlibdeps)
  message("needs dpkg-shlibdeps (package dpkg-dev)")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CPACK} -G DEB --config ${BUILD_DIRECTORY}/CPackConfig.cmake -B ${WORK}
  COMMAND_ERROR_IS_FATAL ANY)
file(GLOB package ${WORK}/*.deb)
execute_process(COMMAND dpkg-deb -f ${package} Depends OUTPUT_VARIABLE depends COMMAND_ERROR_IS_FATAL ANY)
message("Depends: ${depends}")
foreach(needed libpcl-common libpcl-search libpcl-features libpcl-surface libpcl-visualization libc6)
  if(NOT depends MATCHES ${needed})
    message(FATAL_ERROR "the package does not ask for ${needed}")
  endif()
endforeach()
execute_process(COMMAND dpkg-deb -x ${package} ${WORK}/root COMMAND_ERROR_IS_FATAL ANY)
# Installed, the libraries are where the loader looks.
set(loader LD_LIBRARY_PATH=${WORK}/root/usr/lib)
if(EXISTS ${WORK}/root/usr/lib/python3/dist-packages/segorient)
  if(NOT depends MATCHES "python3-numpy")
    message(FATAL_ERROR "the package does not ask for python3-numpy")
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${WORK}/root/usr/lib/python3/dist-packages
    PYTHONDONTWRITEBYTECODE=1 ${loader} ${PYTHON} -c "import segorient" COMMAND_ERROR_IS_FATAL ANY)
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E env ${loader} ${WORK}/root/usr/bin/segorient orient ${DATA} ${WORK}/oriented.pcd
  COMMAND_ERROR_IS_FATAL ANY)
