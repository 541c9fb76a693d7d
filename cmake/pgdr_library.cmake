# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# libpgdr: the objects of all layers in one library. pgdr_static and pgdr_shared are made of the same objects; pgdr::pgdr
# is the one that BUILD_SHARED_LIBS asks for. The other is built for the tests of the package alone.
get_property(layers GLOBAL PROPERTY PGDR_LAYERS)
get_property(headers GLOBAL PROPERTY PGDR_HEADERS)

set(pgdr_kind static)
if(BUILD_SHARED_LIBS)
  set(pgdr_kind shared)
endif()

foreach(kind IN ITEMS static shared)
  string(TOUPPER ${kind} KIND)
  set(library pgdr_${kind})
  add_library(${library} ${KIND})
  foreach(layer IN LISTS layers)
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:${layer}>)
  endforeach()
  pgdr_settings(${library})
  target_sources(${library} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/geometry ${PROJECT_SOURCE_DIR}/core ${PROJECT_SOURCE_DIR}/scheduler
    FILES ${headers})
  target_link_libraries(${library} PRIVATE TBB::tbb ${GMP_LIBRARIES} ${MPFR_LIBRARIES})
  set_target_properties(${library} PROPERTIES OUTPUT_NAME pgdr EXPORT_NAME pgdr LINKER_LANGUAGE CXX
    VERIFY_INTERFACE_HEADER_SETS OFF  # the layers' are
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(NOT kind STREQUAL pgdr_kind AND NOT PGDR_TESTS)
    set_target_properties(${library} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
endforeach()
add_library(pgdr::pgdr ALIAS pgdr_${pgdr_kind})

# Templates of other libraries that were instantiated here are nobody's business.
set(version_script ${CMAKE_CURRENT_LIST_DIR}/pgdr.map)
target_link_options(pgdr_shared PRIVATE -Wl,--version-script=${version_script})
set_target_properties(pgdr_shared PROPERTIES LINK_DEPENDS ${version_script})
if(NOT PGDR_SANITIZE)
  target_link_options(pgdr_shared PRIVATE -Wl,--no-undefined)
endif()
