# Two commands do everything: `make demo` and `make test`. Each makes its own environment first.

VENV   ?= .venv
PYTHON ?= $(shell for p in python3.13 python3.12 python3.11 python3.14 python3 python; do \
	"$$p" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && { echo $$p; break; }; done)
BIN    := $(VENV)/bin
READY  := $(VENV)/.ready
JOBS   ?= 2
# One BLAS thread a process: the arrays are many and small, and the tests share the cores already.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: demo test check bench docs clean

demo: $(READY)  ## the main job on the built-in synthetic actor; prints where the report is
	$(BIN)/kinesphere demo -o demo

test: $(READY)  ## every test compiled, then those of the kernels once more as plain Python
	$(BIN)/pytest -n $(JOBS)
	NUMBA_DISABLE_JIT=1 $(BIN)/pytest -n $(JOBS) -m "not slow and not real"

check: $(READY)  ## style, types, and which room may import which
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(READY)  ## accuracy and speed, written to docs/results and benchmarks/results
	$(BIN)/python -m pip install -q --disable-pip-version-check -e ".[dev,bench]"  # the peers it compares with
	@missed=0; for one in accuracy accuracy.real accuracy.vendor_angles accuracy.lost_foot_markers accuracy.bodies accuracy.labels accuracy.mesh accuracy.retargeting accuracy.joined axes speed browser markerless markerless.laws markerless.losses markerless.second_opinion markerless.speed; do $(BIN)/python -m benchmarks.$$one || missed=1; done; exit $$missed

docs: $(READY)  ## the pages that are written by the program itself
	$(BIN)/python -m docs.generate

clean:
	rm -rf $(VENV) demo build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

$(READY): pyproject.toml
	@test -n "$(PYTHON)" || { echo "Kinesphere needs Python 3.11 or newer; none was found on the PATH." >&2; exit 1; }
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV) 2>/dev/null || \
		{ rm -rf $(VENV); $(PYTHON) -m pip install --user -q virtualenv && $(PYTHON) -m virtualenv -q $(VENV); }
	$(BIN)/python -m pip install -q --disable-pip-version-check -e ".[dev]"
	@touch $@
