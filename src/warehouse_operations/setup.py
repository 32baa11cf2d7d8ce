# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

names = (
    "warehouse_operations",
    "warehouse_operations.document",
    "warehouse_operations.policies",
    "warehouse_operations.sizing",
)
setup(**generate_distutils_setup(packages=list(names), package_dir={"": "python"}))
