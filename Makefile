# RoTRA.  `make verify` proves, `make test` tests; both first set up what they need, and do nothing twice.
# What is built lies in .venv/, .build/ and the modules' target/ folders; only stamps in .build/ decide what is stale.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help
MAKEFLAGS += --no-builtin-rules

PYTHON ?= python3
VENV := .venv/bin
TOOLCHAIN := translator/rotra/toolchain
export PYTHON
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# A stamp whose thing is gone (.venv removed, `mvn clean`, an emptied Maven repository) is no stamp.
$(shell $(TOOLCHAIN)/stale.sh)

.PHONY: help setup verify crosscheck test check bench clean distclean packages testtools jvm nusmv python

help: ## say what there is
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' Makefile | expand -t 18

setup: packages python nusmv jvm ## install and build all that is needed
	@:

verify: setup ## prove every property of every driver in every scenario
	@echo "==> rotra verify"
	@$(VENV)/rotra verify

crosscheck: setup ## the running system and the model, state by state, in every widest instance
	@echo "==> rotra crosscheck"
	@for scenario in traffic_light overtake right_turn; do for agent in reactive must_only proactive; do \
	  $(VENV)/rotra crosscheck --agent $$agent --scenario $$scenario --instance all; done; done

test: setup testtools ## every test, Java and Python
	@echo "==> Java tests"
	@$(TOOLCHAIN)/maven.sh .build/maven-test.stamp test
	@echo "==> Python tests"
	@$(VENV)/python -m pytest

check: setup ## format, types, then every test
	@echo "==> ruff"
	@$(VENV)/ruff check translator tests
	@echo "==> mypy"
	@$(VENV)/mypy
	@$(MAKE) --no-print-directory test

bench: setup ## measure, and keep the figures
	@$(VENV)/python -m pytest -q -s -m bench tests/bench

clean: ## remove what was built, but not the environment and NuSMV
	@rm -rf .build/*.stamp .build/*.files .build/*.log model/java/target agents/java/target
	@rm -rf .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find translator tests -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean ## remove all of it; the next `make` starts from nothing but the user's cache
	@rm -rf .venv .build translator/*.egg-info

# --- what the machine must have ---------------------------------------------------------------------------------------
packages:
	@$(TOOLCHAIN)/packages.sh

# A test whose tool cannot be had is skipped, and says so.
testtools:
	@$(TOOLCHAIN)/packages.sh tests || true

# --- Python: the environment is made anew where the folder it lies in has changed, as its programs name their place ----
python: packages .build/python.stamp

.build/where.files: FORCE
	@mkdir -p .build
	@pwd | cmp -s - $@ || pwd > $@

.build/venv.stamp: .build/where.files
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed, this is " + sys.version)'
	@$(PYTHON) -m venv --clear .venv
	@touch $@

.build/python.stamp: requirements.txt pyproject.toml .build/venv.stamp
	@echo "==> Python environment"
	@$(VENV)/python -m pip install --quiet -r requirements.txt
	@$(VENV)/python -m pip install --quiet --no-deps --editable .
	@touch $@

# --- NuSMV: from source, kept in the user's cache ---------------------------------------------------------------------
nusmv: packages python .build/nusmv.stamp

.build/nusmv.stamp: $(TOOLCHAIN)/nusmv.py .build/python.stamp
	@echo "==> NuSMV"
	@$(VENV)/python -m rotra.toolchain.nusmv .build/nusmv
	@touch $@

# --- Java: built again when a source is newer, new or gone ------------------------------------------------------------
jvm: packages .build/jvm.stamp

JAVA_SOURCES := pom.xml $(shell find model/java agents/java \( -name target -o -path '*/src/test' \) -prune -o -type f \( -name '*.java' -o -name pom.xml -o -path '*/src/main/resources/*' \) -print 2>/dev/null | LC_ALL=C sort)

.build/java.files: FORCE
	@mkdir -p .build
	@printf '%s\n' $(JAVA_SOURCES) | cmp -s - $@ || printf '%s\n' $(JAVA_SOURCES) > $@

.build/jvm.stamp: $(JAVA_SOURCES) .build/java.files .build/where.files
	@echo "==> Java side"
	@$(TOOLCHAIN)/maven.sh .build/maven-package.stamp -q package -Dmaven.test.skip=true
	@test -s agents/java/target/classpath.txt
	@touch $@

FORCE:
