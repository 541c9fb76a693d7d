# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# pgdr::gmp and pgdr::mpfr, and pgdr_numbers_FOUND. Used by the build and, installed, by pgdrConfig.cmake.
set(pgdr_numbers_FOUND TRUE)
foreach(name IN ITEMS gmp mpfr)
  string(TOUPPER ${name} NAME)
  find_path(${NAME}_INCLUDE_DIR ${name}.h)
  find_library(${NAME}_LIBRARY ${name})
  mark_as_advanced(${NAME}_INCLUDE_DIR ${NAME}_LIBRARY)
  if(NOT ${NAME}_LIBRARY)
    set(pgdr_numbers_FOUND FALSE)
  elseif(NOT TARGET pgdr::${name})
    add_library(pgdr::${name} UNKNOWN IMPORTED)
    set_target_properties(pgdr::${name} PROPERTIES IMPORTED_LOCATION "${${NAME}_LIBRARY}")
  endif()
endforeach()
if(TARGET pgdr::mpfr AND TARGET pgdr::gmp)
  set_target_properties(pgdr::mpfr PROPERTIES INTERFACE_LINK_LIBRARIES pgdr::gmp)
endif()
