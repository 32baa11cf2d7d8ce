# SPDX-License-Identifier: Apache-2.0
# What a person types. Each target is one line; what needs more is in scripts/.
SHELL := /bin/bash
.SHELLFLAGS := -ec
.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help configured dev run serve demo operate vda5050 test test-long test-api test-vda5050 test-sanitizers test-install test-wheel test-debian deb test-deb build build-tests packages deps usable bench docs docs-test wheel lint tidy format install clean

# Debian's ROS runs on Debian's tools: neither pyenv nor another workspace may come between.
export PATH := /usr/sbin:/usr/bin:/sbin:/bin
unexport PYTHONPATH PYTHONHOME VIRTUAL_ENV CMAKE_PREFIX_PATH ROS_PACKAGE_PATH MAKEFLAGS MAKELEVEL

JOBS ?= $(shell nproc)
PREFIX ?= install
SEEDS ?= 20
BUILD = cmake --build build -j$(JOBS)
# If make is killed, what it started still ends. roslaunch asks for distutils, in whose place it would
# get all of setuptools, half of its time to start.
DEVEL := . devel/setup.bash; export SETUPTOOLS_USE_DISTUTILS=stdlib; exec setpriv --pdeathsig TERM

help:  ## list the targets
	@sed -nE 's/^([a-z-]+):[^#]*## (.*)/  make \1\t\2/p' Makefile | expand -t 26

run: build  ## start the warehouse; make run ARGS="size:=medium rviz:=true"
	@$(DEVEL) roslaunch --sigint-timeout=3 --sigterm-timeout=1 warehouse_sim warehouse.launch $(ARGS)

serve: build  ## launch warehouses from a web page: http://localhost:8080; make serve ARGS="--port 8090"
	@scripts/assistant && export WAREHOUSE_ASSISTANT=$$PWD/.venv/assistant/bin/python || \
	echo "The hub starts without its assistant: /mcp answers 503." >&2; \
	$(DEVEL) rosrun warehouse_sim hub $(ARGS)

demo: build  ## watch robots fetch storage units, meet head on, recover; and a fleet deliver
	@. devel/setup.bash; export SETUPTOOLS_USE_DISTUTILS=stdlib ROS_MASTER_URI=http://localhost:$$((20000 + $$$$ % 10000)); \
	roslaunch --sigint-timeout=3 --sigterm-timeout=1 warehouse_sim warehouse.launch rtf:=5 $(ARGS) >/dev/null & \
	trap "kill $$!; wait" EXIT; rosrun warehouse_sim demo

operate: build  ## a warehouse at work: orders, stations, stock; make operate ARGS="size:=large"
	@echo "watch it: http://localhost:8080 and http://localhost:8080/operations   its figures: rostopic echo /warehouse/kpis"
	@$(DEVEL) roslaunch --sigint-timeout=5 --sigterm-timeout=1 warehouse_sim operations.launch $(ARGS)

vda5050: build  ## a broker, robots as vehicles, and masters that let one fetch a unit (VDA 5050)
	@scripts/vda5050 $(ARGS)

# Lint, and packages of PyPI, come while configuring and compiling leave a core idle. Without the packages
# their tests are skipped, and say so.
test: deps  ## build and run every test but the long ones; make test ARGS="-L unit" only those
	@scripts/beside "$(MAKE) build-tests JOBS=$(JOBS)" "scripts/lint && { scripts/learning_packages || true; scripts/axe || true; scripts/assistant tests || true; }"
	@scripts/test -j$$((2 * $(JOBS))) $(or $(ARGS),-LE long)

test-long: build-tests  ## fleets at work, seed after seed, with and without faults, and all pages; hours. make test-long SEEDS=2
	@export SOAK_SEEDS=$(SEEDS) FAULT_SEEDS=$(SEEDS) INSTANCE_SEEDS=$(SEEDS) KILLS=$(SEEDS); . devel/setup.bash; cd tests; \
	/usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/fleet/test_soak.py unit/python/fleet/test_faults.py unit/python/operations/runs/test_rawsim.py unit/python/operations/store/test_kills.py $(ARGS); \
	OVERLAPS=2000 ../devel/lib/warehouse_tests/overlap_test --gtest_brief=1; \
	OBSTACLES=all /usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/fleet/test_obstacles.py; \
	VDA5050_HISTORIES=10000 /usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/vda5050/test_histories.py unit/python/vda5050/test_both_sides.py unit/python/vda5050/test_jumps.py; \
	MUTANTS=all /usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/vda5050/conform/test_mutants.py unit/python/vda5050/conform/test_zone_mutants.py unit/python/vda5050/conform/test_master_mutants.py unit/python/vda5050/conform/test_master_zone_mutants.py; \
	LAYOUTS=$${LAYOUTS:-200} /usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/operations/runs/test_random_layouts.py; \
	(cd ..; JUMP_MINUTES=10 BURST=all scripts/test -j$$((2 * $(JOBS))) -L long); \
	MUTATIONS=2000 /usr/bin/python3 -m pytest -q -p no:cacheprovider unit/python/operations/runs/test_mutations.py; \
	../scripts/learning_packages; RWARE_STEPS=$${RWARE_STEPS:-50000} RWARE_IDS=all ../.venv/bin/python -m pytest -q -p no:cacheprovider learning/test_rware.py -k "registered or checkers"; \
	../bench/hub/cycle_bench --count $${CYCLES:-500}; ../scripts/assistant tests; ../bench/hub/assistant_bench; \
	../scripts/deps docs; ../scripts/docs; \
	../scripts/axe; ../scripts/pages/screens; ../scripts/docs_links; ../scripts/docs_examples; \
	FAILURE_MINUTES=60 CHARGING_MINUTES=60 CROSSINGS=1000 exec /usr/bin/python3 -m pytest -q -s -m "" -p no:cacheprovider unit/python/fleet/test_failures.py unit/python/fleet/test_charging.py unit/python/fleet/test_people.py

