# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# What every target of the project has in common: C++20, no contraction of a*b+c (the predicates and the
# reproducibility of the mesh rest on it), and a compile error for any GPL header of CGAL.
include(GNUInstallDirs)

set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

function(pgdr_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_definitions(${target} PRIVATE CGAL_LICENSE_ERROR)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wno-missing-field-initializers)
  if(PGDR_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(PGDR_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  if(PGDR_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${PGDR_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${PGDR_SANITIZE})
  endif()
endfunction()

# A layer: a static library, for what is built here, that exposes its own folder alone, and links downwards alone.
# pgdr_layer(<name> HEADERS <public headers...> SOURCES <files...> [ALONE <files...>] LINKS <lower layers...>)
# All other headers are private to the room, the folder, that they lie in (tools/check_sources.py has the rooms).
# ALONE: sources, too, that share a class template, or names of their own, with others: one by one in a unity build.
function(pgdr_layer name)
  cmake_parse_arguments(arg "" "" "HEADERS;SOURCES;ALONE;LINKS" ${ARGN})
  add_library(pgdr_${name} STATIC ${arg_SOURCES} ${arg_ALONE})
  set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_library(pgdr::${name} ALIAS pgdr_${name})
  pgdr_settings(pgdr_${name})
  # What a shared library exports is still inlined and called directly within it.
  target_compile_options(pgdr_${name} PRIVATE -fno-semantic-interposition)
  set_target_properties(pgdr_${name} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  target_sources(pgdr_${name} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR} FILES ${arg_HEADERS})
  if(CMAKE_VERIFY_INTERFACE_HEADER_SETS)  # private headers, too, are compiled alone then
    file(GLOB_RECURSE private CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp)
    list(FILTER private EXCLUDE REGEX "${name}/pgdr/")
    target_sources(pgdr_${name} PUBLIC FILE_SET rooms TYPE HEADERS BASE_DIRS ${CMAKE_CURRENT_SOURCE_DIR} FILES ${private})
  endif()
  target_include_directories(pgdr_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(pgdr_${name} PUBLIC ${arg_LINKS})
  set_property(GLOBAL APPEND PROPERTY PGDR_LAYERS pgdr_${name})
  list(TRANSFORM arg_HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY PGDR_HEADERS ${arg_HEADERS})
endfunction()
