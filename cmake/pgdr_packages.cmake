# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Packages for Debian, by tools/deb: pgdr (the command), libpgdr-dev (headers and the static library), python3-pgdr.
# They depend on the libraries of the system that they were built on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The pgdr authors")
set(CPACK_PACKAGE_CONTACT "The pgdr authors <pgdr@localhost>")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_SOURCE_DIR}/dist)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL pgdr_command pgdr_static)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_DEBIAN_PGDR_COMMAND_PACKAGE_NAME pgdr)
set(CPACK_DEBIAN_PGDR_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PGDR_COMMAND_DESCRIPTION "Delaunay meshes with guaranteed quality, in 3D and 2D
 Meshes surfaces and planar domains, in parallel and reproducibly, and checks meshes with exact arithmetic.")

set(CPACK_DEBIAN_PGDR_STATIC_PACKAGE_NAME libpgdr-dev)
set(CPACK_DEBIAN_PGDR_STATIC_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PGDR_STATIC_PACKAGE_DEPENDS "libtbb-dev, libgmp-dev, libmpfr-dev")
set(CPACK_COMPONENT_PGDR_STATIC_DESCRIPTION "Delaunay meshes with guaranteed quality: the C++ library
 Headers and a static library for find_package(pgdr CONFIG) and pkg-config.")

if(PGDR_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL pgdr_python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PGDR_PYTHON_PACKAGE_NAME python3-pgdr)
  set(CPACK_DEBIAN_PGDR_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PGDR_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PGDR_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_COMPONENT_PGDR_PYTHON_DESCRIPTION "Delaunay meshes with guaranteed quality: the Python module
 Arrays of numpy in and out.")
endif()
include(CPack)
