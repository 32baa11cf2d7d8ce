# SPDX-License-Identifier: Apache-2.0

# Installs a library of the C++ API, whose headers lie in include/, for programs with and without ROS:
# the latter find it by the CMake package kiva_world. Its interface may change with each minor
# version, so that is in its name.
function(install_library target)
  set(version ${${PROJECT_NAME}_VERSION})
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" minor "${version}")
  set_target_properties(${target} PROPERTIES VERSION ${version} SOVERSION ${minor}
    INSTALL_RPATH "$ORIGIN")  # where they lie all, whatever was sourced
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CATKIN_GLOBAL_INCLUDE_DESTINATION}>)
  install(TARGETS ${target} EXPORT kiva_world DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# Builds the Python package of this catkin package: the files of python/<package>, and beside them
# the module _core, made of SOURCES and linked with LIBRARIES. In the devel space the files are links,
# so that a change needs no build.
function(add_python_package)
  cmake_parse_arguments(PARSE_ARGV 0 core "" "" "SOURCES;LIBRARIES;INCLUDES")
  set(Python_EXECUTABLE ${PYTHON_EXECUTABLE})
  find_package(Python REQUIRED COMPONENTS Interpreter Development.Module)
  find_package(pybind11 REQUIRED)
  set(package ${CATKIN_DEVEL_PREFIX}/${PYTHON_INSTALL_DIR}/${PROJECT_NAME})
  set(module ${PROJECT_NAME}_python)
  pybind11_add_module(${module} NO_EXTRAS ${core_SOURCES})
  target_compile_features(${module} PRIVATE cxx_std_17)
  target_include_directories(${module} PRIVATE src ${core_INCLUDES})
  target_link_libraries(${module} PRIVATE ${core_LIBRARIES})
  # Installed, it finds its libraries from where it lies itself, whatever was sourced.
  set_target_properties(${module} PROPERTIES OUTPUT_NAME _core
    LIBRARY_OUTPUT_DIRECTORY ${package} INSTALL_RPATH "$ORIGIN/../../..")
  install(TARGETS ${module} LIBRARY DESTINATION ${PYTHON_INSTALL_DIR}/${PROJECT_NAME})

  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/python/${PROJECT_NAME})
  file(GLOB_RECURSE files RELATIVE ${folder} CONFIGURE_DEPENDS
    ${folder}/*.py ${folder}/*.pyi ${folder}/*.npz ${folder}/py.typed)
  foreach(file ${files})
    cmake_path(GET file PARENT_PATH parent)
    file(MAKE_DIRECTORY ${package}/${parent})
    file(CREATE_LINK ${folder}/${file} ${package}/${file} SYMBOLIC)
    install(FILES ${folder}/${file} DESTINATION ${PYTHON_INSTALL_DIR}/${PROJECT_NAME}/${parent})
  endforeach()
endfunction()
