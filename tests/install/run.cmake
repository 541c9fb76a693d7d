# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Installs the build into a fresh folder, builds the consumer against it, and runs it.
# cmake -DBUILD=<build folder> -DSOURCE=<repository> -DWORK=<scratch folder> -DFLAGS=<compiler flags> -P run.cmake
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# The package must work where it has been moved to, and name no folder of this machine's build.
file(RENAME ${WORK}/prefix ${WORK}/moved)
file(GLOB_RECURSE package ${WORK}/moved/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  foreach(folder IN ITEMS ${BUILD} ${SOURCE})
    string(FIND "${text}" "${folder}/" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()

# What users include needs neither CGAL nor Eigen.
file(GLOB headers ${WORK}/moved/include/pgdr/*.hpp)
list(LENGTH headers count)
if(count EQUAL 0)
  message(FATAL_ERROR "no header was installed")
endif()
foreach(file IN LISTS headers)
  file(STRINGS ${file} lines REGEX "#[ ]*include.*(CGAL|Eigen|gmp|mpfr)")
  if(lines)
    message(FATAL_ERROR "${file}: ${lines}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/tests/install -B ${WORK}/build -DCMAKE_BUILD_TYPE=Debug
  "-DCMAKE_CXX_FLAGS=${FLAGS}" "-Dpgdr_ROOT=${WORK}/moved")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)

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
