# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# Everything comes from the system (two TBBs in one process are worse than none), and each dependency enters the one
# target that needs it. CGAL's own target is not used: it adds -frounding-math to whatever links it. Its headers, GMP
# and MPFR are enough for the exact number types.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL 5.5 REQUIRED)
find_package(TBB 2021 REQUIRED)
find_package(Threads REQUIRED)

# GMP and MPFR as imported targets, which an installed pgdr makes again on its user's machine: no absolute path is
# exported.
include(${CMAKE_CURRENT_LIST_DIR}/pgdr_numbers.cmake)
if(NOT pgdr_numbers_FOUND)
  message(FATAL_ERROR "GMP or MPFR not found (Debian: libgmp-dev, libmpfr-dev)")
endif()
set(GMP_LIBRARIES pgdr::gmp)
set(MPFR_LIBRARIES pgdr::mpfr)

if(PGDR_TOOLS)
  find_package(CLI11 2.1 REQUIRED)
  find_package(nlohmann_json 3.11 REQUIRED)
  find_package(muparser 2.3 REQUIRED)
  find_package(PkgConfig)  # without Cairo, `pgdr view` writes no .png
  if(PkgConfig_FOUND AND PGDR_PICTURES)
    pkg_check_modules(cairo IMPORTED_TARGET cairo-png>=1.16)
  endif()
endif()
