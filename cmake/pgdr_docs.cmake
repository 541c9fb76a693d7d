# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# `docs`: pages of the public headers, by doxygen, in <build>/docs/html. A warning is an error. Of the headers that the
# shared library exports, every member must have its words (Doxyfile.strict, for the tests).
find_package(Doxygen 1.9 QUIET)
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(DOXYGEN_FOUND AND Python3_FOUND)
  set(PGDR_DOCS_DIR ${PROJECT_BINARY_DIR}/docs)
  file(MAKE_DIRECTORY ${PGDR_DOCS_DIR})
  configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PGDR_DOCS_DIR}/Doxyfile @ONLY)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*/pgdr/*.hpp)
  set(inputs "")
  foreach(header IN LISTS headers)
    file(STRINGS ${header} exported REGEX "^namespace pgdr PGDR_API")
    if(exported)
      string(APPEND inputs " \"${header}\"")
    endif()
  endforeach()
  file(WRITE ${PGDR_DOCS_DIR}/Doxyfile.strict
    "@INCLUDE = ${PGDR_DOCS_DIR}/Doxyfile\nINPUT = ${inputs}\nEXTRACT_ALL = NO\nHTML_OUTPUT = html.strict\n")
  add_custom_target(docs COMMAND ${DOXYGEN_EXECUTABLE} ${PGDR_DOCS_DIR}/Doxyfile VERBATIM)
endif()
