# Everything runs in .venv, which the first target to need it makes; no other step is needed.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
SET_UP := pyproject.toml constraints.txt scripts/set-up.sh

.PHONY: demo test lint format pins clean

demo: $(VENV)/.default  ## map the bundled simulated home and print what was found
	$(BIN)/afkb demo --out demo-map

test: $(VENV)/.dev  ## run every test
	$(BIN)/pytest -n 2 --dist loadgroup

lint: $(VENV)/.dev  ## style, formatting and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(VENV)/.dev  ## mend what the formatter can mend
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

pins: $(VENV)/.dev  ## write what is installed as the versions to test with
	scripts/pin.sh $(BIN)/python

clean:  ## remove the environment and what the targets made
	rm -rf $(VENV) demo-map

$(VENV)/.default: $(SET_UP)
	scripts/set-up.sh $(PYTHON) $(VENV) .
	touch $@

$(VENV)/.dev: $(SET_UP)
	scripts/set-up.sh $(PYTHON) $(VENV) '.[dev]'
	touch $@ $(VENV)/.default
