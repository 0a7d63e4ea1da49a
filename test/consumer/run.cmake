# SPDX-License-Identifier: BSD-3-Clause
# Installs the build into a directory of its own, builds the consumer against that, and runs both it and
# the installed program.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/installed)
run(${CMAKE_COMMAND} --install ${BUILD_DIRECTORY} --prefix ${prefix})
# An installed package may not look at where it was built.
file(GLOB_RECURSE exported ${prefix}/*.cmake)
foreach(file IN LISTS exported)
  file(READ ${file} text)
  string(FIND "${text}" "${BUILD_DIRECTORY}" position)
  if(NOT position EQUAL -1)
    message(FATAL_ERROR "${file} names the build directory")
  endif()
endforeach()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK}/build)
# The same without CMake.
find_program(pkg_config pkg-config)
if(pkg_config)
  file(GLOB_RECURSE description ${prefix}/*/segorient.pc)
  get_filename_component(directory ${description} DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${directory})
  execute_process(COMMAND ${pkg_config} --cflags --libs segorient
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  get_filename_component(library_directory ${directory} DIRECTORY)
  run(${COMPILER} -std=c++17 ${CMAKE_CURRENT_LIST_DIR}/consumer.cpp -o ${WORK}/by_pkg_config ${flags}
    -Wl,-rpath,${library_directory})
  run(${WORK}/by_pkg_config)
endif()
run(${WORK}/build/consumer)
run(${WORK}/build/consumer_of_all)
run(${prefix}/bin/segorient orient ${DATA} ${WORK}/oriented.ply)
# With the module that is loaded for pictures.
run(${prefix}/bin/segorient render ${WORK}/oriented.ply ${WORK}/oriented.png)
# The Python package, if there is one, finds the libraries where they were installed.
file(GLOB package ${prefix}/lib/python*/*-packages)
if(package)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${package} PYTHONDONTWRITEBYTECODE=1 ${PYTHON}
    -c "import segorient, numpy; assert segorient.knn(numpy.eye(3), 3).indices.shape == (3, 3)")
endif()
# Nothing but directories stays behind.
run(${CMAKE_COMMAND} --build ${BUILD_DIRECTORY} --target uninstall)
file(GLOB_RECURSE left LIST_DIRECTORIES FALSE ${prefix}/*)
if(left)
  message(FATAL_ERROR "uninstall left ${left}")
endif()
