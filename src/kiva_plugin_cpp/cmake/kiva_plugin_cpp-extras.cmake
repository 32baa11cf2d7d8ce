# SPDX-License-Identifier: Apache-2.0
# Finds what the public headers include, for all packages that find this one.
find_package(ignition-math6 REQUIRED)
find_package(ignition-plugin1 REQUIRED COMPONENTS loader register)
list(APPEND kiva_plugin_cpp_LIBRARIES
  ignition-math6::ignition-math6 ignition-plugin1::loader ignition-plugin1::register)
