# SPDX-License-Identifier: Apache-2.0
# find_package(kiva_world) and target_link_libraries(PROGRAM kiva::kiva_core kiva::kiva_world_file).
include(CMakeFindDependencyMacro)
find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::bullet)
  pkg_check_modules(bullet REQUIRED QUIET IMPORTED_TARGET bullet-float64)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/kiva_world-targets.cmake)
