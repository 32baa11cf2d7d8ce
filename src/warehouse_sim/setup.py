# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=["warehouse_sim"], package_dir={"": "src"}))
