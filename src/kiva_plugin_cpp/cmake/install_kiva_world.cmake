# SPDX-License-Identifier: Apache-2.0
# The libraries of the world, the layout and the planner, for programs without ROS: the CMake package
# kiva_world with the targets kiva::kiva_core, kiva::kiva_world_file and so on, and kiva-world.pc.

set(cmake_folder ${CATKIN_GLOBAL_LIB_DESTINATION}/cmake/kiva_world)
install(EXPORT kiva_world NAMESPACE kiva:: FILE kiva_world-targets.cmake DESTINATION ${cmake_folder})
install(FILES cmake/kiva_world-config.cmake DESTINATION ${cmake_folder})

include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/kiva_world-config-version.cmake
  VERSION ${kiva_plugin_cpp_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiva_world-config-version.cmake
  DESTINATION ${cmake_folder})

configure_file(cmake/kiva-world.pc.in ${CMAKE_CURRENT_BINARY_DIR}/kiva-world.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/kiva-world.pc
  DESTINATION ${CATKIN_GLOBAL_LIB_DESTINATION}/pkgconfig)
