# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

contents = {"packages": find_packages("python"), "package_data": {"": ["py.typed"]}}
setup(**generate_distutils_setup(package_dir={"": "python"}, **contents))
