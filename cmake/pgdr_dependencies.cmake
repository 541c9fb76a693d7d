# SPDX-License-Identifier: Apache-2.0
# Everything comes from the system (two TBBs in one process are worse than none), and each dependency enters the one
# target that needs it. CGAL's own target is not used: it adds -frounding-math to whatever links it. Its headers, GMP
# and MPFR are enough for the exact number types.
find_package(CGAL 5.5 REQUIRED)
find_package(GMP REQUIRED)
find_package(MPFR REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB 2021 REQUIRED)
find_package(Threads REQUIRED)
