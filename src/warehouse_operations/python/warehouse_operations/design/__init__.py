# SPDX-License-Identifier: Apache-2.0
"""Searches layouts for a building and a demand: the program `design`, and the page /whatif.

task has the arguments, plans turns parameters into a layout file within the building, candidate
judges one by shifts of ideal robots, search asks Optuna (found by packages) for the next parameters
stage by stage, page writes what was found.
"""
