# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

parts = ["", ".api", ".api.routes", ".api.schemas", ".drawing", ".editor", ".page", ".replay"]
parts += [".ros", ".rviz", ".server", ".watch", ".whatif"]
packages = [f"warehouse_viewer{part}" for part in parts]
setup(**generate_distutils_setup(packages=packages, package_dir={"": "python"}))
