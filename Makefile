# `make demo` and `make test` do everything on a fresh Debian or Ubuntu, system packages included.
.DEFAULT_GOAL := help
PROCESSOR ?= $(shell uname -m)
.PHONY: help demo build install check test test-long format tidy wheel web docs bench peers domains grids clean

help:  ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST)

demo:  ## build, and compute signed distance to a broken curve on a shipped mesh
	scripts/demo.sh

build:  ## the program and the library, in build/release
	scripts/setup.sh build
	cmake --preset release -DLITTORAL_TESTS=OFF
	cmake --build build/release

install: build  ## program, library, manual and completions, below PREFIX (/usr/local)
	cmake --install build/release --prefix $(or $(PREFIX),/usr/local)

check:  ## layout, layers, documentation, quick tests: a few minutes, while working
	scripts/setup.sh test
	scripts/test.sh check

test:  ## everything that is checked before a change is accepted (STAGES="release cli" for some of it)
	scripts/setup.sh test
	scripts/test.sh $(STAGES)

test-long:  ## what takes hours: long fuzzing, slow suites under sanitizers, studies, 64-bit ARM
	scripts/setup.sh test
	scripts/test.sh long

format:  ## lay out C++ and Python sources
	scripts/setup.sh python
	git ls-files '*.h' '*.cpp' | xargs build/venv/bin/clang-format -i
	build/venv/bin/ruff check --fix --quiet . && build/venv/bin/ruff format .

tidy:  ## clang-tidy over the library and the program
	scripts/setup.sh tidy
	cmake --preset tidy
	cd build/tidy && run-clang-tidy-14 -quiet -p . '/src/'

wheel:  ## the Python package as a wheel, in build/dist (PROCESSOR=aarch64 for another processor's)
	scripts/setup.sh build
	$(if $(filter aarch64,$(PROCESSOR)),scripts/setup.sh aarch64)
	scripts/make_wheel.sh build/dist $(PROCESSOR) build/wheel-$(PROCESSOR)

web:  ## the studio, a page that computes, and the package for JavaScript (WebAssembly), in dist
	scripts/setup.sh web
	cmake --preset web
	cmake --build build/web
	node web/build.mjs build/web dist
	cd web/studio && npm ci --no-audit --no-fund --loglevel=error && npm run --silent build

docs:  ## the documentation, in build/site
	scripts/setup.sh docs
	build/venv/bin/mkdocs build --strict --site-dir build/site

bench:  ## benchmarks
	scripts/setup.sh test
	cmake --preset bench
	cmake --build build/bench
	build/bench/bench/littoral_bench

peers: domains grids  ## littoral beside other programs: the tables and plot of docs/measurements/performance.md
	cmake --build build/bench --target littoral_surface_timer
	build/peers/bin/python bench/peers/compare.py build/bench/bench/littoral_surface_timer $(or $(CLOCK),wall) \
	  docs/measurements/performance.md docs/gallery/performance-surface.png $(MESHES)

domains:  ## the part of that about polygon meshes and point clouds
	scripts/setup.sh test
	cmake --preset bench
	cmake --build build/bench --target littoral_domain_timer
	python3 -m venv build/peers && build/peers/bin/pip -q install -r bench/peers/requirements.txt
	build/peers/bin/python bench/peers/domains.py build/bench/bench/littoral_domain_timer docs/measurements/performance.md 96 192

grids:  ## the part of that about grids in space
	scripts/setup.sh test
	cmake --preset bench
	cmake --build build/bench --target littoral_grid_timer
	python3 -m venv build/peers && build/peers/bin/pip -q install -r bench/peers/requirements.txt
	build/peers/bin/python bench/peers/grids.py build/bench/bench/littoral_grid_timer docs/measurements/performance.md \
	  64,128 $(MESHES)

clean:  ## remove what was built
	rm -rf build dist out/*
