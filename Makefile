# Each target sets up .venv by itself from the lock files in requirements/, once; after that nothing here needs the network.
# Assumed: Python 3.11 or newer with venv, make, git.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check
CORE   := $(VENV)/core.stamp
STUDIO := $(VENV)/studio.stamp
DEV    := $(VENV)/dev.stamp

.DEFAULT_GOAL := help
.PHONY: help demo studio test lint format docs figures bench lock clean

help:
	@echo "make demo    from a measurement to a shaper and its report, in demo-report/"
	@echo "make studio  the same on a page in your browser, to look at and to change"
	@echo "make test    the tests          make lint   style, types, rooms of the house"
	@echo "make docs    the documentation  make bench  the benchmarks (make figures: the theory page's)"
	@echo "make lock    renew the lock files (needs uv)"

demo: $(CORE)
	$(BIN)/preshape calibrate examples/data/gantry_x.csv --out demo-report
	@echo "See it, and change it: make studio (sets itself up), or $(BIN)/preshape studio demo-report/shaper.json where it is set up"

studio: $(STUDIO)
	@test -e demo-report/shaper.json || $(MAKE) --no-print-directory demo
	$(BIN)/preshape studio demo-report/shaper.json

test: $(DEV)
	$(BIN)/python -m pytest $(ARGS)

lint: $(DEV)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(DEV)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

docs: $(DEV)
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build/html
	@echo "docs/_build/html/index.html"

figures: $(DEV)
	$(BIN)/python docs/figures/make_figures.py
	$(BIN)/python docs/figures/make_animation.py
	$(BIN)/python docs/figures/make_numbers.py
	$(BIN)/python docs/figures/make_screenshots.py

bench: $(DEV)
	$(BIN)/python benchmarks/run_all.py

lock:
	uv pip compile -q --universal --python-version 3.11 --generate-hashes --no-header --group dev pyproject.toml -o requirements/dev.txt
	uv pip compile -q --universal --python-version 3.11 --generate-hashes --no-header --group build -c requirements/dev.txt pyproject.toml -o requirements/core.txt
	uv pip compile -q --universal --python-version 3.11 --generate-hashes --no-header --group build --extra studio --extra pdf -c requirements/dev.txt pyproject.toml -o requirements/studio.txt

clean:
	rm -rf $(VENV) demo-report docs/_build

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "preshape needs Python 3.11 or newer; '$(PYTHON)' is $$($(PYTHON) --version 2>&1). Say: make PYTHON=python3.12 ..."; exit 2; }
	@echo "== setting up $(VENV) with $$($(PYTHON) --version)"
	$(PYTHON) -m venv $(VENV)

$(VENV)/requirements.stamp: $(VENV)/bin/python requirements/core.txt
	@echo "== installing what preshape needs (locked in requirements/core.txt; about a minute the first time)"
	$(PIP) install --require-hashes -r requirements/core.txt
	@touch $@

$(CORE): $(VENV)/requirements.stamp pyproject.toml $(wildcard src/preshape/kernel/c/*)
	$(PIP) install --quiet --no-deps --no-build-isolation --no-index --editable .
	@touch $@

$(STUDIO): $(VENV)/requirements.stamp requirements/studio.txt $(CORE)
	@echo "== installing what the studio needs (locked in requirements/studio.txt)"
	$(PIP) install --require-hashes -r requirements/studio.txt
	@touch $@

$(VENV)/dev-requirements.stamp: $(VENV)/requirements.stamp requirements/dev.txt
	@echo "== installing what tests, lint and documentation need (locked in requirements/dev.txt)"
	$(PIP) install --require-hashes -r requirements/dev.txt
	@touch $@

$(DEV): $(VENV)/dev-requirements.stamp $(CORE)
	@touch $@
