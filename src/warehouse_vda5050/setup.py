# SPDX-License-Identifier: Apache-2.0
"""Read by catkin_python_setup; not meant to be run."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

schemas = ["*/*.json", "*/LICENSE"]
contents = {
    "packages": find_packages("python"),
    "package_data": {"": ["py.typed"], "warehouse_vda5050.schemas": schemas},
}
setup(**generate_distutils_setup(package_dir={"": "python"}, **contents))
