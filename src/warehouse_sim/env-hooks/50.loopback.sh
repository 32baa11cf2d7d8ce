# SPDX-License-Identifier: Apache-2.0
# Every client of a ROS master or a node may do anything there, so both listen to this machine alone.
# Set ROS_HOSTNAME or ROS_IP to the name or address under which other machines shall reach them.
if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ]; then
  case "${ROS_MASTER_URI:-http://localhost}" in
    http://localhost | http://localhost[:/]* | http://127.*) export ROS_HOSTNAME=localhost ;;
  esac
fi
