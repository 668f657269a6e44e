# Everything runs in .venv, which the first target to need it makes; no other step is needed.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
SET_UP := pyproject.toml constraints.txt scripts/set-up.sh scripts/apt.sh

.PHONY: demo test lint gates format pictures site pins clean

demo: $(VENV)/.default  ## map the bundled simulated home and print what was found
	$(BIN)/afkb demo --out demo-map

test: $(VENV)/.dev  ## run every test
	$(BIN)/pytest -n 2 --dist loadgroup --no-loadscope-reorder

lint: $(VENV)/.dev  ## style, formatting and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

gates: $(VENV)/.dev  ## check the ontology by shapes, pitfalls, reasoner (Java) and questions
	$(BIN)/afkb ontology check --require-reasoner

format: $(VENV)/.dev  ## mend what the formatter can mend
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

pictures: $(VENV)/.dev  ## make the pictures in the documents again
	$(BIN)/afkb demo --out demo-map
	$(BIN)/afkb map world:paper_home --out demo-map-early --stop 6
	$(BIN)/python scripts/picture.py demo-map docs/demo-map.svg edges ids past
	$(BIN)/python scripts/picture.py demo-map-early docs/early-map.svg edges ids past
	$(BIN)/afkb detect world:paper_home --frame 51 --pictures demo-map-early
	cp demo-map-early/frame-000051.png docs/detected.png
	$(BIN)/python -m bench.mapping deceived_hall --picture docs/deceived.svg
	$(BIN)/python scripts/page_picture.py demo-map docs/page.png surface-124
	$(BIN)/afkb reproduce --worlds --scenario 1 --out demo-map-reproduced
	$(BIN)/python scripts/sheet_picture.py demo-map-reproduced/scenario-1.html docs/paper-steps.svg

site: $(VENV)/.dev  ## make the documents into a site, in site/
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict

pins: $(VENV)/.dev  ## write what is installed as the versions to test with
	scripts/pin.sh $(BIN)/python

clean:  ## remove the environment and what the targets made
	rm -rf $(VENV) demo-map demo-map-early demo-map-reproduced site

$(VENV)/.default: $(SET_UP)
	scripts/set-up.sh $(PYTHON) $(VENV) .
	touch $@

$(VENV)/.dev: $(SET_UP)
	scripts/set-up.sh $(PYTHON) $(VENV) '.[dev]'
	touch $@ $(VENV)/.default
