# SPDX-License-Identifier: Apache-2.0

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
    ${folder}/*.py ${folder}/*.pyi ${folder}/py.typed)
  foreach(file ${files})
    cmake_path(GET file PARENT_PATH parent)
    file(MAKE_DIRECTORY ${package}/${parent})
    file(CREATE_LINK ${folder}/${file} ${package}/${file} SYMBOLIC)
    install(FILES ${folder}/${file} DESTINATION ${PYTHON_INSTALL_DIR}/${PROJECT_NAME}/${parent})
  endforeach()
endfunction()
