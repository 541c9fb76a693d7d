# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Installs headers, the library, the command, and the package files for find_package(pgdr CONFIG) and pkg-config. The kind
# of library that BUILD_SHARED_LIBS did not ask for is installed by its component alone: cmake --install BUILD --component
# pgdr_shared (pgdr_static), headers and package files included.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pgdr)
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH PC_PREFIX /prefix/${pc_dir} /prefix)  # where the prefix is, seen from the .pc file

foreach(kind IN ITEMS static shared)
  set(where COMPONENT pgdr_${kind})
  if(NOT kind STREQUAL pgdr_kind)
    list(APPEND where EXCLUDE_FROM_ALL)
  endif()
  # A static library leaves its own libraries to the programs that link it.
  set(PGDR_IS_STATIC FALSE)
  set(PC_STATIC_LIBS "")
  if(kind STREQUAL static)
    set(PGDR_IS_STATIC TRUE)
    set(PC_STATIC_LIBS " -ltbb -lmpfr -lgmp")
  endif()
  install(TARGETS pgdr_${kind} EXPORT pgdr_${kind}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${where}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${where} NAMELINK_COMPONENT pgdr_${kind}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${where})
  install(EXPORT pgdr_${kind} NAMESPACE pgdr:: FILE pgdrTargets_${kind}.cmake DESTINATION ${package_dir} ${where})
  if(PGDR_MPI)
    install(TARGETS pgdr_mpi_${kind} EXPORT pgdr_mpi_${kind}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${where}
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${where} NAMELINK_COMPONENT pgdr_${kind}
      FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${where})
    install(EXPORT pgdr_mpi_${kind} NAMESPACE pgdr:: FILE pgdrMpiTargets_${kind}.cmake DESTINATION ${package_dir} ${where})
  endif()
  set(made ${PROJECT_BINARY_DIR}/package/${kind})
  configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pgdrConfig.cmake.in ${made}/pgdrConfig.cmake
    INSTALL_DESTINATION ${package_dir})
  write_basic_package_version_file(${made}/pgdrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/pgdr.pc.in ${made}/pgdr.pc @ONLY)
  install(FILES ${made}/pgdrConfig.cmake ${made}/pgdrConfigVersion.cmake ${CMAKE_CURRENT_LIST_DIR}/pgdr_numbers.cmake
    DESTINATION ${package_dir} ${where})
  install(FILES ${made}/pgdr.pc DESTINATION ${pc_dir} ${where})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libpgdr ${where})
endforeach()
if(PGDR_TOOLS)
  install(TARGETS pgdr_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT pgdr_command)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT pgdr_command)
  # The man page and completions, which the command is asked for; not where it cannot run, or there is no Python.
  find_package(Python3 QUIET COMPONENTS Interpreter)
  if(Python3_Interpreter_FOUND AND NOT CMAKE_CROSSCOMPILING)
    set(pages ${PROJECT_BINARY_DIR}/help)
    add_custom_command(OUTPUT ${pages}/pgdr.1 ${pages}/pgdr.bash ${pages}/_pgdr ${pages}/pgdr.fish
      COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tools/help_pages.py $<TARGET_FILE:pgdr_command> ${pages}
      DEPENDS pgdr_command ${PROJECT_SOURCE_DIR}/tools/help_pages.py VERBATIM)
    add_custom_target(pgdr_help ALL DEPENDS ${pages}/pgdr.1)
    set(share COMPONENT pgdr_command OPTIONAL)
    install(FILES ${pages}/pgdr.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 ${share})
    install(FILES ${pages}/pgdr.bash DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions RENAME pgdr ${share})
    install(FILES ${pages}/_pgdr DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions ${share})
    install(FILES ${pages}/pgdr.fish DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d ${share})
  endif()
  if(PGDR_MPI)
    install(TARGETS pgdr_mpi_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endif()
if(PROJECT_IS_TOP_LEVEL)
  include(pgdr_packages)
endif()
