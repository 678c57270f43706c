# A thin front to CMake. `make` alone lists what there is.
BUILD  := build/release
PREFIX ?= /usr/local
JOBS   ?= $(shell nproc)
CMAKE_OPTIONS ?=
SOURCES = $(shell git ls-files '*.cpp' '*.hpp')

.DEFAULT_GOAL := help
.PHONY: help demo test bench figures verify proof docs install package format tidy asan tsan clean packages packages-test binary

help: ## list these targets
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## (.*)/  make \1\t\2/' | expand -t 18
	@echo "  Variables: JOBS=$(JOBS) PREFIX=$(PREFIX) CMAKE_OPTIONS= AGAINST="

demo: binary ## install what is missing, build, tell a whole story: recording, calibration, diagnosis, page (SEED=n for another)
	@tools/demo.sh $(BUILD) build/demo/$$(date +%Y%m%d-%H%M%S)

test: packages-test ## install what is missing, build, run every test
	cmake --preset release -DMILLSCOPE_TESTS=ON $(CMAKE_OPTIONS)
	cmake --build --preset release -j $(JOBS)
	ctest --preset release -j $(JOBS)

bench: packages-test binary ## time against LIGGGHTS (20 minutes on a quiet machine); AGAINST=commit: against that commit's build
	cmake --build --preset release -j $(JOBS) --target millscope_bench
	$(if $(AGAINST),bench/against.py $(BUILD) $(AGAINST),bench/run.sh $(BUILD)) $(BENCH_OPTIONS)

figures: packages-test ## tables that tests print for docs/analysis.md, docs/analyzers.md and docs/campaigns.md (two hours)
	cmake --preset release -DMILLSCOPE_TESTS=ON $(CMAKE_OPTIONS)
	cmake --build --preset release -j $(JOBS) --target test_analysis analyzers_fields_test test_run
	$(BUILD)/bin/test_analysis "[.coverage]"
	$(BUILD)/bin/analyzers_fields_test "[.speed]"
	$(BUILD)/bin/test_run "[.warm]"
	$(BUILD)/bin/test_run "[.warm300]"
	$(BUILD)/bin/test_run "[.window]"
	$(BUILD)/bin/test_run "[.window300]"

verify: packages-test binary ## the long checks (hours), written to docs/validation.md; VERIFY="crosscheck memory" for some
	tools/verify.py --build $(BUILD) $(VERIFY)

proof: packages-test binary ## make, diagnose and count the blinded sets of the proof (hours, stops and goes on); PART="a_story" for one part
	tools/proof.py --build $(BUILD) $(PART)

docs: ## the documentation as a site: build/docs/index.html
	@tools/install_packages.sh docs
	mkdocs build --strict --quiet
	@echo "open build/docs/index.html"

install: binary ## build and install to PREFIX (command, plugins, SDK, completion, manual, Python package)
	cmake --install $(BUILD) --prefix $(PREFIX)

package: binary ## Debian packages, and the sources with the report page as it is built: build/packages (tools/package_test.sh tries them)
	tools/package.sh $(BUILD) build/packages

format: ## clang-format every source
	clang-format -i $(SOURCES)

tidy: packages-test ## clang-tidy over every source
	cmake --preset dev -DMILLSCOPE_TESTS=ON $(CMAKE_OPTIONS)
	tools/tidy.sh build/dev

asan: packages-test ## build and test with the address and undefined-behaviour sanitizers
	cmake --preset asan $(CMAKE_OPTIONS)
	cmake --build --preset asan -j $(JOBS)
	ctest --preset asan -j $(JOBS)

tsan: packages-test ## build and test with the thread sanitizer
	cmake --preset tsan $(CMAKE_OPTIONS)
	cmake --build --preset tsan -j $(JOBS)
	ctest --preset tsan -j $(JOBS)

clean: ## remove the builds of the presets
	cmake -E rm -rf build/release build/dev build/asan build/tsan

packages:
	@tools/install_packages.sh

packages-test:
	@tools/install_packages.sh test

# The command, the plugins and what the command says of itself (share/), no tests; a build directory that has tests keeps them. It is configured
# each time: a library that was installed since then is found.
binary: packages
	@if test -f $(BUILD)/build.ninja; then cmake --preset release $(CMAKE_OPTIONS) >/dev/null; \
	else cmake --preset release -DMILLSCOPE_TESTS=OFF $(CMAKE_OPTIONS); fi
	cmake --build --preset release -j $(JOBS) --target millscope millscope_share plugins/all geometry/all
