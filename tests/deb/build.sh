# SPDX-License-Identifier: Apache-2.0
# Builds and runs a program that uses the world's library without ROS: by CMake, then by pkg-config.
worlds=/usr/share/warehouse_layout/worlds
source=$(dirname "$0")/consumer
! command -v roscore || { echo "ROS is here: this would prove nothing"; exit 1; }
cmake -S "$source/without_ros" -B /tmp/build >/tmp/log && cmake --build /tmp/build >>/tmp/log || { cat /tmp/log; exit 1; }
g++ -std=c++17 "$source/main.cpp" $(pkg-config --cflags --libs kiva-world) -o /tmp/build/by_pkg_config
for program in consumer by_pkg_config; do
  [ "$("/tmp/build/$program" $worlds/paper.sdf $worlds/models)" = 1.000 ]
done
