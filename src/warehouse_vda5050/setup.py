# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

names = ("", ".codec", ".master", ".mqtt", ".ros", ".validation", ".vehicle")
packages = [f"warehouse_vda5050{name}" for name in names]
setup(**generate_distutils_setup(packages=packages, package_dir={"": "python"}))
