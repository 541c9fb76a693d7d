# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Installs the build into a fresh folder, builds the consumer against it, with CMake and with pkg-config, and runs it.
# cmake -DBUILD=<build folder> -DSOURCE=<repository> -DWORK=<scratch folder> -DFLAGS=<compiler flags> -DKIND=static|shared
#   -DCXX=<compiler> -DPKG_CONFIG=<pkg-config> -DPYTHON=<interpreter> -DNM=<nm> -DCOMMAND=<archives of the command>
#   -DMPI_COMPILER=<of the MPI that pgdr::mpi is for; empty: it was not built> -P run.cmake
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component pgdr_${KIND})

# The package must work where it has been moved to, and name no folder of this machine's build.
file(RENAME ${WORK}/prefix ${WORK}/moved)
file(GLOB_RECURSE package ${WORK}/moved/*.cmake ${WORK}/moved/*.pc)
foreach(file IN LISTS package)
  file(READ ${file} text)
  foreach(folder IN ITEMS ${BUILD} ${SOURCE})
    string(FIND "${text}" "${folder}/" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

# What users include needs no CGAL.
file(GLOB headers ${WORK}/moved/include/pgdr/*.hpp)
list(LENGTH headers count)
if(count EQUAL 0)
  message(FATAL_ERROR "no header was installed")
endif()
foreach(file IN LISTS headers)
  file(STRINGS ${file} lines REGEX "#[ ]*include.*(CGAL|gmp|mpfr)")
  if(lines)
    message(FATAL_ERROR "${file}: ${lines}")
  endif()
endforeach()

# A shared library exports the public face, all that the command needs of it, and nothing else.
file(GLOB_RECURSE library ${WORK}/moved/libpgdr.*)
list(GET library 0 library)
if(KIND STREQUAL shared)
  run(${PYTHON} ${SOURCE}/tests/install/check_exports.py ${NM} ${library} ${WORK}/moved/include ${COMMAND})
endif()

if(MPI_COMPILER)
  set(with_mpi -DWITH_MPI=ON -DMPI_CXX_COMPILER=${MPI_COMPILER})
endif()
if(KIND STREQUAL static)  # once: both kinds have the same headers
  set(each_header -DHEADERS=${WORK}/moved/include/pgdr)
endif()
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/tests/install -B ${WORK}/build -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}" "-Dpgdr_ROOT=${WORK}/moved" ${each_header} ${with_mpi})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
if(MPI_COMPILER)
  run(${WORK}/build/mpi_consumer)  # one process needs no launcher
endif()

# Without CMake.
cmake_path(GET library PARENT_PATH libraries)
set(ENV{PKG_CONFIG_PATH} ${libraries}/pkgconfig)
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs pgdr OUTPUT_VARIABLE words OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(words UNIX_COMMAND "${words}")
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
run(${CXX} -std=c++20 ${flags} ${SOURCE}/tests/install/consumer.cpp -o ${WORK}/with_pkg_config ${words})
set(ENV{LD_LIBRARY_PATH} ${libraries})
run(${WORK}/with_pkg_config)

# The README's ten lines are this program.
file(READ ${SOURCE}/tests/install/readme_example.cpp example)
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "${example}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "README.md does not show tests/install/readme_example.cpp")
endif()
file(MAKE_DIRECTORY ${WORK}/run/tests)
file(COPY ${SOURCE}/tests/models DESTINATION ${WORK}/run/tests)
execute_process(COMMAND ${WORK}/build/readme_example WORKING_DIRECTORY ${WORK}/run COMMAND_ERROR_IS_FATAL ANY)
if(NOT EXISTS ${WORK}/run/bracket.vtu)
  message(FATAL_ERROR "the README's example wrote no mesh")
endif()
