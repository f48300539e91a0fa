# `make` or `make help` lists what can be done.
.DEFAULT_GOAL := help
.PHONY: docs drawings help setup sundials generate build run test test-elsewhere test-oldest golden fuzz package wheel lint tree types format baseline clean \
	benchmark benchmark-andrews benchmark-axles benchmark-bits benchmark-braking benchmark-bushes benchmark-car-peers benchmark-cluster benchmark-derivatives benchmark-drive benchmark-ensemble benchmark-export benchmark-growth benchmark-loads benchmark-loops benchmark-microcontroller benchmark-page benchmark-peers benchmark-real-time benchmark-ride benchmark-speed benchmark-stiff benchmark-studies format-page front-axle-page report-assets
PYTHON := .venv/bin/python

EMITTED := $(wildcard generated/*.pyx generated/c/* generated/fmu/* runtime/targets/fmi/core/* runtime/equations/*.pyx runtime/simulation/*.pyx runtime/simulation/native/*.pyx runtime/simulation/*/*.[ch])

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "  make %-15s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup: .venv/.ready ## Create .venv and install everything (also done by the other targets)

.venv/.ready: pyproject.toml setup.py .ci/setup
	@.ci/setup
	@touch $@ .venv/.built

build: .venv/.built ## Compile the generated models

.venv/.built: .venv/.ready $(EMITTED) $(wildcard build/sundials/lib/libsundials_cvode.a)
	@$(PYTHON) setup.py --quiet build_ext --inplace
	@touch $@

sundials: ## Build an optimised SUNDIALS for the next build (set-up does it if there is none)
	@.ci/sundials

generate: .venv/.ready ## Derive the equations again and write generated/
	@$(PYTHON) -m kintrafo.generator generate generated
	@$(PYTHON) -m kintrafo.targets.fmi generated

run: build ## The paper's suspension: topology, Figures 4 to 6, summary, all in out/
	@$(PYTHON) -m kintrafo.generator topology --picture out/topology.png --figures out --force
	@$(PYTHON) -m kintrafo paper out --force

# Tests start hundreds of processes, and each would compile what it imports again.
test test-elsewhere test-oldest: export PYTHONDONTWRITEBYTECODE =

# Of all that tests make for each other, deriving takes longest: one process runs a file, and those
# that take longest come first.
test: build ## Run all tests
	@$(PYTHON) -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder

test-elsewhere: build ## Run what is compared with oracles as a processor of 2008 would compute
	@$(PYTHON) -m benchmarks.older_processor $(PYTHON) -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder -m numbers

# Those of the packages for development stay the newest. Old packages use what others have deprecated.
test-oldest: build ## Run all tests with the oldest packages that pyproject.toml accepts
	@$(PYTHON) -m venv build/oldest && $(PYTHON) .ci/oldest.py >build/oldest/constraints.txt
	@build/oldest/bin/python -m pip install -q "setuptools>=77" "cython>=3.1" wheel
	@build/oldest/bin/python -m pip install -q --no-build-isolation -c build/oldest/constraints.txt -e ".[dev]"
	@build/oldest/bin/python -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder -o filterwarnings=default

golden: build ## Which numbers of any analysis differ from those stored (ARGS=store: store these)
	@PYTHONPATH=tests $(PYTHON) -m golden $(ARGS)

fuzz: build ## Try every door for long; a table of what came of it (ARGS="--rounds 100")
	@PYTHONPATH=tests $(PYTHON) -m fuzz $(ARGS)

lint: .venv/.ready tree ## Check style, words and spelling, and that every file imports only from lower floors
	@.venv/bin/ruff check .
	@.venv/bin/ruff format --check .
	@PYTHONPATH=build/types .venv/bin/lint-imports --no-logo
	@.venv/bin/codespell README.md CHANGELOG.md docs generator runtime vehicle
	@$(PYTHON) .ci/words.py

format: .venv/.ready ## Rewrite the sources in the project's style
	@.venv/bin/ruff check --fix-only --quiet .
	@.venv/bin/ruff format --quiet .

