# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# `docs`: pages of the public headers, by doxygen, in <build>/docs/html. A warning is an error, and a member without words is one.
find_package(Doxygen 1.9 QUIET)
find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
if(DOXYGEN_FOUND AND Python3_FOUND)
  set(PGDR_DOCS_DIR ${PROJECT_BINARY_DIR}/docs)
  file(MAKE_DIRECTORY ${PGDR_DOCS_DIR})
  configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PGDR_DOCS_DIR}/Doxyfile @ONLY)
  add_custom_target(docs COMMAND ${DOXYGEN_EXECUTABLE} ${PGDR_DOCS_DIR}/Doxyfile VERBATIM)
endif()