test-wheel: wheel  ## use the wheels in environments with nothing else, with both numpys, Stable-Baselines3 and Ray
	@scripts/package/test-wheel $(ARGS)

test-api: build  ## let schemathesis look for wrong answers of the HTTP API
	@scripts/peers/fuzz_api $(ARGS)

test-vda5050: build  ## masters of other makers drive robots over VDA 5050, and ours their vehicles; from PyPI and npm
	@scripts/peers/test-vda5050 $(ARGS)
	@scripts/peers/test-lif

test-sanitizers: deps  ## feed damaged worlds to a build with sanitizers; half an hour
	@scripts/test-sanitizers

test-debian:  ## every test on a bare Debian of another release; make test-debian RELEASE=trixie
	@scripts/package/test-debian $(or $(RELEASE),trixie)

deb:  ## Debian packages for this release, into dist/deb/
	@scripts/package/deb $(RELEASE)

test-deb: deb  ## install the packages on a bare Debian and use them
	@scripts/package/test-deb $(RELEASE)

test-install: build  ## install into a folder of its own, and use it from there
	@scripts/package/test-install

# catkin looks after each message in every build; where no source is newer than the last one that would be all. Python
# that is imported touches its folder.
build: configured  ## compile everything but the tests
	@[ build/.built -nt build/CMakeCache.txt ] && [ -z "$$(find CMakeLists.txt src -newer build/.built -not -path '*/__pycache__*' -not -exec test -e '{}/__pycache__' \; -print -quit)" ] || \
	{ touch build/.begun; $(BUILD); mv build/.begun build/.built; }

build-tests: configured  # all of it in one go: what the tests need fills the gaps of the rest
	@touch build/.begun; $(BUILD) --target all tests; mv build/.begun build/.built

dev: packages  ## the same for work on the C++: a change in one file is compiled in seconds
	@grep -qs '^CMAKE_UNITY_BUILD:BOOL=OFF' build/CMakeCache.txt || scripts/configure dev
	@$(BUILD)

configured: packages
	@[ -e build/build.ninja -o -e build/Makefile ] || scripts/configure

# rosrun and rostest of ROS itself take a path with a space for two.
usable:
	@case $$PWD in *[[:space:]]*) echo "$$PWD has a space in its path, where ROS can't run programs: clone it elsewhere" >&2; exit 1 ;; esac
	@for folder in "$$PWD" "$$PWD/build"; do [ ! -e "$$folder" ] || [ -w "$$folder" ] || { \
	echo "$$folder can't be written to, where a build lies: build in a clone or copy of your own" >&2; exit 1; }; done

packages: usable  # without those that only tests and lint need
	@scripts/deps run

deps: usable  ## install the Debian packages that are missing
	@scripts/deps

docs: build  ## build the documentation into build/docs; a running viewer serves it at /docs/
	@scripts/deps docs
	@$(DEVEL) scripts/docs $(ARGS)

docs-test: docs  ## run the examples of the documentation, and ask what its links to other places answer
	@scripts/learning_packages || true
	@scripts/docs_links
	@$(DEVEL) scripts/docs_examples $(ARGS)

bench: build  ## run the benchmarks
	@$(DEVEL) bench/run $(ARGS)

wheel: build  ## the world and its environments for Python 3.11, 3.12 and 3.13 without ROS, into dist/; make wheel PYTHONS=python3 for one
	@JOBS=$(JOBS) scripts/package/wheel

lint: deps  ## check format and style
	@scripts/lint

tidy: build  ## look for mistakes in the C++ by clang-tidy; some minutes
	@scripts/tidy $(ARGS)

format: deps  ## repair format and style
	@scripts/lint --fix

install: build  ## install into PREFIX (./install)
	@cmake --install build --prefix $(PREFIX)

clean:  ## remove what was built
	@rm -rf build devel