# mypy and the linter follow folders, not the mapping of the four of them onto one package: this is
# a tree of links with that shape, created again so that no link points to a file that has moved
tree:
	@rm -rf build/types && mkdir -p build/types/kintrafo
	@for item in runtime/*; do ln -sfn "../../../$$item" build/types/kintrafo/; done
	@ln -sfn ../../../generator ../../../generated ../../../vehicle build/types/kintrafo/

types: .venv/.ready tree ## Check types
	@MYPYPATH=build/types .venv/bin/mypy -p kintrafo

benchmark: build ## Gear against Runge-Kutta: tables and plots in out/benchmark/
	@$(PYTHON) -m benchmarks --out out/benchmark

benchmark-page: build ## The same, and its page in docs/
	@$(PYTHON) -m benchmarks --out out/benchmark --page docs/theory/gear-against-runge-kutta.md

benchmark-peers: build ## The same suspension in CasADi, Exudyn, SymPy and Pinocchio
	@.venv/bin/pip install -q -e ".[peers]" --no-build-isolation
	@PYTHONPATH=tests $(PYTHON) -m benchmarks.peers --out out/benchmark --page docs/theory/other-tools.md

benchmark-car-peers: build ## A step steer of the driving car in Exudyn
	@.venv/bin/pip install -q -e ".[peers]" --no-build-isolation
	@PYTHONPATH=tests $(PYTHON) -W ignore::DeprecationWarning -m benchmarks.peers.exudyn_car --page

benchmark-andrews: build ## Andrews' squeezer here and as a differential-algebraic equation
	@.venv/bin/pip install -q -e ".[peers]" --no-build-isolation
	@$(PYTHON) -m benchmarks.andrews --out out/benchmark --page docs/theory/andrews.md

benchmark-loops: build ## Loops without a closed form against paths in maximal coordinates
	@PYTHONPATH=tests $(PYTHON) -m benchmarks.loops --page docs/mechanisms/own-mechanism.md $(ARGS)

benchmark-growth: build ## A chain of 1 to 100 loops: derivation, code and run time against its length
	@$(PYTHON) -m benchmarks.growth --out out/benchmark --page docs/theory/growth.md

benchmark-ensemble: build ## Many cars at once, in lanes and on all cores, and its page in docs/
	@.venv/bin/pip install -q -e ".[peers]" --no-build-isolation
	@PYTHONPATH=tests $(PYTHON) -m benchmarks.ensemble --out out/benchmark --page docs/simulation/ensembles.md $(ARGS)

benchmark-export: build ## FMUs: sizes, seconds, and steps above their arithmetic
	@$(PYTHON) -m benchmarks.export --page docs/simulation/export.md

benchmark-microcontroller: build ## Exported C on an emulated Cortex-M7: bits, instructions, stack
	@$(PYTHON) -m benchmarks.microcontroller --page docs/simulation/export.md

benchmark-ride: build ## How fast cars ride: operations, and simulations over a rough road
	@$(PYTHON) -m benchmarks.ride --page $(ARGS)

benchmark-drive: build ## How fast cars drive: operations, derivation, and a swing of the steering wheel
	@$(PYTHON) -m benchmarks.drive --page $(ARGS)

benchmark-braking: build ## A wheel that brakes to standstill: where a tyre is stiff, by all methods
	@$(PYTHON) -m benchmarks.braking --page docs/theory/gear-against-runge-kutta.md

benchmark-real-time: build ## Fixed steps: errors, and the time of a step
	@$(PYTHON) -m benchmarks.real_time --page docs/simulation/real-time.md

benchmark-stiff: build ## Which cars of an ensemble go to BDF, and what percentiles and spectra cost
	@$(PYTHON) -m benchmarks.ensemble_stiff --page docs/simulation/ensembles.md

benchmark-cluster: build ## An ensemble by two workers of Dask beside two threads, and its page in docs/
	@$(PYTHON) -m benchmarks.cluster --page docs/simulation/ensembles.md

docs: build .venv/.docs ## The documentation as a site: build/docs/index.html
	@rm -rf build/docs
	@$(PYTHON) -m sphinx -q -E -W --keep-going -b html -d build/docs-pages docs build/docs
	@echo "build/docs/index.html"

.venv/.docs: pyproject.toml | .venv/.ready
	@.venv/bin/pip install -q $$($(PYTHON) -c "import tomllib; \
		print(*tomllib.load(open('pyproject.toml', 'rb'))['project']['optional-dependencies']['docs'])")
	@touch $@

drawings: build ## The drawings of docs/ that are computed
	@for script in docs/images/*.py; do $(PYTHON) $$script || exit; done

report-assets: ## Bundle the HTML report's script and style again (needs Node.js)
	@cd vehicle/report/web && npm ci --silent && npm run --silent build

front-axle-page: build ## The page of the front axle: operations, wheel rates, a bump
	@$(PYTHON) -m benchmarks.front_axle --page docs/mechanisms/composition.md

format-page: build ## The input file's JSON Schema, and its page in docs/
	@$(PYTHON) -m kintrafo.vehicle.cli.published vehicle/data/suspension.schema.json docs/reference/file-format.md

benchmark-bits: build ## Which results are the same bits on another processor
	@$(PYTHON) -m benchmarks.same_bits --page docs/reference/conventions.md

benchmark-axles: build ## How long the motions of an axle take; a picture of docs/suspension/characteristics.md
	@$(PYTHON) -m benchmarks.axles

benchmark-loads: build ## How long the loads on all parts take; pictures of docs/suspension/loads.md and compliance.md
	@$(PYTHON) -m benchmarks.loads

benchmark-bushes: build ## Suspensions on bushes beside Exudyn, an independent program
	@.venv/bin/pip install -q -e ".[peers]" --no-build-isolation
	@$(PYTHON) -m benchmarks.bushes

benchmark-studies: build ## How long sensitivity, tolerance and optimise take; the pictures of docs/suspension/design-studies.md
	@$(PYTHON) -m benchmarks.studies

benchmark-derivatives: build ## What exact derivatives by parameters cost, and their page in docs/
	@$(PYTHON) -m benchmarks.derivatives $(ARGS)

benchmark-speed: build ## Times of everything, with pytest-benchmark (ARGS=--benchmark-compare)
	@$(PYTHON) -m pytest -q benchmarks/test_speed.py -p no:xdist --benchmark-only \
		--benchmark-columns=min,median,ops,rounds --benchmark-sort=name $(ARGS)

# A package is built in a folder of its own. The shell looks for SUNDIALS, which set-up may have built
# since make read this file.
package: .venv/.ready ## Build a source package and a wheel from it, and import that
	@rm -rf build/package && mkdir -p build
	@[ -n "$$SUNDIALS_ROOT" ] || [ ! -e build/sundials/include ] || \
		export SUNDIALS_ROOT="$(CURDIR)/build/sundials"; \
		$(PYTHON) -m build --no-isolation --outdir build/package . >build/package.log 2>&1 \
		|| { tail -n 20 build/package.log; exit 1; }
	@$(PYTHON) -m pip install -q --no-deps --target build/package/site build/package/*.whl
	@cd build/package/site && ../../../$(PYTHON) -P -c "import sys; sys.path.insert(0, '.'); \
		import kintrafo; print('packaged:', kintrafo.Model('reference_car')); \
		from kintrafo.generator.mechanisms.four_bar import FOUR_BAR; \
		print('compiled by it:', kintrafo.compile(FOUR_BAR, folder='cache').__name__)"

wheel: package ## A wheel that needs neither compiler nor SUNDIALS, tried in an empty environment
	@.ci/wheel $(ARGS)

baseline: build ## Store the present operation counts as the baseline
	@$(PYTHON) -m pytest -q tests/generator/backends/test_operation_counts.py --update-baseline

clean: ## Remove everything that can be made again
	rm -rf .venv build out dist *.egg-info generated/*.so runtime/*/*.so runtime/*/*/*.so .pytest_cache .mypy_cache .ruff_cache .hypothesis
