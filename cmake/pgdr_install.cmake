# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Installs headers, static libraries, the command, and the package files for find_package(pgdr CONFIG).
include(CMakePackageConfigHelpers)

get_property(layers GLOBAL PROPERTY PGDR_LAYERS)
set(PGDR_NEEDS_TBB FALSE)
foreach(layer IN LISTS layers)
  get_target_property(links ${layer} LINK_LIBRARIES)
  if("${links}" MATCHES "TBB::")
    set(PGDR_NEEDS_TBB TRUE)
  endif()
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pgdr)
install(TARGETS ${layers} pgdr_all EXPORT pgdr
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT pgdr NAMESPACE pgdr:: FILE pgdrTargets.cmake DESTINATION ${package_dir})
if(PGDR_TOOLS)
  install(TARGETS pgdr_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pgdrConfig.cmake.in ${PROJECT_BINARY_DIR}/pgdrConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pgdrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pgdrConfig.cmake ${PROJECT_BINARY_DIR}/pgdrConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/pgdr_numbers.cmake DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
